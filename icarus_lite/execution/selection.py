"""Choosing a skill path: downwards from a goal or a call to a primitive skill that can act now.

At each level the clauses are tried as the domain orders them, their instances in the order of the
beliefs, and of a macro's subskills only the first whose effects are not yet believed. What cannot
be continued down to a primitive is undone and the next alternative tried (backtracking), so that
the same beliefs always give the same path.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TypeAlias

from icarus_lite.execution.experience import Experience
from icarus_lite.execution.moment import Moment
from icarus_lite.execution.path import Bound, Level, as_bound
from icarus_lite.execution.refusal import Refusal
from icarus_lite.execution.repertoire import Repertoire, Skill, passed_back, passed_down
from icarus_lite.inference import Bindings, change_of, match, unify
from icarus_lite.language.syntax import Atom, Condition, Constant
from icarus_lite.planning import Failure, FailureReason, plan_step
from icarus_lite.records import replace
from icarus_lite.symbols import Value

MAX_DEPTH = 1_000
"""Levels of one path; a recursion that gets there does not end."""

MAX_TRIED = 10_000
"""Skill instances tried for one path before the search for it is given up."""

_Objection: TypeAlias = tuple[FailureReason, str]
_PassBack: TypeAlias = Callable[[Bindings], dict[str, Value] | None]


class Selection:
    """One choice of a path, and what came of it.

    Afterwards `refusals` has what was considered and not taken up, and `failures` what went wrong
    beyond that: a level of the path that could not be kept to, a skill that does not exist.

    Args:
        repertoire: The skills.
        moment: What is known now.
        experience: What has been tried before.
    """

    __slots__ = ("_dead_ends", "_experience", "_moment", "_repertoire", "failures", "refusals")

    def __init__(self, repertoire: Repertoire, moment: Moment, experience: Experience) -> None:
        self._repertoire = repertoire
        self._moment = moment
        self._experience = experience
        # From here no primitive can be reached. This holds wherever the same comes up again, even
        # if the way was barred by a skill further up the path: were there a way on from that one,
        # it would be found from there, and once it has none, nor has what calls it.
        self._dead_ends: set[tuple[int, Bound, int]] = set()
        self.refusals: list[Refusal] = []
        self.failures: list[Failure] = []

    def descend(
        self, above: tuple[Level, ...], options: Iterator[Level]
    ) -> tuple[Level, ...] | None:
        """Find the first way down to a primitive skill.

        Args:
            above: The levels that stay as they are.
            options: What may come below them, best first.

        Returns:
            The whole path, the levels above included; None if no option leads to a primitive.
        """
        chosen: list[Level] = []
        pending, tried = [options], 0
        while pending:
            level = next(pending[-1], None)
            if level is None:
                pending.pop()
                if chosen:
                    macro = chosen.pop()
                    self._dead_ends.add(_key(macro))
                    text = f"{macro.call} cannot begin"
                    self.refuse(FailureReason.SUBSKILL_CALL_FAILED, macro, text)
                continue
            if _key(level) in self._dead_ends:
                continue
            tried += 1
            if tried > MAX_TRIED:
                text = f"no skill path among the first {MAX_TRIED} instances tried"
                self.failures.append(Failure(FailureReason.SEARCH_LIMIT, text))
                return None
            if not self._may_enter(level, chosen, len(above)):
                continue
            if level.is_primitive:
                return (*above, *chosen, level)
            chosen.append(level)
            pending.append(self.calls(level))
        return None

    def toward(self, goal: Condition) -> Iterator[Level]:
        """Give the skill instances with an effect that serves a goal and that could start now."""
        seen, serving = set[Level](), False
        for skill in self._repertoire.skills:
            for effect in skill.effects:
                given = _aimed(effect, goal)
                if given is None:
                    continue
                serving = True
                if skill.clause.agent is not None:
                    continue  # whether to ask somebody is weighed by planning
                for level in self._instances(skill, given):
                    if level not in seen and self._serves(skill, level, goal):
                        seen.add(level)
                        yield level
        if not serving:
            text = f"no skill has {goal} among its effects"
            self.failures.append(Failure(FailureReason.NO_SKILL_FOR_GOAL, text))

    def call(self, call: Atom, bindings: Bindings) -> Iterator[Level]:
        """Give the instances of a called skill that could start now, or go on from here.

        Args:
            call: The skill's name with arguments; variables that the caller has not bound are
                bound by the skill itself.
            bindings: What the caller has bound.
        """
        skills = self._repertoire.named(call)
        if not skills:
            text = f"no skill is called {call.predicate} with {len(call.args)} arguments"
            self.failures.append(Failure(FailureReason.NO_SKILL_FOR_GOAL, text))
        for skill in skills:
            head = skill.clause.head
            given = passed_down(call, bindings, head)
            if given is not None:
                yield from self._instances(skill, given, partial(passed_back, call, bindings, head))

    def calls(self, macro: Level) -> Iterator[Level]:
        """Give what may come below a macro: the instances of the subskill it has come to."""
        subskill = macro.clause.subskills[macro.position]
        return self.call(subskill, dict(macro.bindings))

    def onward(self, macro: Level) -> Iterator[Level]:
        """Give the macro at its first subskill that is not done, from its position on.

        Subskills whose effects are believed are passed over; what they bind is kept. There are
        several ways if they are believed in several ways. A macro with nothing left to do is given
        at its end.
        """
        if macro.is_at_end:
            yield macro
            return
        subskill, met = macro.clause.subskills[macro.position], False
        bindings = dict(macro.bindings)
        for way in self._repertoire.ways_met(subskill, bindings, self._moment.facts):
            met = True
            yield from self.onward(
                replace(macro, bindings=as_bound(way), position=macro.position + 1)
            )
        if not met:
            yield macro

    def refuse(self, reason: FailureReason, level: Level, text: str = "") -> Refusal:
        """Note that an instance is not taken up, and give the note."""
        skill = self._repertoire.of(level.clause)
        refusal = Refusal(reason, skill, level.bindings, text)
        self.refusals.append(refusal)
        return refusal

    def give_up(self, reason: FailureReason, level: Level, text: str = "") -> None:
        """Note that an instance that was under way cannot go on."""
        refusal = self.refuse(reason, level, text)
        self.failures.append(refusal.explained(self._moment.facts, self._repertoire.evaluator))

    def _instances(
        self, skill: Skill, given: dict[str, Value], back: _PassBack | None = None
    ) -> Iterator[Level]:
        facts, startable = self._moment.facts, False
        for found in skill.start.matches(facts, given):
            bindings = dict(found.bindings)
            if back is not None and back(bindings) is None:
                continue
            startable = True
            if skill.is_done(facts, bindings):
                continue
            level = Level(skill.clause, as_bound(bindings), since_s=self._moment.time_s)
            if level.is_primitive:
                yield level
                continue
            for way in self.onward(level):
                if way.is_at_end:
                    self.refuse(FailureReason.MACRO_EXHAUSTED, way)
                else:
                    yield way
        if not startable:
            reason = FailureReason.CONDITIONS_UNSATISFIED
            self.refusals.append(Refusal(reason, skill, as_bound(given)))

    def _serves(self, skill: Skill, level: Level, goal: Condition) -> bool:
        """Tell whether an instance does something for a goal that is not believed."""
        bindings = dict(level.bindings)
        change = change_of(skill.effects, bindings)
        if goal.negated:
            wrong = self._moment.facts.matches(goal.atom, {})
            return any(change.removes(fact) for _, fact in wrong)
        if any(match(goal.atom, fact, {}) is not None for fact in change.added):
            return True
        return any(  # an effect that a subskill has yet to bind
            not e.negated and e.atom.predicate == goal.atom.predicate
            for e in skill.effects
            if not set(e.atom.variables) <= set(bindings)
        )

    def _may_enter(self, level: Level, chosen: list[Level], above: int) -> bool:
        objection = self._circle(level, chosen, above)
        if objection is None and not self._repertoire.of(level.clause).holds(
            self._moment.facts, dict(level.bindings)
        ):
            objection = FailureReason.WHILE_BROKEN, "its :while does not hold"
        if objection is None and level.is_primitive:
            objection = self._inability(level)
        if objection is not None:
            self.refuse(objection[0], level, objection[1])
        return objection is None

    def _circle(self, level: Level, chosen: list[Level], above: int) -> _Objection | None:
        """Say why taking a level up would be going in a circle, if it would."""
        if any(level.clause is c.clause and level.bindings == c.bindings for c in chosen):
            return FailureReason.LOOP, "it calls itself, and nothing is done in between"
        if above + len(chosen) >= MAX_DEPTH:
            return FailureReason.LOOP, f"skills call one another {MAX_DEPTH} levels deep"
        text = self._experience.circle(level, self._moment.scene)
        return (FailureReason.LOOP, text) if text else None

    def _inability(self, level: Level) -> _Objection | None:
        """Say why a primitive skill cannot be carried out, if it cannot."""
        bindings = dict(level.bindings)
        step = plan_step(level.clause, bindings)
        if step is None:
            atoms = (level.clause.head, *level.clause.actions)
            free = {name for atom in atoms for name in atom.variables if name not in bindings}
            return FailureReason.UNBOUND_ACTION_ARGS, f"nothing binds {', '.join(sorted(free))}"
        why = self._experience.given_up.get(step.action)
        if why is not None and step.clause.agent is not None:
            return FailureReason.REQUEST_REFUSED, why
        if why is not None:
            return FailureReason.DRIVER_FAILED, f"it has failed too often: {why}"
        return None


def _key(level: Level) -> tuple[int, Bound, int]:
    return id(level.clause), level.bindings, level.position


def _aimed(effect: Condition, goal: Condition) -> dict[str, Value] | None:
    """Bind a skill by a goal that one of its effects may serve; None if it cannot."""
    own, wanted = effect.atom, goal.atom
    if effect.negated is not goal.negated or own.predicate != wanted.predicate:
        return None
    if len(own.args) != len(wanted.args):
        return None
    attributes = dict(own.attributes)
    if any(name not in attributes for name, _ in wanted.attributes):
        return None
    pairs = list(zip(own.args, wanted.args, strict=True))
    pairs += [(attributes[name], term) for name, term in wanted.attributes]
    return unify((mine, term.value) for mine, term in pairs if isinstance(term, Constant))
