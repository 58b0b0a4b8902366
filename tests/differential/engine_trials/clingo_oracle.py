"""Beliefs as clingo has them: the domain and a whole history as one logic program.

Each predicate gets the cycle as its first argument, so that one grounding answers for all cycles.
A stratified program has one model, and grounding alone finds it: every atom left is a fact.

Attributes become predicates of their own. A belief has one value for each: what was asserted
decides, else the clause written first, and within one clause the least values. A `not` becomes a
predicate over the variables that it shares with the rest of the clause.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations, pairwise, product

import clingo

from engine_trials.histories import World
from engine_trials.scratch import Row
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Constant,
    Domain,
    Expression,
    Variable,
)
from icarus_lite.symbols import Value

_OPPOSITE = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "=": "!=", "!=": "="}
_BELIEF, _VALUES = "belief", "values"


class ClingoOracle:
    """Gives the beliefs of every cycle of a history.

    Args:
        domain: Stratified; its tests and binds use whole numbers, and no division, root or
            distance.
    """

    def __init__(self, domain: Domain) -> None:
        self._domain = domain
        self._concepts = {clause.head.predicate for clause in domain.concepts}
        rules = (_rules(number, clause) for number, clause in enumerate(domain.concepts))
        self._rules = "\n".join([line for lines in rules for line in lines])

    def program(self, worlds: Sequence[World]) -> str:
        """Write the program for clingo, for a person to look at as well."""
        facts = [line for cycle, world in enumerate(worlds) for line in self._facts(cycle, world)]
        return "\n".join([*facts, *_choices(self._attributes(worlds)), self._rules])

    def beliefs(self, worlds: Sequence[World]) -> list[frozenset[Row]]:
        """Give all derived and asserted beliefs of each cycle.

        Raises:
            AssertionError: grounding left something open, so that this oracle knows no answer.
        """
        held: list[dict[tuple[str, tuple[Value, ...]], tuple[Value, ...]]] = [{} for _ in worlds]
        asserted = {belief.predicate for world in worlds for belief in world.asserted}
        attributes = {name: names for (name, _), names in self._attributes(worlds).items()}
        for name, args in _ground(self.program(worlds)):
            if name.startswith("p_"):
                cycle, *rest = args
                held[cycle].setdefault((_name(name[2:]), tuple(rest)), ())
            elif name.startswith("best_"):
                cycle, *rest, _, values = args
                held[cycle][_name(name[5:]), tuple(rest)] = values
        wanted = self._concepts | asserted
        return [
            frozenset(
                (name, args, tuple(zip(attributes.get(name, ()), values, strict=False)))
                for (name, args), values in cycle.items()
                if name in wanted
            )
            for cycle in held
        ]

    def _facts(self, cycle: int, world: World) -> Iterator[str]:
        chains = lineages(self._domain.percepts)
        yield f"cycle({cycle})."
        for percept in world.percepts:
            for kind in chains[percept.type]:
                yield f"p_{kind}({cycle},{_value(percept.name)})."
                for name, value in percept.attributes.items():
                    yield f"a_{kind}_{_word(name)}({cycle},{_value(percept.name)},{_value(value)})."
        for belief in world.asserted:
            args = ",".join(map(_value, (cycle, *belief.args)))
            values = "".join(f"{_value(belief.attributes[n])}," for n in sorted(belief.attributes))
            if values:
                yield f"c_{_word(belief.predicate)}({args},-1,({values}),({values}))."
            else:
                yield f"p_{_word(belief.predicate)}({args})."

    def _attributes(self, worlds: Sequence[World]) -> Mapping[tuple[str, int], tuple[str, ...]]:
        """Give the attributes of each predicate, by name and number of arguments, sorted."""
        heads = (
            (c.head.predicate, c.head.args, dict(c.head.attributes)) for c in self._domain.concepts
        )
        told = ((b.predicate, b.args, b.attributes) for world in worlds for b in world.asserted)
        found = {(name, len(args)): tuple(sorted(given)) for name, args, given in (*told, *heads)}
        return {key: attributes for key, attributes in found.items() if attributes}


def _choices(attributes: Mapping[tuple[str, int], tuple[str, ...]]) -> Iterator[str]:
    """Write which attributes a belief has, of all those with which it is derived."""
    for (predicate, arity), names in attributes.items():
        name = _word(predicate)
        args = ",".join(["T", *(f"A{i}" for i in range(arity))])
        one, other = f"c_{name}({args},I,O,V)", f"c_{name}({args},J,P,W)"
        yield f"p_{name}({args}) :- {one}."
        yield f"w_{name}({args},I,O) :- {one}, {other}, (J,P) < (I,O)."
        yield f"best_{name}({args},I,V) :- {one}, not w_{name}({args},I,O)."
        for place, attribute in enumerate(names):
            values = "".join("X," if i == place else "_," for i in range(len(names)))
            yield f"a_{name}_{_word(attribute)}({args},X) :- best_{name}({args},_,({values}))."


def _rules(number: int, clause: ConceptClause) -> Iterator[str]:
    """Write a clause; one rule for each way in which its tests can hold."""
    positive = [c.atom for c in clause.elements if not c.negated]
    bound = {name for atom in positive for name in atom.variables}
    body = ["cycle(T)", *map(_pattern, positive)]
    for place, condition in enumerate(clause.elements):
        if condition.negated:
            names = dict.fromkeys(condition.atom.variables)
            shared = ",".join(["T", *(_variable(name) for name in names if name in bound)])
            some = f"some_{number}_{place}({shared})"
            yield f"{some} :- {_pattern(condition.atom)}."
            body.append(f"not {some}")
    body += [f"{_variable(b.variable.name)} = {_number(b.expression)}" for b in clause.binds]
    head = clause.head
    args = ",".join(["T", *map(_term, head.args)])
    if head.attributes:
        as_written = "".join(f"{_term(term)}," for _, term in head.attributes)
        by_name = "".join(f"{_term(term)}," for _, term in sorted(head.attributes, key=_first))
        text = f"c_{_word(head.predicate)}({args},{number},({as_written}),({by_name}))"
    else:
        text = f"p_{_word(head.predicate)}({args})"
    for tests in _ways([_normal(test, wanted=True) for test in clause.tests]):
        yield f"{text} :- {', '.join([*body, *tests])}."


def _first(attribute: tuple[str, object]) -> str:
    return attribute[0]


def _pattern(atom: Atom) -> str:
    args = ",".join(["T", *map(_term, atom.args)])
    predicate = _word(atom.predicate)
    parts = [f"p_{predicate}({args})"]
    parts += [
        f"a_{predicate}_{_word(name)}({args},{_term(term)})" for name, term in atom.attributes
    ]
    return ", ".join(parts)


_Formula = list[list[str]]
"""A test as a disjunction of conjunctions of comparisons."""


def _normal(test: Expression, *, wanted: bool) -> _Formula:
    assert isinstance(test, Call)
    if test.function == "not":
        return _normal(test.args[0], wanted=not wanted)
    if test.function in ("and", "or"):
        parts = [_normal(each, wanted=wanted) for each in test.args]
        together = (test.function == "and") is wanted
        return list(_ways(parts)) if together else [way for part in parts for way in part]
    sides = [_number(each) for each in test.args]
    name = {"/=": "!="}.get(test.function, test.function)
    pairs: Iterable[tuple[str, str]] = pairwise(sides)
    if name == "!=":
        pairs = combinations(sides, 2)
    if wanted:
        return [[f"{a} {name} {b}" for a, b in pairs]]
    return [[f"{a} {_OPPOSITE[name]} {b}"] for a, b in pairs]


def _ways(parts: Sequence[_Formula]) -> Iterator[list[str]]:
    for choice in product(*parts):
        yield [comparison for way in choice for comparison in way]


def _number(expression: Expression) -> str:
    if not isinstance(expression, Call):
        return _term(expression)
    values = [_number(each) for each in expression.args]
    match expression.function, values:
        case "abs", [a]:
            return f"|{a}|"
        case "min", [a, b]:  # the division leaves no remainder
            return f"(({a}+{b}-|{a}-{b}|)/2)"
        case "max", [a, b]:
            return f"(({a}+{b}+|{a}-{b}|)/2)"
        case ("+" | "-" | "*") as sign, _:
            return f"({sign.join(values)})"
    raise AssertionError(f"clingo has no {expression}")


def _term(term: Variable | Constant) -> str:
    return _variable(term.name) if isinstance(term, Variable) else _value(term.value)


def _variable(name: str) -> str:
    return f"V_{_word(name[1:])}"


def _word(name: str) -> str:
    """Write a name without hyphens, which clingo does not know."""
    return name.replace("-", "__")


def _name(word: str) -> str:
    return word.replace("__", "-")


def _value(value: Value) -> str:
    return f"({value})" if isinstance(value, int) and value < 0 else str(value)


def _ground(text: str) -> Iterator[tuple[str, tuple]]:
    control = clingo.Control(logger=lambda _code, _text: None)
    control.add("base", [], text)
    control.ground([("base", [])])
    for atom in control.symbolic_atoms:
        assert atom.is_fact, f"{atom.symbol} is left open"
        yield atom.symbol.name, _python(atom.symbol)[1]


def _python(symbol: clingo.Symbol) -> tuple:
    return symbol.name, tuple(map(_plain, symbol.arguments))


def _plain(symbol: clingo.Symbol) -> Value | tuple:
    if symbol.type is clingo.SymbolType.Number:
        return symbol.number
    if symbol.name:
        return symbol.name
    return tuple(map(_plain, symbol.arguments))
