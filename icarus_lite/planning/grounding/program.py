"""Clauses as Python source: nested loops that find the instances of each clause.

An instance is found when the last of its conditions that can change comes to hold, so each clause
has a function for each such condition, *led* by it: the facts newly taken in meet that condition,
and the others are looked up in indexes, those first of which most is known (semi-naive evaluation;
Bancilhon and Ramakrishnan 1986). Of two conditions on one predicate that are both new, the earlier
leads. The source is compiled once for a domain and a set of predicates that can change.
"""

from __future__ import annotations

from collections.abc import Sequence
from types import CodeType

from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Constant,
    Term,
    Variable,
    variables_of,
)
from icarus_lite.planning.grounding.clauses import GroundedClause, cells_of, is_bound
from icarus_lite.planning.grounding.views import View, terms_of, view_of
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Value

_DEEPEST = 12
"""Loops in one function; Python allows twenty."""


@dataclass(frozen=True, slots=True)
class Lead:
    """A function that finds instances.

    Args:
        name: Its name in the source.
        clause: The number of its clause.
        view: How it looks at the facts newly taken in; None for a function that is called once.
        key: What it looks for among them.
    """

    name: str
    clause: int
    view: View | None = None
    key: tuple[Value, ...] = ()


@dataclass(frozen=True, slots=True)
class Program:
    """Clauses compiled.

    Args:
        source: The Python source, for whoever wants to read it.
        code: The source compiled.
        leads: Its functions.
        indexes: The views on facts that can change, by the names that the source has for them.
        static: Those on facts that cannot.
        constants: Values that the source speaks of, by name.
        tests: Tests, each with its clause and the variables it is asked about.
        binds: Expressions of `:binds`, likewise.
    """

    source: str
    code: CodeType
    leads: tuple[Lead, ...]
    indexes: dict[str, View]
    static: dict[str, View]
    constants: dict[str, Value]
    tests: dict[str, tuple[int, Call, tuple[str, ...]]]
    binds: dict[str, tuple[int, int, tuple[str, ...]]]


@dataclass(slots=True)
class _Names:
    """What the source calls things."""

    indexes: dict[View, str] = field(default_factory=dict)
    static: dict[View, str] = field(default_factory=dict)
    constants: dict[tuple[type, Value], str] = field(default_factory=dict)
    tests: dict[str, tuple[int, Call, tuple[str, ...]]] = field(default_factory=dict)
    binds: dict[str, tuple[int, int, tuple[str, ...]]] = field(default_factory=dict)

    def index(self, view: View) -> str:
        return self.indexes.setdefault(view, f"index{len(self.indexes)}")

    def static_index(self, view: View) -> str:
        return self.static.setdefault(view, f"static{len(self.static)}")

    def constant(self, value: Value) -> str:
        return self.constants.setdefault((type(value), value), f"value{len(self.constants)}")


def compile_program(clauses: Sequence[GroundedClause], *, banning: bool = False) -> Program:
    """Write the functions that find the instances of these clauses, and compile them.

    Args:
        clauses: The clauses.
        banning: Whether the functions are to look for what is banned. Mostly nothing is.
    """
    names, leads, parts = _Names(), [], list[str]()
    for clause in clauses:
        places: list[int | None] = [*sorted(clause.fluent)] or [None]
        for place in places:
            name = f"find{clause.number}" + ("" if place is None else f"_{place}")
            view, key = None, tuple[Value, ...]()
            if place is not None:
                view, terms, _ = view_of(clause.positive[place], (), serial=1)
                key = tuple(term.value for term in terms if isinstance(term, Constant))
            leads.append(Lead(name, clause.number, view, key))
            parts += _Function(clause, place, name, names, banning=banning).write()
    source = "\n".join(parts)
    return Program(
        source,
        compile(source, "<grounding>", "exec"),
        tuple(leads),
        {name: view for view, name in names.indexes.items()},
        {name: view for view, name in names.static.items()},
        {name: value for (_, value), name in names.constants.items()},
        names.tests,
        names.binds,
    )


