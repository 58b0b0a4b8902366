"""Datalog, as it is usually written, told in the language of this project.

A rule becomes a concept clause, a fact an asserted belief. What only facts speak of is declared as
the effect of a skill that is never carried out: the checker asks where a predicate comes from.
Identifiers among the arguments are variables, whether they begin with a capital or not; constants
are numbers and quoted strings. An expression in a head becomes a bind, one in a body a variable and
a test.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from icarus_lite import Belief
from icarus_lite.language import check_domain, has_errors, parse_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.symbols import Value, format_value

Rows: TypeAlias = Mapping[str, Iterable[Sequence[Value]]]
"""The facts of each predicate."""

_TOKEN = re.compile(
    r'\s*(?::-|<=|>=|!=|==|[(),.<>=+*/!-]|"(?:[^"\\]|\\.)*"|\d+(?:\.\d+)?|[A-Za-z_]\w*)'
)
_COMPARISONS = {"<": "<", "<=": "<=", ">": ">", ">=": ">=", "=": "=", "==": "=", "!=": "/="}

CODES = {
    "ICR012": "unbound_variable",
    "ICR014": "arity_mismatch",
    "ICR019": "cyclic_negation",
}
"""What the Datalog world calls the errors of our checker."""


class RefusedError(Exception):
    """A program that is no legal domain; `code` is what others call the error."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code = code


@dataclass(frozen=True, slots=True)
class Literal:
    """An atom or its negation; arguments are written as ours, expressions in prefix form."""

    predicate: str
    args: tuple[str, ...]
    negated: bool = False


@dataclass(frozen=True, slots=True)
class Rule:
    """A head, the literals of the body, and its comparisons, each as ours."""

    head: Literal
    body: tuple[Literal, ...]
    tests: tuple[str, ...]


def domain_of(rules: Sequence[str], facts: Rows) -> Domain:
    """Read a program as a domain.

    Args:
        rules: One Datalog rule each.
        facts: What is given; the domain declares their predicates.

    Raises:
        RefusedError: the program is no legal domain.
    """
    text = domain_text([read_rule(rule) for rule in rules], facts)
    domain, problems = parse_domain(text, "program.icr")
    if domain is not None:
        problems = (*problems, *check_domain(domain))
    if domain is None or has_errors(problems):
        first = next(each for each in problems if each.severity == "error")
        code = CODES.get(first.code, first.code)
        if first.code == "ICR012" and first.message.startswith("?_"):
            code = "safety_violations"  # what others call an anonymous variable in a head
        raise RefusedError(code, f"{first.code} {first.message}")
    return domain


def beliefs_of(facts: Rows) -> list[Belief]:
    """Give facts as beliefs."""
    return [Belief(name, tuple(row)) for name, rows in facts.items() for row in rows]


def domain_text(rules: Sequence[Rule], facts: Rows) -> str:
    """Write a program as an .icr file."""
    defined = {rule.head.predicate for rule in rules}
    sizes = {(name, len(row)) for name, rows in facts.items() for row in rows}
    used = {(each.predicate, len(each.args)) for rule in rules for each in rule.body}
    given = {(n, size) for n, size in sizes if n not in defined} | {
        (n, size) for n, size in used if n not in defined and n not in facts
    }
    lines = ["(percepts (thing))"]
    if rules:
        lines.append("(concepts")
        lines += [_clause_text(rule) for rule in rules]
        lines[-1] += ")"
    if given:
        most = max(size for _, size in given)
        variables = [f"?v{i}" for i in range(most)]
        things = " ".join(f"(thing {each})" for each in variables)
        effects = " ".join(_written(n, variables[:size]) for n, size in sorted(given))
        lines.append(f"(skills ({_written('tell', variables)} :elements ({things})")
        lines.append(f"  :actions ({_written('*tell', variables)}) :effects ({effects})))")
    return "\n".join(lines) + "\n"


