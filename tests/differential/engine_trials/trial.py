"""One trial: a random domain and history, through the network and through all that must agree."""

from __future__ import annotations

import random
import traceback
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

from engine_trials.clingo_oracle import ClingoOracle
from engine_trials.comparing import (
    Failure,
    all_named,
    changed_rows,
    differing,
    in_order,
    named,
    stretches,
    texts,
)
from engine_trials.histories import (
    Change,
    World,
    as_columns,
    as_delta,
    changed_columns,
    draw_history,
    worlds,
)
from engine_trials.programs import ProgramDraw
from engine_trials.proofs import circle, faults
from engine_trials.scenes import SceneDraw, scene_vocabulary
from engine_trials.scratch import Row, Scratch, row
from engine_trials.vocabulary import SUPERTYPE, Flavour, Vocabulary, draw_vocabulary
from engine_trials.writing import domain_text, history_text
from icarus_lite import Belief
from icarus_lite.inference import Derivation, FactStore
from icarus_lite.inference.network import (
    Budget,
    Changes,
    ForgottenError,
    Network,
    compile_domain,
)
from icarus_lite.language import check_domain, has_errors, parse_domain
from icarus_lite.language.syntax import ConceptClause, Domain

CROWDED_EVERY, PLAIN_EVERY, DEEP_EVERY, SCENE_EVERY = 25, 10, 10, 10
"""One trial in so many is of each special flavour: seeds 24, 49 …; 0, 10 …; 5, 15 …; 3, 13 …"""


@dataclass(frozen=True, slots=True)
class Trial:
    """A domain and a history.

    Args:
        seed: What it was drawn from; decides as well how each cycle is told to the network.
        vocabulary: The predicates.
        clauses: The concepts.
        history: The changes of each cycle.
    """

    seed: int
    vocabulary: Vocabulary
    clauses: tuple[ConceptClause, ...]
    history: tuple[Change, ...]

    @property
    def size(self) -> int:
        """How many percepts and asserted beliefs its cycles have in all."""
        return sum(len(each.percepts) + len(each.asserted) for each in worlds(self.history))

    def text(self) -> str:
        """Write the domain as an .icr file."""
        return domain_text(self.vocabulary, self.clauses)

    def domain(self) -> Domain:
        """Give the domain as the reader reads it.

        Raises:
            ValueError: it cannot be read or has errors, or an object is perceived twice.
        """
        for world in worlds(self.history):
            names = Counter((SUPERTYPE.get(p.type, p.type), p.name) for p in world.percepts)
            if any(count > 1 for count in names.values()):
                raise ValueError(f"perceived twice: {names}")
        domain, problems = parse_domain(self.text(), f"seed-{self.seed}.icr")
        problems = (*problems, *(check_domain(domain) if domain is not None else ()))
        if domain is None or has_errors(problems):
            raise ValueError([f"{each.code} {each.message}" for each in problems])
        return domain


def draw_trial(seed: int, cycles: int = 20, flavour: Flavour | None = None) -> Trial:
    """Draw the trial of a seed; its flavour follows from the seed unless it is given."""
    draw = random.Random(seed)
    flavour = flavour or flavour_of(seed)
    if flavour is Flavour.SCENE:
        vocabulary = scene_vocabulary(draw)
        clauses = SceneDraw(draw, vocabulary).clauses()
    else:
        vocabulary = draw_vocabulary(draw, flavour)
        clauses = ProgramDraw(draw, vocabulary).clauses()
    return Trial(seed, vocabulary, clauses, draw_history(draw, vocabulary, cycles))


def flavour_of(seed: int) -> Flavour:
    """Give what is special about the trial of a seed."""
    if seed % CROWDED_EVERY == CROWDED_EVERY - 1:
        return Flavour.CROWD
    if seed % SCENE_EVERY == 3:
        return Flavour.SCENE
    if seed % PLAIN_EVERY == 0:
        return Flavour.PLAIN
    return Flavour.DEEP if seed % DEEP_EVERY == DEEP_EVERY // 2 else Flavour.USUAL


def failure_of(trial: Trial) -> Failure | None:
    """Run a trial; give the first thing that is wrong, if any.

    Raises:
        ValueError: the domain or the history is not a legal one.
    """
    domain = trial.domain()
    try:
        return next(_Run(trial, domain).failures(), None)
    except Exception as error:  # noqa: BLE001 - whatever the engine raises is what the trial is for
        return Failure(f"error {type(error).__name__}", -1, traceback.format_exc())


def report(trial: Trial, failure: Failure) -> str:
    """Write a failure with all that is needed to see it again."""
    return (
        f"seed {trial.seed}, cycle {failure.cycle}: {failure.kind}\n{failure.message}\n\n"
        f"{trial.text()}\n{history_text(trial.history)}"
    )


def told_to_network(trial: Trial) -> Iterator[tuple[World, frozenset[str]]]:
    """Tell a network the history; give each world, and the beliefs as they are written."""
    network = compile_domain(trial.domain()).network()
    for change, world in zip(trial.history, worlds(trial.history), strict=True):
        network.update(as_delta(change))
        yield world, texts(network.beliefs())


