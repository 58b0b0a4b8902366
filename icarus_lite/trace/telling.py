"""A recorded run told in words: what was done and why, what went otherwise, and what it led to.

The four things that an agent should be able to tell of itself, after P. Langley, B. Meadows,
M. Sridharan and D. Choi, "Explainable Agency for Intelligent Autonomous Systems" (IAAI 2017):
the decisions it took while planning and the alternatives it had; what it did, to what end; how
what happened diverged from its plan, and how it adapted; all in terms of its own goals and beliefs.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby, zip_longest

from icarus_lite.inference import Period, Withdrawal
from icarus_lite.outcomes import Status
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import ATTACHED
from icarus_lite.trace.recording import Recording
from icarus_lite.trace.serving import serves

_MOST = 3


@dataclass(slots=True)
class Episode:
    """An action, from its start to its end.

    Args:
        action: The action.
        first: The cycle in which it was started.
        aims: What it was for.
        reason: Why it was chosen.
        plan: The steps that were to follow.
        serves: What it was to bring about, and for which later step or goal.
        rejected: The skills that were considered besides, each with why it was not chosen.
        last: The cycle in which its end was reported; None if none was.
        status: How it ended.
        ended: Why it failed or was stopped, in words.
        added: The beliefs that were new when it ended.
        removed: The beliefs that were gone then.
    """

    action: str
    first: int
    aims: tuple[str, ...]
    reason: str
    plan: tuple[str, ...] = ()
    rejected: tuple[tuple[str, str], ...] = ()
    serves: tuple[str, ...] = ()
    last: int | None = None
    status: str = "not reported"
    ended: str = ""
    added: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Story:
    """A run as a story.

    Args:
        opening: What it was for.
        episodes: The actions, in order.
        standstills: When nothing led on, and why.
        hidden: When an object was not seen, and what was believed of its place meanwhile.
        withdrawn: What was believed and withdrawn, for something contradicts it, and when.
        ending: How it ended.
    """

    opening: str
    episodes: tuple[Episode, ...]
    standstills: tuple[tuple[Period, str], ...]
    hidden: tuple[str, ...]
    ending: str
    withdrawn: tuple[tuple[int, Withdrawal], ...] = ()

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> Iterator[str]:
        """Give its text, a line at a time."""
        yield self.opening
        yield ""
        yield "What it did, and why"
        if not self.episodes:
            yield "  It did nothing."
        for number, episode in enumerate(self.episodes, 1):
            yield from _episode(number, episode)
        diverged = list(self.divergences())
        yield ""
        yield "What went otherwise, and what it made of it"
        yield from (f"  {each}" for each in diverged or ["Nothing: all went as planned."])
        if self.hidden:
            yield ""
            yield "What it could not see, and believed all the same"
            yield from (f"  {each}" for each in self.hidden)
        yield ""
        yield self.ending

    def divergences(self) -> Iterator[str]:
        """Say what failed, stood still or was withdrawn, and what was done next, by cycles."""
        told: list[tuple[int, str]] = [
            (period.first, f"Cycle {_span(period)}: nothing led on: {reason}.")
            for period, reason in self.standstills
        ]
        told += [(cycle, f"Cycle {cycle}: {each}.") for cycle, each in self.withdrawn]
        for episode, following in zip_longest(self.episodes, self.episodes[1:]):
            if episode.status == "failed":
                next_step = "nothing more was started"
                if following is not None:
                    again = "again" if following.action == episode.action else "instead"
                    next_step = (
                        f"in cycle {following.first} it chose {following.action} {again}: "
                        f"{following.reason}"
                    )
                why = f": {episode.ended}" if episode.ended else ""
                text = f"Cycle {episode.last}: {episode.action} failed{why}; {next_step}."
                told.append((episode.last or episode.first, text))
        yield from (text for _, text in sorted(told))


@dataclass(slots=True)
class _Telling:
    """What is gathered while the lines go by."""

    episodes: list[Episode] = field(default_factory=list)
    stood: list[tuple[int, str]] = field(default_factory=list)
    last: Mapping[str, object] = field(default_factory=dict)


def tell(recording: Recording) -> Story:
    """Tell a recorded run.

    Raises:
        TraceError: a line of it cannot be read.
    """
    found = _Telling()
    for cycle in recording.cycles:
        record = recording.record(cycle)
        _end_episodes(found, cycle, recording)
        decision = record.get("decision")
        if isinstance(decision, dict):
            if decision.get("kind") == "act":
                episode = _begin(cycle, record, decision)
                episode.serves = tuple(serves(recording, cycle))
                found.episodes.append(episode)
            elif decision.get("kind") == "impasse":
                found.stood.append((cycle, str(decision.get("reason"))))
        found.last = record
    return Story(
        _opening(recording),
        tuple(found.episodes),
        tuple(_merged(found.stood)),
        tuple(_hidden(recording)),
        _ending(recording, found.last),
        tuple(recording.chronicle().withdrawals()),
    )


def _begin(cycle: int, record: Mapping[str, object], decision: Mapping[str, object]) -> Episode:
    skills, plan, candidates = (record.get(key) for key in ("skills", "path", "candidates"))
    rejected = [
        (str(row["skill"]), str(row["why_not"]))
        for row in (candidates if isinstance(candidates, list) else ())
        if not row["chosen"]
    ]
    aims = skills.get("aims", ()) if isinstance(skills, dict) else ()
    steps = plan if isinstance(plan, list) else []
    return Episode(
        str(decision["action"]),
        cycle,
        tuple(map(str, aims)),
        str(decision.get("reason", "")),
        tuple(map(str, steps[1:])),
        tuple(rejected),
    )


def _end_episodes(found: _Telling, cycle: int, recording: Recording) -> None:
    for _, outcome in recording.reports(cycle, cycle):
        if outcome.status is Status.RUNNING or not found.episodes:
            continue
        episode = found.episodes[-1]
        if episode.action != str(outcome.action) or episode.last is not None:
            continue
        added, removed = recording.changes(cycle)
        episode.last, episode.status, episode.ended = cycle, str(outcome.status), outcome.reason
        episode.added, episode.removed = tuple(map(str, added)), tuple(map(str, removed))


def _merged(stood: Sequence[tuple[int, str]]) -> Iterator[tuple[Period, str]]:
    """Put cycles in a row that stood still for the same reason together."""
    for _, run in groupby(enumerate(stood), key=lambda each: (each[1][0] - each[0], each[1][1])):
        row = [each for _, each in run]
        yield Period(row[0][0], row[-1][0]), row[0][1]


def _opening(recording: Recording) -> str:
    header = recording.header
    goals = " and ".join(recording.goals)
    found = header.get("intentions")
    intentions = ", ".join(map(str, found)) if isinstance(found, list) else ""
    wanted = [f"to achieve {goals}"] if goals else []
    wanted += [f"to carry out {intentions}"] if intentions else []
    task = f"Task {header['task']}" if header.get("task") else "The run"
    told = header.get("domain")
    domain = f" of {told['name']}" if isinstance(told, dict) and told.get("name") else ""
    return f"{task}{domain}: the agent was {' and '.join(wanted) or 'given no goal'}."


def _episode(number: int, episode: Episode) -> Iterator[str]:
    until = f" to {episode.last}" if episode.last not in (None, episode.first) else ""
    yield f"  {number}. {episode.action}, cycle {episode.first}{until}: {episode.status}"
    aims = " and ".join(episode.aims)
    yield f"     It was for {aims or 'nothing that is on record'}; chosen as {episode.reason}."
    if episode.plan:
        yield f"     Then it was to do {', '.join(episode.plan)}."
    for text in episode.serves[:_MOST]:
        yield f"     {text[0].upper()}{text[1:]}."
    for skill, why in episode.rejected[:_MOST]:
        yield f"     It did not choose {skill}: {why}."
    if episode.status == "succeeded":
        kept = [belief for belief in episode.added if not belief.startswith("(hidden")][:6]
        if kept:
            yield f"     From then on it believed {', '.join(kept)}."
    elif episode.ended:
        yield f"     {episode.ended}"


def _hidden(recording: Recording) -> Iterator[str]:
    """Say of each object when it was not seen though it was believed to be somewhere."""
    unseen: dict[str, list[int]] = {}
    for cycle, percepts in recording.percepts():
        for percept in percepts:
            if percept.attributes.get("seen") == "no":
                unseen.setdefault(percept.name, []).append(cycle)
    parents: dict[str, list[tuple[Period, str]]] = {}
    for predicate, periods in _attachments(recording):
        child, parent = predicate
        parents.setdefault(child, []).extend((period, parent) for period in periods)
    for name, cycles in sorted(unseen.items()):
        for _, run in groupby(enumerate(cycles), key=lambda each: each[1] - each[0]):
            row = [cycle for _, cycle in run]
            period = Period(row[0], row[-1])
            held = sorted(
                (max(p.first, row[0]), f"it was attached to {parent}")
                for p, parent in parents.get(name, ())
                if p.first <= row[-1] and (p.last is None or p.last >= row[0])
            )
            why = ", then ".join(text for _, text in held)
            if why:
                yield f"Cycle {_span(period)}: {name} was not seen; {why}."


def _attachments(
    recording: Recording,
) -> Iterator[tuple[tuple[str, str], tuple[Period, ...]]]:
    for belief, periods in recording.chronicle().held(ATTACHED):
        child, parent = belief.args
        yield (str(child), str(parent)), periods


def _ending(recording: Recording, last: Mapping[str, object]) -> str:
    if not len(recording):
        return "No cycle is on record."
    decision = last.get("decision")
    kind = decision.get("kind") if isinstance(decision, dict) else None
    reason = decision.get("reason") if isinstance(decision, dict) else ""
    where = f"after {len(recording)} cycles"
    if kind == "achieved":
        return f"It ended {where} with its goals achieved: {reason}."
    return f"It ended {where} without having achieved its goals; the last word was: {reason}."


def _span(period: Period) -> str:
    if period.last in (None, period.first):
        return str(period.first)
    return f"{period.first} to {period.last}"
