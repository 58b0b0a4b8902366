"""From the beliefs of now and goals to a planning problem without variables."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from icarus_lite.language.syntax import Condition, Domain
from icarus_lite.planning.beginning import Beginning
from icarus_lite.planning.ground_task import GroundTask
from icarus_lite.planning.grounding.bits import Bits, assign_bits
from icarus_lite.planning.grounding.facts import GIVEN, HELD
from icarus_lite.planning.grounding.instances import Derivation, Instance, Literals
from icarus_lite.planning.grounding.literals import Translation
from icarus_lite.planning.grounding.operators import InstanceOperator
from icarus_lite.planning.grounding.prepared import LateClosure, PlanningDomain
from icarus_lite.planning.grounding.reachability import Reached, reach
from icarus_lite.planning.grounding.rules import rules_of
from icarus_lite.planning.grounding.simplification import Simplified, left_of, simplify
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action, Belief

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.planning.grounding.closing import Closing
    from icarus_lite.planning.grounding.special_effects import Special


@dataclass(frozen=True, slots=True)
class Grounding:
    """A planning problem without variables, and what came up on the way to it.

    Args:
        task: The problem; where a goal is hopeless, one without operators.
        hopeless: The goals that no sequence of skills could make true even if nothing were ever
            undone.
        reached: All that could come to hold if nothing were ever undone.
        fluents: The predicates whose facts may change.
        closure: Gives what derives those of them that concepts define, as far as anybody asks.
    """

    task: GroundTask
    hopeless: tuple[Condition, ...]
    reached: Reached
    fluents: frozenset[str]
    closure: LateClosure

    def could_hold(self) -> Iterator[Belief]:
        """Give the beliefs that could come about if nothing were ever undone."""
        for predicate, args, attributes in self.reached.base.atoms:
            if " " not in predicate:
                yield Belief(predicate, args, dict(attributes))


def ground_task(
    domain: Domain,
    beginning: Beginning,
    goals: Sequence[Condition],
    *,
    excluded: Collection[Action] = (),
) -> GroundTask:
    """Give the planning problem of reaching goals from the beliefs of now.

    States, operators and derived facts mean exactly what `Imagination` makes of them.

    Args:
        domain: Skills, concepts and attachments.
        beginning: The beliefs of now.
        goals: The conjunction to achieve.
        excluded: Actions that must not be used.

    Raises:
        InferenceError: a test cannot be evaluated for what is believed now.
    """
    return ground_goals(
        PlanningDomain(domain, beginning.evaluator), beginning, goals, excluded=excluded
    ).task


def ground_goals(
    domain: PlanningDomain,
    beginning: Beginning,
    goals: Sequence[Condition],
    *,
    excluded: Collection[Action] = (),
    watched: Sequence[str] | None = None,
) -> Grounding:
    """Give the planning problem, in a domain that is kept for the next time.

    Args:
        domain: The domain, with what grounding has made of it.
        beginning: The beliefs of now.
        goals: The conjunction to achieve.
        excluded: Actions that must not be used.
        watched: Predicates whose facts are to be in the states although the goals need not
            depend on them. Then nothing is left out.

    Raises:
        InferenceError: a test cannot be evaluated for what is believed now.
    """
    prepared = domain.prepare(goals, watched or (), banning=bool(excluded))
    reached = reach(prepared, beginning, excluded)
    translation = Translation(prepared, reached)
    problem = translation.literals()
    wanted = translation.goal(prepared.goals)
    hopeless = [goal for goal, literals in wanted if literals is None]
    hopeless += [
        goal
        for goal in prepared.goals
        if goal.atom.predicate not in prepared.fluents and not beginning.holds([goal])
    ]
    literals = [x for _, found in wanted for x in found or ()]
    simplified = simplify(problem, literals if watched is None else None)
    hopeless += [
        goal
        for goal, found in wanted
        if found and left_of(found, problem.constant, simplified.impossible) is None
    ]
    if watched is not None:
        left = tuple(literals)
    elif hopeless or simplified.goal is None:
        left = None
    else:
        left = simplified.goal
    return Grounding(
        _encode(problem, simplified, left),
        tuple(hopeless),
        reached,
        prepared.fluents,
        prepared.closure,
    )


def _encode(problem: Literals, simplified: Simplified, goal: tuple[int, ...] | None) -> GroundTask:
    """Put a problem in literals onto bits."""
    needed = set(simplified.needed).union(goal or ())
    ways = [way for found in simplified.derivations.values() for way in found]
    tracked = needed.union(*(way.conditions for way in ways))
    bits = assign_bits(problem, tracked, simplified.derivations)
    closing = _closing(problem, simplified.derivations, bits)
    initial = 0
    for number in {n if n >= 0 else ~n for n in tracked}:
        initial |= bits.masks.get(number if number in problem.initial else ~number, 0)
    operators = _operators(problem, simplified.instances, bits, closing)
    rules = tuple(rules_of(problem, simplified.derivations, needed, bits))
    if goal is None:
        places: tuple[int, ...] = (_never(bits),)
    else:
        places = tuple(dict.fromkeys(bits.places[literal] for literal in goal))
    return GroundTask(
        tuple(bits.atoms),
        initial if closing is None else closing(initial),
        places,
        operators,
        rules,
        closing,
    )


def _never(bits: Bits) -> int:
    return bits.add(Belief("never "))


def _operators(
    problem: Literals, instances: Sequence[Instance], bits: Bits, closing: Closing | None
) -> tuple[InstanceOperator, ...]:
    exceptions = _exceptions(problem, instances, bits, closing)
    every = (1 << len(bits.atoms)) - 1
    masks, places, operators = bits.masks, bits.places, []
    for place, each in enumerate(instances):
        add = gone = 0
        for number in each.adds:
            add |= masks.get(number, 0)
            gone |= masks.get(~number, 0)
        for number in each.deletes:
            gone |= masks.get(number, 0)
            add |= masks.get(~number, 0)
        special, possible = exceptions.get(place), add
        if special is not None:
            possible |= bits.mask(each.expected)
            possible |= bits.opposite(undenied for _, undenied in each.ended)
            for _, numbers in each.hierarchy:
                possible |= bits.mask(numbers) | bits.opposite(problem.hierarchy)
        conditions = tuple([places[literal] for literal in each.conditions])
        operators.append(InstanceOperator(each, conditions, add, every & ~gone, possible, special))
    return tuple(operators)


def _exceptions(
    problem: Literals, instances: Sequence[Instance], bits: Bits, closing: Closing | None
) -> dict[int, Special]:
    """Give the effects that depend on the state, by the places of their instances."""
    dependent = [place for place, each in enumerate(instances) if each.depends_on_state]
    if not dependent:
        return {}
    from icarus_lite.planning.grounding import special_effects  # noqa: PLC0415 - else not needed

    links, beliefs = special_effects.links_of(problem, bits), _beliefs(problem)
    found = (
        (place, special_effects.special_effects(instances[place], bits, links, closing, beliefs))
        for place in dependent
    )
    return {place: special for place, special in found if special is not None}


def _closing(
    problem: Literals, derivations: dict[int, list[Derivation]], bits: Bits
) -> Closing | None:
    if not derivations:
        return None
    from icarus_lite.planning.grounding.closing import Closing  # noqa: PLC0415 - else not needed

    return Closing(problem, derivations, bits)


def _beliefs(problem: Literals) -> dict[int, Sequence[int]]:
    """Give, for each fact that a belief is asserted or held, that belief with all its values."""
    beliefs: dict[int, Sequence[int]] = {}
    for head, ways in problem.derivations.items():
        for way in ways:
            for literal in way.conditions[:1]:
                if literal >= 0 and problem.atoms[literal][0].startswith((GIVEN, HELD)):
                    beliefs[literal] = problem.variants.get(head, (head,))
    return beliefs