class _Function:
    """The function of one clause that is led by one condition, or by none."""

    def __init__(
        self,
        clause: GroundedClause,
        lead: int | None,
        name: str,
        names: _Names,
        *,
        banning: bool,
    ) -> None:
        self._clause, self._lead, self._name, self._names = clause, lead, name, names
        self._banning = banning
        self._bound: dict[str, str] = {}
        self._joined: set[int] = set()
        self._asked: set[int] = set()
        self._lines: list[str] = []
        self._indent = 1
        self._loops = 0
        self._parts = 0

    def write(self) -> list[str]:
        """Give the lines of the function, and of those that go on where it is too deep."""
        clause = self._clause
        self._lines += ["", f"# {clause.clause.head}"]
        if self._lead is None:
            self._lines.append(f"def {self._name}():")
            # A loop, so that `continue` gives up here as everywhere.
            self._open("for _ in (0,):")
        else:
            self._lines.append(f"def {self._name}(news, since):")
            atom = clause.positive[self._lead]
            _, _, fresh = view_of(atom, ())
            self._loop(self._lead, "news", fresh)
        self._tests()
        while len(self._joined) < len(clause.positive):
            place = min(set(range(len(clause.positive))) - self._joined, key=self._urgency)
            if self._loops >= _DEEPEST:
                self._go_on_elsewhere()
            self._join(place)
            self._tests()
        self._finish()
        return self._lines

    def _urgency(self, place: int) -> tuple[int, int, int]:
        """Rank a condition: the least comes next in the join."""
        terms, fluent = terms_of(self._clause.positive[place]), place in self._clause.fluent
        fresh = {t.name for t in terms if isinstance(t, Variable) and t.name not in self._bound}
        if not fresh:
            return fluent, 0, place
        is_looked_up = any(isinstance(t, Constant) or t.name in self._bound for t in terms)
        return 2 + 2 * (not is_looked_up) + fluent, len(fresh), place

    def _join(self, place: int) -> None:
        atom = self._clause.positive[place]
        view, key, fresh = view_of(atom, self._bound)
        if place in self._clause.fluent:
            source = f"{self._names.index(view)}.get({self._key(key)}, ())"
            self._loop(place, source, fresh)
            return
        index = self._names.static_index(view)
        self._joined.add(place)
        if not fresh:
            self._line(f"if {self._key(key)} not in {index}: continue")
            return
        for name in fresh:
            self._bind(name)
        target = ", ".join(self._bound[name] for name in fresh)
        self._open(f"for {target} in {index}.get({self._key(key)}, ()):")

    def _loop(self, place: int, source: str, fresh: Sequence[str]) -> None:
        """Loop over the numbered facts of a condition."""
        for name in fresh:
            self._bind(name)
        self._joined.add(place)
        target = ", ".join([f"n{place}", *(self._bound[name] for name in fresh)])
        self._open(f"for {target} in {source}:")
        lead, positive = self._lead, self._clause.positive
        earlier = lead is not None and place < lead
        if earlier and positive[place].predicate == positive[lead or 0].predicate:
            self._line(f"if n{place} >= since: continue")

    def _tests(self) -> None:
        """Ask the tests whose turn has come."""
        for number, timed in enumerate(self._clause.tests):
            if number in self._asked or not timed.after <= self._joined:
                continue
            wanted = tuple(dict.fromkeys(variables_of(timed.test)))
            known = tuple(name for name in wanted if name in self._bound)
            complete = len(self._joined) == len(self._clause.positive)
            if len(known) < len(wanted) and not complete:
                continue
            self._asked.add(number)
            test = timed.test
            if test.function in ("=", "/=") and len(test.args) == 2 and len(known) == len(wanted):
                one, other = test.args
                if not isinstance(one, Call) and not isinstance(other, Call):
                    sign = "!=" if test.function == "=" else "=="
                    self._line(f"if {self._term(one)} {sign} {self._term(other)}: continue")
                    continue
            name = f"test{self._clause.number}_{number}_{len(known)}"
            self._names.tests[name] = (self._clause.number, test, known)
            self._line(f"if not {name}({self._tuple(known)}, {self._numbers()}): continue")

    def _finish(self) -> None:
        clause, number = self._clause, self._clause.number
        for atom in clause.static_denials:
            view, key, _ = view_of(atom, self._bound, binding=False)
            self._line(f"if {self._key(key)} in {self._names.static_index(view)}: continue")
        concept = clause.clause if isinstance(clause.clause, ConceptClause) else None
        known = clause.variables
        for place, bind in enumerate(concept.binds if concept is not None else ()):
            name = f"bind{number}_{place}"
            self._names.binds[name] = (number, place, known)
            self._bind(bind.variable.name)
            target = self._bound[bind.variable.name]
            self._line(f"{target} = {name}({self._tuple(known)}, {self._numbers()})")
            self._line(f"if {target} is None: continue")
            known = (*known, bind.variable.name)
        row = self._tuple(clause.variables)
        if concept is None and self._banning:
            head = ", ".join(self._term(term) for term in clause.clause.head.args)
            head += "," if len(clause.clause.head.args) == 1 else ""
            self._line(f"if ({head}) in banned{number}: continue")
        made = [
            self._noted(place, atom)
            for place, atom in enumerate(clause.effects)
            if is_bound(atom, self._bound)
        ]
        effects = f"({''.join(f'{effect}, ' for effect in made)})"
        if clause.attaching is not None:
            effects = f"{effects} + attach{number}({row})"
        self._line(f"found{number}(({row}, {self._numbers()}, {effects}))")

    def _noted(self, place: int, atom: Atom) -> str:
        """Write what gives an effect its number."""
        args, attributes = cells_of(atom)
        cells = f"({''.join(f'{self._term(term)}, ' for term in args)})"
        if not attributes:
            return f"numbers{self._clause.number}_{place}[{cells}]"
        pairs = "".join(f"({name!r}, {self._term(term)}), " for name, term in attributes)
        return f"note{self._clause.number}_{place}({cells}, ({pairs}))"

    # The small change of writing.

    def _bind(self, name: str) -> None:
        self._bound[name] = f"v{len(self._bound)}"

    def _term(self, term: Term) -> str:
        if isinstance(term, Variable):
            return self._bound[term.name]
        return self._names.constant(term.value)

    def _tuple(self, names: Sequence[str]) -> str:
        return f"({''.join(f'{self._bound[name]}, ' for name in names)})"

    def _key(self, terms: Sequence[Term]) -> str:
        if len(terms) == 1:
            return self._term(terms[0])
        return f"({', '.join(self._term(term) for term in terms)})"

    def _numbers(self) -> str:
        joined = sorted(self._joined & self._clause.fluent)
        return f"({''.join(f'n{place}, ' for place in joined)})"

    def _line(self, text: str) -> None:
        self._lines.append("    " * self._indent + text)

    def _open(self, text: str) -> None:
        self._line(text)
        self._indent += 1
        self._loops += 1

    def _go_on_elsewhere(self) -> None:
        """Go on in a function of its own, which is given all that is known here."""
        self._parts += 1
        name = f"{self._name}_part{self._parts}"
        joined = sorted(self._joined & self._clause.fluent)
        known = [*self._bound.values(), *(f"n{place}" for place in joined)]
        arguments = ", ".join([*known, *(["since"] if self._lead is not None else [])])
        self._line(f"{name}({arguments})")
        self._lines += ["", f"def {name}({arguments}):"]
        self._indent, self._loops = 1, 0
        self._open("for _ in (0,):")
