"""Why one condition fails, in values and in a sentence."""

from __future__ import annotations

from typing import Final, TypeAlias

from icarus_lite.inference.given import GIVEN
from icarus_lite.inference.supports import Derivation, Support
from icarus_lite.language.syntax import Atom, Call, Condition
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Value, format_value

_NOT_SO: Final = {
    "<": "is not less than",
    "<=": "is greater than",
    ">": "is not greater than",
    ">=": "is less than",
    "=": "is not",
    "/=": "is the same as",
}


@dataclass(frozen=True, slots=True)
class Difference:
    """An attribute in which the object that was asked about differs.

    Args:
        attribute: Its name.
        wanted: The value the condition asks for; None where any will do.
        found: The value that the object has; None where it has none.
    """

    attribute: str
    wanted: Value | None
    found: Value | None

    def __str__(self) -> str:
        if self.found is None:
            return f"has no ^{self.attribute}"
        found, wanted = format_value(self.found), format_value(self.wanted or "")
        return f"has ^{self.attribute} {found}, not {wanted}"


@dataclass(frozen=True, slots=True)
class Missing:
    """Nothing matches a positive condition.

    Args:
        pattern: The condition with the values of the attempt.
        namesake: The percept or belief with just these arguments, where only attributes differ.
        differences: In what it differs.
        nearest: Percepts or beliefs of the same name that agree in most places.
        remark: What else is known: that no such object is perceived, for example.
    """

    pattern: Atom
    namesake: Belief | None = None
    differences: tuple[Difference, ...] = ()
    nearest: tuple[Belief, ...] = ()
    remark: str = ""

    def __str__(self) -> str:
        text = f"nothing matches {self.pattern}"
        if self.namesake is not None and self.differences:
            name = format_value(self.namesake.args[0]) if self.namesake.args else "it"
            return f"{text}: {name} {', '.join(map(str, self.differences))}"
        if self.remark:
            return f"{text}: {self.remark}"
        if self.nearest:
            return f"{text}; nearest: {', '.join(map(in_full, self.nearest))}"
        return text


@dataclass(frozen=True, slots=True)
class FailedTest:
    """A test does not hold.

    Args:
        test: The test with the values of the attempt.
        deciding: The part of it that decides; the same unless it is an `and` or `not`.
        sides: What the arguments of that part come to.
        error: Why it has no value, if that is so.
    """

    test: Call
    deciding: Call
    sides: tuple[Value | bool, ...] = ()
    error: str = ""

    def __str__(self) -> str:
        if self.error:
            return f"{self.test} cannot be asked: {self.error}"
        return f"{self.test} fails: {self._verdict()}"

    def _verdict(self) -> str:
        function, sides = self.deciding.function, [_shown(side) for side in self.sides]
        if function == "not":
            return f"{self.deciding.args[0]} holds"
        if function == "or":
            return "none of its parts holds"
        if function in _NOT_SO and len(sides) == 2:
            return f"{sides[0]} {_NOT_SO[function]} {sides[1]}"
        return f"({' '.join([function, *sides])}) is false"


@dataclass(frozen=True, slots=True)
class Blocker:
    """A belief that stands in the way of a `not`, and why it is held.

    Args:
        belief: The belief or percept.
        support: Its first support; None for a percept.
    """

    belief: Belief
    support: Support | None = None

    @property
    def because(self) -> str:
        """Say in one sentence why it is held."""
        return because(self.support)


@dataclass(frozen=True, slots=True)
class Blocked:
    """A `not` fails because something matches.

    Args:
        pattern: What there must be none of.
        blockers: What there is, at most three of it.
        more: How many there are besides.
    """

    pattern: Atom
    blockers: tuple[Blocker, ...]
    more: int = 0

    def __str__(self) -> str:
        held = " and ".join(str(each.belief) for each in self.blockers)
        more = f" and {self.more} more" if self.more else ""
        verb = "is" if len(self.blockers) == 1 and not self.more else "are"
        perceived = all(each.support is None for each in self.blockers)
        how = "perceived" if perceived else "believed"
        return f"(not {self.pattern}) fails: {held}{more} {verb} {how}"


@dataclass(frozen=True, slots=True)
class Unasked:
    """A condition that could not be asked: what would bind its variables is missing.

    Args:
        condition: The condition, bound as far as it is.
    """

    condition: Condition | Call

    def __str__(self) -> str:
        return f"{self.condition} cannot be asked: nothing binds its variables"


Reason: TypeAlias = Missing | FailedTest | Blocked | Unasked


def because(support: Support | None) -> str:
    """Say in one sentence why something is held: perceived, asserted, derived."""
    if support is None:
        return "is perceived"
    if isinstance(support, Derivation):
        span = support.clause.span
        place = f" ({span.in_line})" if span.line else ""
        return f"by its definition{place}"
    if support.action == GIVEN:
        return "is given from the start"
    return f"because {support.action} succeeded, reported in cycle {support.cycle}"


def in_full(fact: Belief) -> str:
    """Write a fact with its attributes, by which it may differ from what was asked for."""
    attributes = [f" ^{name} {format_value(value)}" for name, value in fact.attributes.items()]
    return f"{str(fact)[:-1]}{''.join(attributes)})"


def _shown(value: Value | bool) -> str:  # noqa: FBT001 - any value of the language
    return str(value).lower() if isinstance(value, bool) else format_value(value)