def _clause_text(rule: Rule) -> str:
    binds, args, tests = [], [], list(rule.tests)
    for arg in rule.head.args:
        if arg.startswith("("):
            binds.append(f"(?h{len(binds)} {arg})")
            args.append(f"?h{len(binds) - 1}")
        else:
            args.append(arg)
    elements = []
    for literal in rule.body:
        plain = []
        for arg in literal.args:
            if arg.startswith("("):
                plain.append(f"?b{len(tests)}")
                tests.append(f"(= {plain[-1]} {arg})")
            else:
                plain.append(arg)
        text = _written(literal.predicate, plain)
        elements.append(f"(not {text})" if literal.negated else text)
    parts = [f"  ({_written(rule.head.predicate, args)}"]
    for name, entries in ((":elements", elements), (":tests", tests), (":binds", binds)):
        if entries:
            parts.append(f"{name} ({' '.join(entries)})")
    return " ".join(parts) + ")"


def _written(name: str, args: Sequence[str]) -> str:
    return f"({' '.join([name, *args])})"


def read_rule(text: str) -> Rule:
    """Read one rule.

    Raises:
        ValueError: it is none.
    """
    reading = _Reading(list(_tokens(text)))
    head = reading.atom()
    body: list[Literal] = []
    tests: list[str] = []
    if reading.taken(":-"):
        while True:
            each = reading.literal()
            if isinstance(each, Literal):
                body.append(each)
            else:
                tests.append(each)
            if not reading.taken(","):
                break
    reading.taken(".")
    if reading.left:
        raise ValueError(f"{text!r} does not end at {reading.left[0]!r}")
    return Rule(head, tuple(body), tuple(tests))


def _tokens(text: str) -> Iterator[str]:
    place, text = 0, text.strip()
    while place < len(text):
        found = _TOKEN.match(text, place)
        if found is None:
            raise ValueError(f"{text!r} cannot be read from {text[place:]!r} on")
        yield found.group().strip()
        place = found.end()


@dataclass
class _Reading:
    """The tokens that are left, and how many anonymous variables there have been."""

    left: list[str]
    anonymous: int = field(default=0)

    def taken(self, token: str) -> bool:
        """Take a token if it comes next."""
        if self.left and self.left[0] == token:
            del self.left[0]
            return True
        return False

    def literal(self) -> Literal | str:
        """Read an atom, its negation, or a comparison."""
        if self.taken("not") or self.taken("!"):
            atom = self.atom()
            return Literal(atom.predicate, atom.args, negated=True)
        if len(self.left) > 1 and self.left[1] == "(" and self.left[0].isidentifier():
            return self.atom()
        if self.left[0] == "(":  # a comparison may stand in parentheses
            self.taken("(")
            test = self.comparison()
            self.taken(")")
            return test
        return self.comparison()

    def atom(self) -> Literal:
        """Read a predicate and its arguments."""
        name = self.left.pop(0)
        args: list[str] = []
        if self.taken("("):
            while not self.taken(")"):
                args.append(self.sum())
                self.taken(",")
        return Literal(name, tuple(args))

    def comparison(self) -> str:
        """Read two expressions with a comparison between them."""
        left = self.sum()
        name = _COMPARISONS[self.left.pop(0)]
        return f"({name} {left} {self.sum()})"

    def sum(self) -> str:
        """Read an expression; `1 - 2 - 3` is `(1 - 2) - 3`."""
        value = self.product()
        while self.left and self.left[0] in "+-":
            sign = self.left.pop(0)
            value = f"({sign} {value} {self.product()})"
        return value

    def product(self) -> str:
        """Read factors."""
        value = self.factor()
        while self.left and self.left[0] in "*/":
            sign = self.left.pop(0)
            value = f"({sign} {value} {self.factor()})"
        return value

    def factor(self) -> str:
        """Read a number, string, variable, or an expression in parentheses."""
        token = self.left.pop(0)
        if token == "(":
            value = self.sum()
            self.taken(")")
            return value
        if token == "-":
            return f"-{self.factor()}"
        if token.startswith('"'):
            return '"' + token[1:-1] + '"'
        if token == "_":
            self.anonymous += 1
            return f"?_{self.anonymous}"
        return f"?{token}" if token.isidentifier() else format_value(_number(token))


def _number(token: str) -> Value:
    return float(token) if "." in token else int(token)
