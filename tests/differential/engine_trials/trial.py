"""One trial: a random domain and history, through the network and through all that must agree."""

from __future__ import annotations

import random
import traceback
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace

from engine_trials.clingo_oracle import ClingoOracle
from engine_trials.histories import Change, World, draw_history, worlds
from engine_trials.programs import ProgramDraw
from engine_trials.proofs import circle, faults
from engine_trials.scratch import Row, Scratch, row
from engine_trials.vocabulary import SUPERTYPE, Flavour, Vocabulary, draw_vocabulary
from engine_trials.writing import domain_text, history_text
from icarus_lite import Belief
from icarus_lite.inference import Derivation, FactStore
from icarus_lite.inference.network import Changes, Delta, Network, compile_domain
from icarus_lite.language import check_domain, has_errors, parse_domain
from icarus_lite.language.syntax import ConceptClause, Domain
from icarus_lite.symbols import Value

CROWDED_EVERY, PLAIN_EVERY, DEEP_EVERY = 25, 10, 10
"""One trial in so many is of each special flavour: seeds 24, 49 …; 0, 10 …; 5, 15 …"""


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


@dataclass(frozen=True, slots=True)
class Failure:
    """Where a trial went wrong.

    Args:
        kind: What was asked: beliefs, attributes, changes, supports, proof, log, copy, error …
        cycle: In which cycle.
        message: What was expected and what came.
    """

    kind: str
    cycle: int
    message: str


def draw_trial(seed: int, cycles: int = 20, flavour: Flavour | None = None) -> Trial:
    """Draw the trial of a seed; its flavour follows from the seed unless it is given."""
    draw = random.Random(seed)
    vocabulary = draw_vocabulary(draw, flavour or _flavour(seed))
    clauses = ProgramDraw(draw, vocabulary).clauses()
    return Trial(seed, vocabulary, clauses, draw_history(draw, vocabulary, cycles))


def _flavour(seed: int) -> Flavour:
    if seed % CROWDED_EVERY == CROWDED_EVERY - 1:
        return Flavour.CROWD
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
        network.update(_delta(change))
        yield world, _texts(network.beliefs())


def compared(who: str, cycle: int, wanted: frozenset[str], got: frozenset[str]) -> Failure | None:
    """Compare beliefs as they are written."""
    if wanted == got:
        return None
    message = f"missing {sorted(wanted - got)}\nsurplus {sorted(got - wanted)}"
    return Failure(who, cycle, message)


