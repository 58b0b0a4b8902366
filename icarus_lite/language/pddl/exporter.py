"""A task of a domain as a PDDL domain and problem.

Concepts that depend on what skills change become derived predicates, skills become actions, and
attachments become explicit effects. What rests on percepts alone is evaluated at the start.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.language.checking.report import Report
from icarus_lite.language.diagnostics import Diagnostic, DomainError, has_errors, in_order
from icarus_lite.language.pddl.attaching import attachings, may_circle
from icarus_lite.language.pddl.exported_conditions import Conditions
from icarus_lite.language.pddl.exported_effects import EffectTranslation
from icarus_lite.language.pddl.exported_problem import ProblemTranslation
from icarus_lite.language.pddl.exported_rules import Rules
from icarus_lite.language.pddl.kinds import kinds_of, planned_skills
from icarus_lite.language.pddl.names import pddl_word
from icarus_lite.language.pddl.scope import RefusedError
from icarus_lite.language.pddl.situation import KnownState
from icarus_lite.language.pddl.syntax import (
    PddlAction,
    PddlDomain,
    PddlProblem,
    Typed,
    conjunction,
)
from icarus_lite.language.pddl.values import possible_values
from icarus_lite.language.pddl.vocabulary import PddlVocabulary, variable_name
from icarus_lite.language.syntax import Condition, Constant, Domain, SkillClause, Term
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Action, Value


@dataclass(frozen=True, slots=True)
class Exported:
    """A task as PDDL.

    Args:
        domain: The PDDL domain.
        problem: The PDDL problem.
        remarks: What a reader of the files should know, sentence by sentence.
        notes: What was left out, with its place in the domain file.
        steps: For each PDDL action, the skill and, for each of its arguments, the number of the
            action's parameter or a constant.
        objects: The value behind each PDDL object.
    """

    domain: PddlDomain
    problem: PddlProblem
    remarks: tuple[str, ...]
    notes: tuple[Diagnostic, ...]
    steps: Mapping[str, tuple[str, tuple[int | Constant, ...]]]
    objects: Mapping[str, Value]

    def skill(self, name: str, arguments: Sequence[str]) -> Action:
        """Give the skill behind a step of a PDDL plan.

        Raises:
            KeyError: The files have no such action or object.
        """
        skill, places = self.steps[name]
        values = [self.objects[argument] for argument in arguments]
        args = tuple(p.value if isinstance(p, Constant) else values[p] for p in places)
        return Action(skill, args)


def export_task(
    domain: Domain, task: str, goals: Sequence[Condition], state: KnownState
) -> Exported:
    """Write a task as PDDL.

    Args:
        domain: A checked domain.
        task: The task's name, for the problem's.
        goals: What is to be reached.
        state: The state to begin with.

    Raises:
        DomainError: Something has no counterpart in PDDL; it carries all such places.
        InferenceError: A test cannot be evaluated.
    """
    return _Export(domain, goals, state).run(task)


class _Export:
    """One export."""

    def __init__(self, domain: Domain, goals: Sequence[Condition], state: KnownState) -> None:
        self._domain = domain
        self._goals = goals
        self._state = state
        self._report = Report(domain.source)
        self._skills = planned_skills(domain)
        kinds = kinds_of(domain, goals, state.facts)
        self._names = PddlVocabulary(kinds, possible_values(domain, state.facts, kinds.changing))
        self._names.declare_types(domain, state.facts)
        self._conditions = Conditions(self._names, state, self._report)
        self._steps: dict[str, tuple[str, tuple[int | Constant, ...]]] = {}
        self._circular = may_circle(list(self._possible_bonds()))

    def run(self, task: str) -> Exported:
        """Export the task."""
        actions = tuple(self._actions())
        problem = ProblemTranslation(self._goals, self._state, self._names, self._conditions)
        goal = problem.goal()
        rules = Rules(self._names, self._conditions).all()
        init = problem.facts()
        self._note_overruled()
        found = in_order(self._report.diagnostics)
        if has_errors(found):
            raise DomainError(found, self._domain.source)
        names, name = self._names, pddl_word(self._domain.name, "d")
        typed = {v: Typed(names.object(v), names.type_of_value(v)) for v in problem.objects()}
        constants = tuple(typed[value] for value in names.constants)
        objects = tuple(each for value, each in typed.items() if value not in names.constants)
        return Exported(
            PddlDomain(name, names.types(), constants, names.predicates(), rules, actions),
            PddlProblem(pddl_word(f"{name}-{task}"), name, objects, init, goal),
            self._remarks(),
            found,
            self._steps,
            {each.name: value for value, each in typed.items()},
        )

    def _actions(self) -> Iterator[PddlAction]:
        numbers: dict[str, int] = {}
        for clause in self._skills:
            number = numbers.get(clause.head.predicate, 0) + 1
            try:
                action = self._action(clause, number)
            except RefusedError:
                continue  # so that everything that cannot be exported is told at once
            if action is not None:
                yield action
                numbers[clause.head.predicate] = number

    def _action(self, clause: SkillClause, number: int) -> PddlAction | None:
        positive = {n for c in clause.elements if not c.negated for n in c.atom.variables}
        unbound = [name for name in clause.head.variables if name not in positive]
        if unbound:
            message = f"`{clause.head}` is left out: only a caller can give {unbound[0]} a value"
            self._report.note(clause.head.span, "PDDL017", message)
            return None
        changed = [n for e in clause.effects for n in e.atom.variables if n in positive]
        wanted = [*clause.head.variables, *changed]
        owner = clause.head.predicate
        body = self._conditions.body(owner, clause.elements, clause.tests, wanted)
        if body is None:
            return None
        parameters = list(dict.fromkeys([*clause.head.variables, *body.types]))
        work = EffectTranslation(
            self._domain, clause, self._conditions, frozenset(parameters), self._circular
        )
        effects = work.run()
        name = self._names.action(clause.head.predicate, number)
        self._steps[name] = (
            clause.head.predicate,
            tuple(
                t if isinstance(t, Constant) else parameters.index(t.name) for t in clause.head.args
            ),
        )
        parts = tuple(dict.fromkeys([*body.parts, *work.extra]))
        place = f", {clause.span.in_line}" if clause.span.line else ""
        of = "" if clause.agent is None else f" of the agent {clause.agent}"
        return PddlAction(
            name,
            tuple(Typed(variable_name(p), body.types[p]) for p in parameters),
            conjunction(parts),
            effects,
            comment=f"the skill {clause.head}{of}{place}",
        )

    def _possible_bonds(self) -> Iterator[tuple[object, object]]:
        values = self._names.values

        def of(term: Term, clause: SkillClause) -> list[Value]:
            if isinstance(term, Constant):
                return [term.value]
            return list(values.of(term.name, clause.elements))

        for fact in self._state.facts:
            if fact.predicate == ATTACHED and len(fact.args) == 2:
                yield fact.args[0], fact.args[1]
        for clause in self._skills:
            if not values.can_hold(clause.elements):
                continue
            for each in attachings(self._domain, clause):
                pairs = itertools.product(of(each.child, clause), of(each.parent, clause))
                yield from (pair for pair in pairs if pair[0] != pair[1])

    def _note_overruled(self) -> None:
        for source in sorted(self._names.kinds.overruled):
            message = (
                f"`{source}` is defined and stated by effects: in PDDL an effect holds until "
                "another effect speaks of it"
            )
            clause = self._names.kinds.definitions[source][0]
            self._report.note(clause.head.span, "PDDL017", message)

    def _remarks(self) -> tuple[str, ...]:
        remarks = []
        if any(clause.agent is not None or clause.cost is not None for clause in self._skills):
            remarks.append("Actions of other agents stand beside one's own, and all cost the same.")
        if self._domain.contradictions:
            remarks.append("Contradictions are left out: no plan counts on a surprise.")
        evaluated = [
            used
            for used in self._names.used
            if used in self._names.rows
            or self._names.source_of(used) in self._names.kinds.evaluated
        ]
        if evaluated:
            remarks.append(f"Evaluated from the percepts at the start: {', '.join(evaluated)}.")
        return tuple(remarks)