class _Run:
    """The network of one trial, told its history and asked about it."""

    def __init__(self, trial: Trial, domain: Domain) -> None:
        self._trial = trial
        self._draw = random.Random(f"ways of seed {trial.seed}")
        self._domain = domain
        self._worlds = worlds(trial.history)
        self._compiled = compile_domain(self._domain)
        self._reviewing = random.Random(f"reviews of seed {trial.seed}")
        self._doubtful: list[Failure] = []
        # Every third network remembers little, so that its log forgets cycles on the way.
        budget = Budget(changes_kept=40) if self._draw.random() < 1 / 3 else Budget()
        self._network: Network = self._compiled.network(budget)
        self._scratch = Scratch(self._domain)

    def failures(self) -> Iterator[Failure]:
        wanted = self._wanted()
        copied = self._draw.randrange(len(wanted))
        before: frozenset[Row] = frozenset()
        for cycle, world in enumerate(self._worlds):
            yield from differing("Closure", cycle, wanted[cycle], self._scratch.beliefs(world))
            if cycle == copied:
                yield from self._imagined(cycle)
            changes = self._tell(cycle, world)
            yield from self._reviewed()
            got = frozenset(map(row, self._network.beliefs()))
            yield from differing("network", cycle, wanted[cycle], got)
            told = (texts(changes.added), texts(changes.removed), texts(changes.altered))
            real = changed_rows(before, got)
            if told != real:
                yield Failure("changes", cycle, f"told {told}, but what changed is {real}")
            before = got
            yield from self._asked(cycle, world, got)
        yield from self._remembered(wanted)
        yield from self._recalled(wanted)
        yield from self._retold(wanted[-1])

    def _wanted(self) -> list[frozenset[Row]]:
        """Give the beliefs of each cycle: clingo's, where clingo can have an opinion."""
        if self._trial.vocabulary.flavour is Flavour.DEEP:
            return [self._scratch.beliefs(world) for world in self._worlds]
        return ClingoOracle(self._domain).beliefs(self._worlds)

    def _tell(self, cycle: int, world: World) -> Changes:
        """Tell the network what has changed, in one of the ways there are."""
        change = self._trial.history[cycle]
        way = self._draw.random()
        before = self._worlds[cycle - 1] if cycle else World()
        columns = as_columns(change, before) if cycle else None
        if way < 0.5 and columns is not None:
            kind, names, values = columns
            if way < 0.35:
                values = changed_columns(kind, names, values, before)
            return self._network.move(kind, names, values, change.asserted, change.withdrawn)
        mistaken = self._mistaken(world) if self._reviewing.random() < 0.3 else ()
        seen = World(world.percepts, (*world.asserted, *mistaken))

        def review() -> Sequence[Belief]:
            wanted = self._scratch.beliefs(seen)
            got = frozenset(map(row, self._network.beliefs()))
            self._doubtful += differing("network under review", cycle, wanted, got)
            return mistaken

        if way < 0.2:
            return self._network.update_snapshot(world.percepts, seen.asserted, review)
        delta = as_delta(change)
        return self._network.update(
            replace(delta, asserted=(*delta.asserted, *mistaken)), review if mistaken else None
        )

    def _mistaken(self, world: World) -> tuple[Belief, ...]:
        """Draw beliefs that are asserted in other cycles, to be asserted and withdrawn at once."""
        other = self._reviewing.choice(self._worlds).asserted
        fresh = [belief for belief in other if belief not in world.asserted]
        return tuple(self._reviewing.sample(fresh, min(3, len(fresh))))

    def _reviewed(self) -> Iterator[Failure]:
        """Say what was wrong while a review looked at the beliefs."""
        found, self._doubtful = self._doubtful, []
        yield from found

    def _imagined(self, cycle: int) -> Iterator[Failure]:
        """Change a copy, which must not change the network itself."""
        other = self._network.copy()
        before = self._worlds[cycle - 1] if cycle else World()
        change = self._draw.choice(self._trial.history)
        there = {each.name for each in before.percepts}
        new = tuple(each for each in change.percepts if each.name not in there)
        change = replace(change, percepts=new)
        other.update(as_delta(change))
        wanted = self._scratch.beliefs(before.after(change))
        got = frozenset(map(row, other.beliefs()))
        for failure in differing("copy", cycle, wanted, got):
            yield replace(failure, message=f"{failure.message}\nthe copy was told {change}")

    def _asked(self, cycle: int, world: World, held: frozenset[Row]) -> Iterator[Failure]:
        """Ask about some beliefs, present and absent: whether they hold, and why."""
        facts, derived, given = self._facts(world)
        for name in {each for each, _, _ in held}:
            wanted = {named(each) for each in held if each[0] == name}
            network = self._network
            if network.count(name) != len(wanted) or texts(network.facts(name)) != wanted:
                yield Failure("facts", cycle, f"count or facts of {name} are not {wanted}")
        present = sorted(derived, key=str)
        for belief in self._draw.sample(present, min(4, len(present))):
            found = self._unfounded(self._network, belief, facts, derived[belief], given)
            for kind, message in found:
                yield Failure(kind, cycle, message)
        earlier = self._worlds[self._draw.randrange(len(self._worlds))]
        names = all_named(held)
        for name, args, _ in sorted(self._scratch.beliefs(earlier), key=str)[:5]:
            belief = Belief(name, args)
            if self._network.holds(belief) != (str(belief) in names):
                yield Failure("holds", cycle, f"{belief} is judged wrong")
        yield from self._matched(cycle, facts)

    def _unfounded(
        self,
        network: Network,
        belief: Belief,
        facts: FactStore,
        theirs: Sequence[Derivation],
        given: AbstractSet[Belief],
    ) -> Iterator[tuple[str, str]]:
        """Say what is wrong with the reasons for a belief: the kind of fault, and which."""
        reasons = list(network.supports(belief))
        for reason in reasons:
            for fault in faults(self._domain, facts, belief, reason):
                yield "supports", f"{belief}: {fault}"
        if sorted(map(self._reason, reasons)) != sorted(map(self._reason, theirs)):
            yield "supports", f"{belief}: {reasons}, but Closure has {theirs}"
        first = network.support(belief)
        if first != next(iter(reasons), None) and not (first is None and belief in given):
            yield "supports", f"{belief}: the first is not {first} of {reasons}"
        wrong = circle(belief, lambda each: _as_list(network.support(each)), given.__contains__)
        if wrong:
            yield "proof", wrong

    def _matched(self, cycle: int, facts: FactStore) -> Iterator[Failure]:
        """Match the conditions of one clause, alone."""
        clause = self._draw.choice(self._domain.concepts)
        for condition in clause.elements:
            wanted = [bound for bound, _ in facts.matches(condition.atom, {})]
            got = [dict(bound) for bound in self._network.matches(condition.atom, {})]
            if sorted(map(in_order, got)) != sorted(map(in_order, wanted)):
                yield Failure("matches", cycle, f"{condition.atom}: {got}, not {wanted}")

    def _remembered(self, wanted: Sequence[frozenset[Row]]) -> Iterator[Failure]:
        """Ask about the past, when all is over."""
        names = [all_named(each) for each in wanted]
        first = self._network.first_cycle
        for cycle, held in enumerate(names):
            try:
                told = texts(self._network.held_at(cycle))
            except ForgottenError:
                told = None
            if told != (held if cycle >= first else None):
                yield Failure("log", cycle, f"held_at gives not {sorted(held)}")
        beliefs = {(name, args) for cycle in wanted for name, args, _ in cycle}
        for name, args in self._draw.sample(sorted(beliefs, key=str), min(5, len(beliefs))):
            belief = Belief(name, args)
            got = list(self._network.intervals(belief))
            known = stretches([str(belief) in held for held in names])
            if got != [each for each in known if each[1] is None or each[1] >= first]:
                yield Failure("log", -1, f"{belief} is said to be held {got}")

    def _recalled(self, wanted: Sequence[frozenset[Row]]) -> Iterator[Failure]:
        """Go back to a cycle, and ask for the reasons of then; the present must not notice."""
        cycle = self._draw.randrange(self._network.first_cycle, len(wanted))
        then = self._network.recall(cycle)
        yield from differing("recall", cycle, wanted[cycle], frozenset(map(row, then.beliefs())))
        if set(then.percepts()) != set(self._worlds[cycle].percepts):
            yield Failure("recall", cycle, f"perceived was not {then.percepts()}")
        facts, derived, given = self._facts(self._worlds[cycle])
        present = sorted(derived, key=str)
        for belief in self._draw.sample(present, min(3, len(present))):
            for kind, message in self._unfounded(then, belief, facts, derived[belief], given):
                yield Failure(f"{kind} recalled", cycle, message)
        now = frozenset(map(row, self._network.beliefs()))
        yield from differing("network after recall", cycle, wanted[-1], now)
        if set(self._network.percepts()) != set(self._worlds[-1].percepts):
            yield Failure("recall", cycle, "the present percepts are others now")

    def _facts(
        self, world: World
    ) -> tuple[FactStore, Mapping[Belief, Sequence[Derivation]], AbstractSet[Belief]]:
        """Give all facts of a world, those derived with all derivations, and those given."""
        facts, derived = self._scratch.facts(world)
        return facts, derived, set(facts) - set(derived) | set(world.asserted)

    def _retold(self, wanted: frozenset[Row]) -> Iterator[Failure]:
        """Tell a new network the last world at once: how one came there must not matter."""
        network = self._compiled.network()
        network.update_snapshot(self._worlds[-1].percepts, self._worlds[-1].asserted)
        got = frozenset(map(row, network.beliefs()))
        yield from differing("network told at once", -1, wanted, got)

    def _reason(self, derivation: Derivation) -> tuple[str, ...]:
        number = self._domain.concepts.index(derivation.clause)
        return str(number), *map(str, derivation.matched)


def _as_list(support: Derivation | None) -> list[Derivation]:
    return [] if support is None else [support]
