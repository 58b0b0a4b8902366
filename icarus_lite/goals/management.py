"""Goal management: one goal at a time, the most important first.

Goals come and go (`Agenda`), and at each point where nothing is under way one of them is chosen:

* The goal that is being pursued is left only for one that is clearly more important, when nothing
  leads to it any longer, or when it is a goal no more. So two goals of about the same weight do not
  take turns at every breath (hysteresis).
* A goal to which nothing leads is set aside, and tried again when something that it depends on has
  changed (`Blockade`); meanwhile the next one has its turn.
* What is reached and no less important is not given up for it (`Pursuit`).

Source: Choi (2011), reactive goal management in ICARUS, for nomination and priorities.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from icarus_lite.execution import Choice, DecisionKind, Executor, GoalReport, Moment
from icarus_lite.goals.agenda import Agenda, Entry, report
from icarus_lite.goals.blockade import Blockade, Circumstances
from icarus_lite.goals.nomination import Nominator
from icarus_lite.goals.pursuit import MAX_UNDONE, Pursuit
from icarus_lite.language.syntax import Domain
from icarus_lite.outcomes import Outcome
from icarus_lite.planning import Failure, FailureReason
from icarus_lite.records import replace

SWITCHING_MARGIN = 1.0
"""By how much the priority of another goal must be greater for the present one to be left."""


class Management:
    """Chooses which goal an executor pursues.

    Args:
        executor: Carries out intentions, and pursues what it is given.
        domain: The skills and concepts.
        agenda: The goals; others may be added while running.
        nominator: Nominates the long-term goals of the domain; None leaves them alone.
        margin: By how much the priority of another goal must be greater for the present one to be
            left.
    """

    def __init__(
        self,
        executor: Executor,
        domain: Domain,
        agenda: Agenda,
        nominator: Nominator | None = None,
        margin: float = SWITCHING_MARGIN,
    ) -> None:
        self._executor = executor
        self._agenda = agenda
        self._nominator = nominator
        self._margin = margin
        self._pursuit = Pursuit(executor, agenda)
        self._circumstances = Circumstances(domain)

    def decide(
        self, moment: Moment, outcomes: Sequence[Outcome]
    ) -> tuple[Choice, tuple[GoalReport, ...]]:
        """Decide what to do in this cycle, and for which goal.

        Args:
            moment: What is known now, the outcomes taken into account.
            outcomes: What became of actions since the last cycle.

        Returns:
            The choice, and how each goal stands.
        """
        going, failures = self._executor.settle(moment, outcomes)
        nominated = {} if self._nominator is None else self._nominator.nominated(moment.facts)
        self._agenda.update(moment, nominated)
        if going is not None and self._may_leave(going, moment):
            self._executor.withdraw()
            going = None
        is_busy = going is not None or self._pursuit.is_unfinished
        dropped = self._agenda.drop([self._pursuit.name] if is_busy and self._pursuit.name else [])
        choice = self._choose(moment, failures) if going is None else going
        self._pursuit.foresee(choice, moment)
        acting = choice.kind not in (DecisionKind.ACHIEVED, DecisionKind.IMPASSE)
        pursued = self._pursuit.name if acting else None
        reports = [report(entry, dropped=True) for entry in dropped]
        reports += [report(entry, pursued=entry.name == pursued) for entry in self._agenda]
        return choice, tuple(reports)

    def _may_leave(self, going: Choice, moment: Moment) -> bool:
        """Tell whether the goal may be left here and now, and there is a reason to."""
        if going.kind is not DecisionKind.AWAIT or self._executor.intention is not None:
            return False
        present = self._pursuit.present
        if present is None or (present.leaving and not self._pursuit.is_unfinished):
            return True
        return self._next(moment, {}) is not present

    def _choose(self, moment: Moment, failures: tuple[Failure, ...]) -> Choice:
        """Choose a goal to which something leads, and a step toward it."""
        if self._executor.intention is not None:
            choice = self._executor.choose(moment, failures)
            if choice.kind is not DecisionKind.ACHIEVED:
                return choice
        self._pursuit.make_good()
        tried: dict[str, Choice] = {}
        while True:
            entry = self._next(moment, tried)
            if entry is None:
                return self._without_goal(moment, failures, tried)
            self._pursuit.take_up(entry)
            choice = self._executor.choose(moment, failures)
            if choice.kind is not DecisionKind.IMPASSE:
                entry.blockade = None
                return choice
            tried[entry.name] = choice
            self._set_aside(entry, choice.reason, choice.failures, moment)
            self._pursuit.leave()

    def _next(self, moment: Moment, tried: Mapping[str, Choice]) -> Entry | None:
        """Give the goal to pursue: the present one, unless another is clearly more important."""
        waiting = [entry for entry in self._agenda.in_turn() if entry.name not in tried]
        present = self._pursuit.present
        if present is not None and self._pursuit.is_unfinished:
            waiting = sorted([*waiting, present], key=lambda entry: -entry.priority)
        if len(waiting) == 1 and not tried and self._pursuit.foe_of(waiting[0]) is None:
            return waiting[0]  # with nothing else to do, it is tried even if it seemed hopeless
        if present not in waiting:
            present = None
        for entry in waiting:
            if entry is present:
                return entry
            if present is not None and entry.priority < present.priority + self._margin:
                return present
            if self._is_blocked(entry, moment):
                continue
            if present is None or self._can_begin(entry, moment):
                return entry
        return None

    def _is_blocked(self, entry: Entry, moment: Moment) -> bool:
        """Tell whether nothing leads to a goal, as far as is known already."""
        if self._pursuit.will_make_good(entry):
            return True
        foe = self._pursuit.foe_of(entry)
        if foe is not None:
            text = f"the way to it has undone {foe} {MAX_UNDONE} times"
            entry.blockade = Blockade(text, None, (Failure(FailureReason.LOOP, text),))
            return True
        blockade = entry.blockade
        return blockade is not None and blockade.circumstances == self._seen_by(entry, moment)

    def _can_begin(self, entry: Entry, moment: Moment) -> bool:
        """Tell whether something leads to a goal, before the present one is left for it."""
        found = self._executor.obstacle(self._pursuit.aims_of(entry), moment)
        if found is None:
            return True
        self._set_aside(entry, found.reason, (Failure(found.failure, found.reason),), moment)
        return False

    def _set_aside(
        self, entry: Entry, reason: str, failures: tuple[Failure, ...], moment: Moment
    ) -> None:
        """Remember that nothing leads to a goal as things are."""
        entry.blockade = Blockade(reason, self._seen_by(entry, moment), failures)

    def _seen_by(self, entry: Entry, moment: Moment) -> object:
        """Give what a goal depends on, as it is now."""
        aims = self._pursuit.aims_of(entry)
        return aims, self._executor.given_up, self._circumstances.at(moment, aims)

    def _without_goal(
        self, moment: Moment, failures: tuple[Failure, ...], tried: Mapping[str, Choice]
    ) -> Choice:
        """Decide with nothing to pursue: all goals are reached, or nothing leads to the others."""
        waiting = self._agenda.in_turn()
        if not waiting:
            self._pursuit.keep_all()
            return self._executor.choose(moment, failures)
        self._pursuit.leave()
        if len(waiting) == 1 and waiting[0].name in tried:
            return tried[waiting[0].name]
        blocked = [(each.name, each.blockade) for each in waiting if each.blockade is not None]
        reason = "; ".join(f"{name}: {blockade.reason}" for name, blockade in blocked)
        known = [failure for _, blockade in blocked for failure in blockade.failures]
        choice = next(iter(tried.values()), Choice(DecisionKind.IMPASSE, reason))
        return replace(choice, reason=reason, failures=tuple(dict.fromkeys([*failures, *known])))
