"""What a plan rests on: each condition of a step, or goal, and the steps that make it hold.

A condition that the world meets by itself is a leaf without a producer. One that a step brings
about names that step; a derived condition is taken apart into the beliefs that support it, down
to what single steps assert or end. Of two steps that bring the same about the later counts, so
that no step between a producer and its consumer ever undoes the link: the order of the plan has
resolved all threats.

Source: causal links of partial-order planning (McAllester and Rosenblitt 1991); the literals that
a rest of a plan needs are the kernels of a triangle table (Fikes, Hart and Nilsson 1972).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from icarus_lite.inference import FactStore
from icarus_lite.language.syntax import Atom, Condition, Constant
from icarus_lite.records import dataclass, field, replace
from icarus_lite.symbols import Belief


@dataclass(frozen=True, slots=True)
class Need:
    """A literal that has to hold, and the last step that it waits for.

    Args:
        literal: The literal, bound; an attribute that may change its value is left open.
        producer: The last of the steps, from 0, that it takes; None if it holds from the start.
        premises: For a derived belief, what supports it; for one that is no longer derived, what
            keeps it from being so. Empty where the producer itself asserts or ends it.
        gone: For a negated pattern, the beliefs that had matched it, each with what ended it.
    """

    literal: Condition
    producer: int | None = None
    premises: tuple[Need, ...] = ()
    gone: tuple[Need, ...] = ()

    def waits_for(self, position: int) -> bool:
        """Tell whether a step from a position on is still to bring it about."""
        return self.producer is not None and self.producer >= position

    def required(self, position: int) -> Iterator[Requirement]:
        """Give what must hold before the step at a position for this to come true in time."""
        if not self.waits_for(position):
            yield Requirement(self.literal)
            return
        pending = [each for each in self.gone if each.waits_for(position)]
        if self.gone:
            facts = (_belief(each.literal) for each in pending)
            yield Requirement(self.literal, tuple(facts))
        for part in chain(self.premises, *(each.premises for each in pending)):
            yield from part.required(position)

    def leaves(
        self, through: tuple[Condition, ...] = ()
    ) -> Iterator[tuple[Need, tuple[Condition, ...]]]:
        """Give what it comes down to, each with the literals between, the outermost first."""
        parts = (*self.premises, *self.gone)
        if not parts:
            yield self, through
        for part in parts:
            further = through if part.literal == self.literal else (*through, part.literal)
            yield from part.leaves(further if part.premises or part.gone else through)


@dataclass(frozen=True, slots=True)
class Requirement:
    """A literal that must hold at some point of a plan.

    Args:
        literal: The literal.
        excepting: For a negated pattern, beliefs that may still match it: later steps end them.
        consumer: The step, from 0, that needs it in the end; None for the goal.
    """

    literal: Condition
    excepting: tuple[Belief, ...] = ()
    consumer: int | None = field(default=None, compare=False)

    def holds(self, facts: FactStore) -> bool:
        """Tell whether it is so among these facts."""
        found = (fact for _, fact in facts.matches(self.literal.atom, {}))
        if not self.literal.negated:
            return any(True for _ in found)
        return all(fact in self.excepting for fact in found)

    def __str__(self) -> str:
        return str(self.literal)


@dataclass(frozen=True, slots=True)
class CausalLink:
    """One step that serves one condition of a later step, or of the goal.

    Args:
        producer: The step, from 0; None for what holds from the start.
        fact: What the step brings about, or what holds from the start.
        condition: The condition that this serves.
        consumer: The step whose condition it is; None for a goal.
        through: The derived literals on the way from the fact to the condition, if any.
    """

    producer: int | None
    fact: Condition
    condition: Condition
    consumer: int | None
    through: tuple[Condition, ...] = ()

    def as_dict(self) -> dict[str, object]:
        """Give the link as JSON has it."""
        return {
            "producer": self.producer,
            "fact": str(self.fact),
            "condition": str(self.condition),
            "consumer": self.consumer,
            "through": [str(literal) for literal in self.through],
        }


@dataclass(frozen=True, slots=True)
class Needs:
    """All that one step, or the goal, needs.

    Args:
        consumer: The step, from 0; None for the goal.
        conditions: Its conditions, in the order of the text, each with what it rests on.
    """

    consumer: int | None
    conditions: tuple[Need, ...]

    def required(self, position: int) -> Iterator[Requirement]:
        """Give what must hold before the step at a position for all of them to come true."""
        for need in self.conditions:
            for requirement in need.required(position):
                yield replace(requirement, consumer=self.consumer)

    def links(self) -> Iterator[CausalLink]:
        """Give the links that end here."""
        for need in self.conditions:
            for leaf, through in need.leaves():
                yield CausalLink(
                    leaf.producer, leaf.literal, need.literal, self.consumer, tuple(through)
                )


def pattern_of(belief: Belief) -> Atom:
    """Give a belief as a pattern that it alone matches."""
    return Atom(belief.predicate, tuple(map(Constant, belief.args)))


def _belief(literal: Condition) -> Belief:
    args = tuple(term.value for term in literal.atom.args if isinstance(term, Constant))
    return Belief(literal.atom.predicate, args)
