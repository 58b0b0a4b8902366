"""Patterns over percepts and beliefs: is the predicate known, and used as it is defined?"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Final

from icarus_lite.language.checking.report import Report
from icarus_lite.language.checking.vocabulary import Definition, Origin, Vocabulary
from icarus_lite.language.functions import FUNCTIONS, Function
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Atom, Condition, Constant, Domain
from icarus_lite.language.wording import listing

_MOST_HOLDERS = 50
_OPERATORS: Final = frozenset(name for name in FUNCTIONS if not name.isalpha()) | {"and", "or"}


class Patterns:
    """Checks the patterns of one domain.

    Args:
        domain: The domain.
        names: The names that it defines.
        functions: The functions that tests may call; they are no predicates.
        report: Where findings go.
    """

    def __init__(
        self,
        domain: Domain,
        names: Vocabulary,
        functions: Mapping[str, Function],
        report: Report,
    ) -> None:
        self._domain = domain
        self._names = names
        self._functions = functions
        self._report = report
        self._assumed: set[str] = set()
        self._known_attributes: dict[str, Mapping[str, None]] = {}
        self._chains = lineages(domain.percepts)
        self._holders: dict[str, list[str]] | None = None
        self._heads = {c.head.predicate: c.head for c in reversed(domain.concepts)}

    def conditions(self, conditions: Iterable[Condition]) -> None:
        """Check the patterns of conditions."""
        for condition in conditions:
            self.pattern(condition.atom)

    def pattern(self, atom: Atom) -> None:
        """Check predicate, number of arguments and attributes of a pattern over beliefs."""
        self.attributes_once(atom)
        self._anything(atom)
        definitions = self._names.predicates.get(atom.predicate, ())
        known = self._attributes(atom.predicate)
        unknown = [name for name, _ in atom.attributes if name not in known]
        if not self._domain.percepts and (unknown or not definitions):
            self._assume_percept(atom, unknown if definitions else [])
            return
        if not definitions:
            self._unknown_predicate(atom)
            return
        if all(len(atom.args) != definition.arity for definition in definitions):
            self.wrong_arity(atom, definitions[0].arity, self._shape(atom, definitions[0]))
        for name in unknown:
            self._unknown_attribute(atom, name, tuple(known))

    def effect(self, atom: Atom) -> None:
        """Check a pattern that is to be believed: it can neither compare nor compute."""
        if atom.predicate in _OPERATORS and not self.defined(atom.predicate, Origin.CONCEPT):
            message = f"`{atom.predicate}` is a function, and an effect is a belief"
            hint = "state what will be believed, such as (on ?obj shelf); concepts can compare"
            self._report.error(self._report.name_of(atom), "ICR047", message, hint)
        else:
            self.pattern(atom)

    def _anything(self, atom: Atom) -> None:
        for term in (*atom.args, *(value for _, value in atom.attributes)):
            if isinstance(term, Constant) and term.value == "_":
                message = "`_` is a name here, which matches nothing but itself"
                self._report.warning(term.span, "ICR047", message, "write ?_ for anything")

    def _assume_percept(self, atom: Atom, undefined: Sequence[str]) -> None:
        """Let a domain without percept declarations, as older ones are, name what it perceives."""
        if atom.predicate in self._assumed:
            return
        self._assumed.add(atom.predicate)
        meant = self._report.closest(atom.predicate, self._names.predicates)
        hint = "declare what is perceived: (percepts (object ^type ^x ^y))"
        if meant:
            hint = f"did you mean `{meant}`? otherwise {hint}"
        message = f"`{atom.predicate}` is taken to be perceived, for nothing defines it"
        if undefined:
            message = (
                f"`{atom.predicate}` is taken to be perceived: no clause has `^{undefined[0]}`"
            )
        self._report.warning(self._report.name_of(atom), "ICR027", message, hint)

    def _unknown_predicate(self, atom: Atom) -> None:
        known = self._names.predicates
        meant = self._report.closest(atom.predicate, known)
        hint = "define it in (concepts …), declare it in (percepts …), or assert it by an effect"
        if atom.predicate in self._names.skills:
            hint = "it is a skill; conditions speak of its effects"
        elif atom.predicate in self._functions:
            hint = "it is a function: move it to :tests"
        elif meant:
            hint = f"did you mean `{meant}`?"
        message = f"nothing is ever known about `{atom.predicate}`"
        label = "neither perceived, derived nor asserted"
        self._report.error(self._report.name_of(atom), "ICR013", message, hint, label=label)

    def _shape(self, atom: Atom, definition: Definition) -> str:
        """Say what a pattern with the wrong number of arguments should look like."""
        if definition.origin is Origin.PERCEPT:
            unmarked = _unmarked(atom, self._attributes(atom.predicate))
            if unmarked is not None:
                return f"attributes are marked with a hat: {unmarked}"
        if definition.origin is Origin.CONCEPT and atom.predicate in self._heads:
            head = self._heads[atom.predicate]
            return f"its first clause, in {head.span.in_line}, begins with {head}"
        return _defined_where(definition)

    def _attributes(self, predicate: str) -> Mapping[str, None]:
        """Give the attributes that a predicate may have, sorted."""
        if predicate not in self._known_attributes:
            definitions = self._names.predicates.get(predicate, ())
            names = {name for definition in definitions for name in definition.attributes}
            self._known_attributes[predicate] = dict.fromkeys(sorted(names))
        return self._known_attributes[predicate]

    def _unknown_attribute(self, atom: Atom, name: str, known: Sequence[str]) -> None:
        meant = self._report.closest(name, known)
        holder = self._subtype_with(atom.predicate, name)
        if holder:
            hint = f"`{holder}`, which is a kind of `{atom.predicate}`, has it: ask for a {holder}"
        elif meant:
            hint = f"did you mean `^{meant}`?"
        elif known:
            hint = f"its attributes are {listing(f'^{each}' for each in known)}"
        else:
            hint = "it has no attributes"
        message = f"`{atom.predicate}` has no attribute `^{name}`"
        self._report.error(self._report.attribute_of(atom, name), "ICR015", message, hint)

    def _subtype_with(self, supertype: str, attribute: str) -> str | None:
        """Give a percept type below another one that has an attribute, or None."""
        if self._holders is None:
            self._holders = {}
            for percept in self._domain.percepts:
                for name in percept.attributes:
                    self._holders.setdefault(name, []).append(percept.name)
        for holder in self._holders.get(attribute, ())[:_MOST_HOLDERS]:
            if supertype in self._chains[holder]:
                return holder
        return None

    def attributes_once(self, atom: Atom) -> None:
        """Report attributes that one pattern gives twice."""
        for name in _repeated([name for name, _ in atom.attributes]):
            message = f"the attribute `^{name}` is given twice"
            self._report.error(atom.span, "ICR011", message, "remove one of them")

    def no_attributes(self, atom: Atom) -> None:
        """Report attributes of an action, which has none."""
        for name, _ in atom.attributes:
            message = f"the action `{atom.predicate}` cannot have the attribute `^{name}`"
            hint = "actions have positional arguments only"
            self._report.error(self._report.attribute_of(atom, name), "ICR015", message, hint)

    def wrong_arity(self, atom: Atom, arity: int, hint: str) -> None:
        """Report a wrong number of arguments; the hint says what it should look like."""
        takes = f"{arity} argument" if arity == 1 else f"{arity} arguments"
        message = f"`{atom.predicate}` takes {takes}, not {len(atom.args)}"
        self._report.error(atom.span, "ICR014", message, hint)

    def defined(self, predicate: str, origin: Origin) -> bool:
        """Tell whether beliefs with a predicate come from there."""
        definitions = self._names.predicates.get(predicate, ())
        return any(definition.origin is origin for definition in definitions)


def _defined_where(definition: Definition) -> str:
    where = f" in {definition.span.in_line}" if definition.span.line else ""
    match definition.origin:
        case Origin.PERCEPT:
            return f"it is a percept{where}: its one argument is the object's name"
        case Origin.CONCEPT:
            return f"it is a concept, first defined{where}"
        case Origin.EFFECT:
            return f"it is first asserted by an effect{where}"
        case Origin.GIVEN:
            return f"it is first given by :init{where}"
        case Origin.ATTACHMENT:
            return "its arguments are child and parent"


def _unmarked(atom: Atom, attributes: Collection[str]) -> Atom | None:
    """Read `(object ?o type plug)`, or with `?type`, as `(object ?o ^type plug)` if it can be."""
    names, values = atom.args[1::2], atom.args[2::2]
    keys = [str(name).lstrip("?") for name in names]
    complete = 0 < len(names) == len(values)
    if not complete or not set(keys) <= set(attributes):
        return None
    pairs = (*zip(keys, values, strict=True), *atom.attributes)
    return Atom(atom.predicate, atom.args[:1], pairs)


def _repeated(names: Iterable[str]) -> list[str]:
    """Give the names that occur more than once, each one time, in order."""
    seen: dict[str, int] = {}
    for name in names:
        seen[name] = seen.get(name, 0) + 1
    return [name for name, count in seen.items() if count > 1]