class _Run:
    """The network of one trial, told its history and asked about it."""

    def __init__(self, trial: Trial, domain: Domain) -> None:
        self._trial = trial
        self._draw = random.Random(f"ways of seed {trial.seed}")
        self._domain = domain
        self._worlds = worlds(trial.history)
        self._compiled = compile_domain(self._domain)
        self._network: Network = self._compiled.network()
        self._scratch = Scratch(self._domain)

    def failures(self) -> Iterator[Failure]:
        wanted = self._wanted()
        copied = self._draw.randrange(len(wanted))
        before: frozenset[Row] = frozenset()
        for cycle, world in enumerate(self._worlds):
            yield from _difference("Closure", cycle, wanted[cycle], self._scratch.beliefs(world))
            if cycle == copied:
                yield from self._imagined(cycle)
            changes = self._tell(cycle, world)
            got = frozenset(map(row, self._network.beliefs()))
            yield from _difference("network", cycle, wanted[cycle], got)
            told = (_texts(changes.added), _texts(changes.removed), _texts(changes.altered))
            real = _changes(before, got)
            if told != real:
                yield Failure("changes", cycle, f"told {told}, but what changed is {real}")
            before = got
            yield from self._asked(cycle, world, got)
        yield from self._remembered(wanted)
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
        columns = _columns(change, self._worlds[cycle - 1]) if cycle else None
        if way < 0.5 and columns is not None:
            return self._network.move(*columns, change.asserted, change.withdrawn)
        if way < 0.2:
            return self._network.update_snapshot(world.percepts, world.asserted)
        return self._network.update(_delta(change))

    def _imagined(self, cycle: int) -> Iterator[Failure]:
        """Change a copy, which must not change the network itself."""
        other = self._network.copy()
        before = self._worlds[cycle - 1] if cycle else World()
        change = self._draw.choice(self._trial.history)
        there = {each.name for each in before.percepts}
        new = tuple(each for each in change.percepts if each.name not in there)
        change = replace(change, percepts=new)
        other.update(_delta(change))
        wanted = self._scratch.beliefs(before.after(change))
        got = frozenset(map(row, other.beliefs()))
        for failure in _difference("copy", cycle, wanted, got):
            yield replace(failure, message=f"{failure.message}\nthe copy was told {change}")

    def _asked(self, cycle: int, world: World, held: frozenset[Row]) -> Iterator[Failure]:
        """Ask about some beliefs, present and absent: whether they hold, and why."""
        facts, derived = self._scratch.facts(world)
        given = set(facts) - set(derived) | set(world.asserted)
        for name in {each for each, _, _ in held}:
            wanted = {_name(each) for each in held if each[0] == name}
            network = self._network
            if network.count(name) != len(wanted) or _texts(network.facts(name)) != wanted:
                yield Failure("facts", cycle, f"count or facts of {name} are not {wanted}")
        present = sorted(derived, key=str)
        for belief in self._draw.sample(present, min(4, len(present))):
            for kind, message in self._unfounded(belief, facts, derived[belief], given):
                yield Failure(kind, cycle, message)
        earlier = self._worlds[self._draw.randrange(len(self._worlds))]
        names = _names(held)
        for name, args, _ in sorted(self._scratch.beliefs(earlier), key=str)[:5]:
            belief = Belief(name, args)
            if self._network.holds(belief) != (str(belief) in names):
                yield Failure("holds", cycle, f"{belief} is judged wrong")
        yield from self._matched(cycle, facts)

    def _unfounded(
        self,
        belief: Belief,
        facts: FactStore,
        theirs: Sequence[Derivation],
        given: AbstractSet[Belief],
    ) -> Iterator[tuple[str, str]]:
        """Say what is wrong with the reasons for a belief: the kind of fault, and which."""
        reasons = [s for s in self._network.supports(belief) if isinstance(s, Derivation)]
        for reason in reasons:
            for fault in faults(self._domain, facts, belief, reason):
                yield "supports", f"{belief}: {fault}"
        if sorted(map(self._reason, reasons)) != sorted(map(self._reason, theirs)):
            yield "supports", f"{belief}: {reasons}, but Closure has {theirs}"
        wrong = circle(belief, self._network.supports, given.__contains__)
        if wrong:
            yield "proof", wrong

    def _matched(self, cycle: int, facts: FactStore) -> Iterator[Failure]:
        """Match the conditions of one clause, alone."""
        clause = self._draw.choice(self._domain.concepts)
        for condition in clause.elements:
            wanted = [bound for bound, _ in facts.matches(condition.atom, {})]
            got = [dict(bound) for bound in self._network.matches(condition.atom, {})]
            if sorted(map(_in_order, got)) != sorted(map(_in_order, wanted)):
                yield Failure("matches", cycle, f"{condition.atom}: {got}, not {wanted}")

    def _remembered(self, wanted: Sequence[frozenset[Row]]) -> Iterator[Failure]:
        """Ask about the past, when all is over."""
        names = [_names(each) for each in wanted]
        for cycle, held in enumerate(names):
            if _texts(self._network.held_at(cycle)) != held:
                yield Failure("log", cycle, f"held_at gives not {sorted(held)}")
        beliefs = {(name, args) for cycle in wanted for name, args, _ in cycle}
        for name, args in self._draw.sample(sorted(beliefs, key=str), min(5, len(beliefs))):
            belief = Belief(name, args)
            got = list(self._network.intervals(belief))
            if got != _intervals([str(belief) in held for held in names]):
                yield Failure("log", -1, f"{belief} is said to be held {got}")

    def _retold(self, wanted: frozenset[Row]) -> Iterator[Failure]:
        """Tell a new network the last world at once: how one came there must not matter."""
        network = self._compiled.network()
        network.update_snapshot(self._worlds[-1].percepts, self._worlds[-1].asserted)
        got = frozenset(map(row, network.beliefs()))
        yield from _difference("network told at once", -1, wanted, got)

    def _reason(self, derivation: Derivation) -> tuple[str, ...]:
        number = self._domain.concepts.index(derivation.clause)
        return str(number), *map(str, derivation.matched)


def _delta(change: Change) -> Delta:
    return Delta(change.percepts, change.gone, change.asserted, change.withdrawn)


def _columns(change: Change, before: World) -> tuple[str, list[str], dict[str, list[Value]]] | None:
    """Give a change as columns of values, if it only gives values to objects already there."""
    known = {(each.type, each.name): each.attributes for each in before.percepts}
    kinds = {each.type for each in change.percepts}
    keys = {tuple(sorted(each.attributes)) for each in change.percepts}
    if change.gone or len(kinds) != 1 or len(keys) != 1:
        return None
    for each in change.percepts:
        if not known.get((each.type, each.name), {"": 0}).keys() <= each.attributes.keys():
            return None
    names = [each.name for each in change.percepts]
    columns = {key: [each.attributes[key] for each in change.percepts] for key in keys.pop()}
    return kinds.pop(), names, columns


def _difference(
    who: str, cycle: int, wanted: frozenset[Row], got: frozenset[Row]
) -> Iterator[Failure]:
    if wanted == got:
        return
    kind = "attributes" if _names(wanted) == _names(got) else "beliefs"
    missing, surplus = sorted(map(str, wanted - got)), sorted(map(str, got - wanted))
    yield Failure(f"{kind} of {who}", cycle, f"missing {missing}\nsurplus {surplus}")


def _changes(before: frozenset[Row], now: frozenset[Row]) -> tuple[frozenset[str], ...]:
    added, removed = _names(now) - _names(before), _names(before) - _names(now)
    return added, removed, _names(now - before) - added


def _intervals(held: Sequence[bool]) -> list[tuple[int, int | None]]:
    spans: list[tuple[int, int | None]] = []
    for cycle, (before, now) in enumerate(zip([False, *held], held, strict=False)):
        if now and not before:
            spans.append((cycle, None))
        elif before and not now:
            spans[-1] = (spans[-1][0], cycle)
    return spans


def _name(belief: Row) -> str:
    return str(Belief(belief[0], belief[1]))


def _names(beliefs: Iterable[Row]) -> frozenset[str]:
    return frozenset(map(_name, beliefs))


def _texts(beliefs: Iterable[Belief]) -> frozenset[str]:
    return frozenset(map(str, beliefs))


def _in_order(bindings: Mapping[str, Value]) -> str:
    return str(sorted(bindings.items()))
