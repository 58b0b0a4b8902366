"""Everything that can be wrong with a domain before it runs, found in one go."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from icarus_lite.language.checking.agents import check_agents, check_owner, known_agents
from icarus_lite.language.checking.contradictions import check_contradictions
from icarus_lite.language.checking.detaching import check_detaching
from icarus_lite.language.checking.expressions import check_expressions
from icarus_lite.language.checking.kinds import check_kinds
from icarus_lite.language.checking.long_term import check_long_term_goals
from icarus_lite.language.checking.patterns import Patterns
from icarus_lite.language.checking.possibility import check_effects, check_possibility
from icarus_lite.language.checking.reachability import check_reachability
from icarus_lite.language.checking.report import Report
from icarus_lite.language.checking.silencing import unsilenced
from icarus_lite.language.checking.stratification import negation_cycles, recursive_concepts
from icarus_lite.language.checking.usage import check_usage
from icarus_lite.language.checking.variables import check_concept_variables, check_skill_variables
from icarus_lite.language.checking.vocabulary import Origin, Vocabulary, vocabulary
from icarus_lite.language.diagnostics import Diagnostic, has_errors, in_order
from icarus_lite.language.functions import Function, PythonFunctions, function_table
from icarus_lite.language.percept_types import check_percept_types
from icarus_lite.language.syntax import (
    Atom,
    AttachmentRule,
    Bind,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Domain,
    DomainTest,
    LaterCycle,
    SkillClause,
    Span,
    Variable,
)
from icarus_lite.language.wording import listing
from icarus_lite.symbols import ATTACHED


def check_domain(
    domain: Domain, functions: PythonFunctions | None = None, *, thorough: bool = False
) -> tuple[Diagnostic, ...]:
    """Find every error, warning and note in a domain.

    Args:
        domain: A domain as parsed.
        functions: Python functions that its tests may call, by name.
        thorough: Whether to tell of names that nobody uses as well.

    Returns:
        The diagnostics in the order of the text; none of them an error if the domain can run.

    Raises:
        InferenceError: A Python function has the name of a function of the language.
    """
    found = _Check(domain, function_table(functions)).run(thorough=thorough)
    return unsilenced(in_order(found), domain.source)


class _Check:
    """One check of one domain."""

    def __init__(self, domain: Domain, functions: Mapping[str, Function]) -> None:
        self._domain = domain
        self._functions = functions
        self._names: Vocabulary = vocabulary(domain)
        self._report = Report(domain.source)
        self._patterns = Patterns(domain, self._names, functions, self._report)
        self._asked = _asked(domain)
        self._agents = known_agents(domain)

    def run(self, *, thorough: bool) -> list[Diagnostic]:
        """Check everything."""
        check_percept_types(self._domain.percepts, self._report)
        self._concepts()
        self._negation()
        for skill in self._domain.skills:
            self._skill(skill)
        for rule in self._domain.attachments:
            self._attachment(rule)
        check_contradictions(self._domain, self._names, self._patterns, self._report)
        for contradiction in self._domain.contradictions:
            self._expressions(contradiction.tests)
        self._tasks()
        self._patterns.conditions(self._domain.goals)
        check_agents(self._domain, self._report)
        for goal in self._domain.long_term_goals:
            self._patterns.conditions((*goal.goals, *goal.relevance))
        check_long_term_goals(self._domain.long_term_goals, self._report)
        heads = {clause.head for clause in self._domain.concepts}
        heads |= {clause.head for clause in self._domain.skills}
        for stop in self._domain.breakpoints:
            if stop.condition.atom not in heads:  # a head is checked with its clause
                self._breakpoint(stop.condition)
        for test in self._domain.tests:
            self._test(test)
        self._analyse(thorough=thorough)
        return self._report.diagnostics

    def _analyse(self, *, thorough: bool) -> None:
        """Look for what is well formed and yet cannot be meant."""
        check_possibility(self._domain, self._names, self._report)
        check_effects(self._domain, self._names, self._report)
        check_detaching(self._domain, self._report)
        check_reachability(self._domain, self._names, self._report)
        check_kinds(self._domain, self._functions, self._report)
        if thorough and not has_errors(self._report.diagnostics):
            check_usage(self._domain, self._report)

    def _concepts(self) -> None:
        recursive = recursive_concepts(self._domain.concepts)
        first: dict[str, ConceptClause] = {}
        for clause in self._domain.concepts:
            name = clause.head.predicate
            self._heads_agree(clause, first.setdefault(name, clause))
            self._patterns.conditions(clause.elements)
            self._expressions(clause.tests, clause.binds)
            check_concept_variables(clause, self._report, recursive=name in recursive)

    def _expressions(self, tests: Sequence[Call], binds: Sequence[Bind] = ()) -> None:
        predicates = self._names.predicates
        check_expressions(tests, binds, self._functions, self._report, predicates)

    def _heads_agree(self, clause: ConceptClause, first: ConceptClause) -> None:
        head, place = clause.head, self._report.name_of(clause.head)
        self._patterns.attributes_once(head)
        if clause is first:
            if self._patterns.defined(head.predicate, Origin.PERCEPT):
                message = f"`{head.predicate}` is both a percept type and a concept"
                hint = "its clauses add to what is perceived; :elements can use percepts directly"
                self._report.warning(place, "ICR032", message, hint)
            if head.predicate == ATTACHED and len(head.args) != 2:
                self._patterns.wrong_arity(head, 2, "its arguments are child and parent")
            return
        if len(head.args) != len(first.head.args):
            hint = f"its clause in {first.span.in_line} begins with {first.head}"
            self._patterns.wrong_arity(head, len(first.head.args), hint)
        ours, theirs = ({name for name, _ in atom.attributes} for atom in (head, first.head))
        if ours != theirs:
            message = f"this clause of `{head.predicate}` has different attributes"
            hint = f"its clause in {first.span.in_line} begins with {first.head}"
            self._report.error(head.span, "ICR018", message, hint)

    def _negation(self) -> None:
        for cycle in negation_cycles(self._domain.concepts):
            message = f"`{cycle.clause.head.predicate}` depends on its own negation: {cycle}"
            hint = "a concept must be decided before `not` asks for it; break the cycle"
            self._report.error(cycle.condition.span, "ICR019", message, hint)

    def _skill(self, clause: SkillClause) -> None:
        head, name = clause.head, clause.head.predicate
        first = self._names.skills[name]
        if len(head.args) != first.arity:
            self._patterns.wrong_arity(
                head, first.arity, f"its first clause is in {first.span.in_line}"
            )
        self._patterns.no_attributes(head)
        if bool(clause.subskills) == clause.is_primitive:
            has = "both :actions and :subskills" if clause.actions else "nothing to do"
            hint = ":actions for what the driver does, or :subskills for what other skills do"
            self._report.error(
                self._report.name_of(head), "ICR022", f"the skill `{name}` has {has}", hint
            )
        self._patterns.conditions((*clause.elements, *clause.holds))
        for effect in clause.effects:
            self._patterns.effect(effect.atom)
        self._expressions(clause.tests)
        for command in clause.actions:
            self._patterns.no_attributes(command)
        for call in clause.subskills:
            self._call_of_skill(call)
        check_skill_variables(clause, self._report)
        check_owner(clause, self._agents, self._report)

    def _call_of_skill(self, call: Atom) -> None:
        self._patterns.no_attributes(call)
        skill = self._names.skills.get(call.predicate)
        if skill is None:
            meant = self._report.closest(call.predicate, self._names.skills)
            hint = f"did you mean `{meant}`?" if meant else "add a clause for it to (skills …)"
            message = f"there is no skill `{call.predicate}`"
            self._report.error(self._report.name_of(call), "ICR023", message, hint)
        elif len(call.args) != skill.arity:
            self._patterns.wrong_arity(
                call, skill.arity, f"its first clause is in {skill.span.in_line}"
            )

    def _attachment(self, rule: AttachmentRule) -> None:
        for pattern in (rule.attach, rule.until):
            if pattern is not None:
                self._action_pattern(pattern)
        for role, term in (("child", rule.child), ("parent", rule.parent)):
            if isinstance(term, Variable) and term.name not in rule.attach.variables:
                message = f"the {role} {term} does not occur in {rule.attach}"
                hint = f"the {role} must be an argument of the action that attaches it"
                self._report.error(term.span, "ICR024", message, hint)

    def _action_pattern(self, pattern: Atom) -> None:
        """Check an action as it is observed: with skills in the domain, it should be one."""
        self._patterns.no_attributes(pattern)
        skill = self._names.skills.get(pattern.predicate)
        if skill is not None:
            if len(pattern.args) != skill.arity:
                hint = f"its first clause is in {skill.span.in_line}"
                self._patterns.wrong_arity(pattern, skill.arity, hint)
        elif self._names.skills:
            meant = self._report.closest(pattern.predicate, self._names.skills)
            hint = f"did you mean `{meant}`?" if meant else "only an observed action can match it"
            message = f"no skill is called `{pattern.predicate}`"
            self._report.warning(self._report.name_of(pattern), "ICR023", message, hint)

    def _tasks(self) -> None:
        first: dict[str, Span] = {}
        for task in self._domain.tasks:
            if task.name in first:
                message = f"there are two tasks `{task.name}`"
                hint = f"the first is in {first[task.name].in_line}; give each its own name"
                self._report.error(task.span, "ICR020", message, hint)
            first.setdefault(task.name, task.span)
            if not task.goals:
                message = f"the task `{task.name}` has no goal"
                hint = "say what must hold in the end: :goal ((attached hubcover case))"
                self._report.error(task.span, "ICR021", message, hint)
            self._patterns.conditions(task.goals)
            for fact in task.init:
                self._given(fact)
                self._asked_for(fact)

    def _given(self, fact: Atom) -> None:
        """Check a fact of `:init`: ground, and derived by nothing."""
        self._patterns.pattern(fact)
        self._ground(fact, "a fact of :init")
        name = fact.predicate
        if self._patterns.defined(name, Origin.PERCEPT):
            self._object_name(fact)
        elif self._patterns.defined(name, Origin.CONCEPT):
            message = f"`{name}` is a concept: it is derived, and cannot be given"
            hint = "give the facts that its clauses speak of"
            self._report.error(self._report.name_of(fact), "ICR070", message, hint)

    def _asked_for(self, fact: Atom) -> None:
        """Check that what a task gives is of use to somebody."""
        name = fact.predicate
        derived = self._patterns.defined(name, Origin.PERCEPT) or self._patterns.defined(
            name, Origin.CONCEPT
        )
        if name != ATTACHED and name not in self._asked and not derived:
            meant = self._report.closest(name, self._asked)
            hint = f"did you mean `{meant}`?" if meant else "remove it, or use it in a condition"
            message = f"nothing asks for `{name}`"
            self._report.warning(self._report.name_of(fact), "ICR070", message, hint)

    def _test(self, test: DomainTest) -> None:
        for fact in test.init:
            self._given(fact)
            if self._patterns.defined(fact.predicate, Origin.PERCEPT):
                message = f"`{fact.predicate}` is a percept: a test perceives it cycle by cycle"
                hint = "give it in :percepts"
                self._report.error(self._report.name_of(fact), "ICR070", message, hint)
        self._cycle_of_test(test, test.percepts)
        for later in test.then:
            self._cycle_of_test(later, later.percepts or ())
        self._patterns.conditions(test.goals)
        for step in test.plan or ():
            self._action_pattern(step)
            self._ground(step, "a plan of a test")

    def _cycle_of_test(self, test: DomainTest | LaterCycle, percepts: Iterable[Atom]) -> None:
        for percept in percepts:
            if self._patterns.defined(percept.predicate, Origin.PERCEPT):
                self._patterns.pattern(percept)
            elif self._domain.percepts:
                self._unknown_percept(percept)
            self._ground(percept, "a percept of a test")
            self._object_name(percept)
        for action in test.actions:
            self._action_pattern(action)
            self._ground(action, "an action of a test")
        for atom in (*test.expect, *test.expect_not):
            self._patterns.pattern(atom)

    def _object_name(self, percept: Atom) -> None:
        for name in percept.args[:1]:
            if isinstance(name, Constant) and not isinstance(name.value, str):
                message = f"the object's name {name} is a number"
                hint = "objects are named by symbols, such as o1"
                self._report.error(name.span, "ICR014", message, hint)

    def _breakpoint(self, condition: Condition) -> None:
        """Check what a run is to stop at: a belief, or a skill about to start."""
        if condition.atom.predicate in self._names.skills and not condition.negated:
            self._action_pattern(condition.atom)
        else:
            self._patterns.conditions((condition,))

    def _unknown_percept(self, percept: Atom) -> None:
        declared = [declaration.name for declaration in self._domain.percepts]
        meant = self._report.closest(percept.predicate, declared)
        hint = f"did you mean `{meant}`?" if meant else f"declared are {listing(declared)}"
        message = f"`{percept.predicate}` is not a percept type"
        self._report.error(self._report.name_of(percept), "ICR013", message, hint)

    def _ground(self, atom: Atom, what: str) -> None:
        for term in (*atom.args, *(value for _, value in atom.attributes)):
            if isinstance(term, Variable):
                message = f"{what} cannot hold the variable {term}"
                self._report.error(term.span, "ICR025", message, "write the object or value itself")


def _asked(domain: Domain) -> frozenset[str]:
    """Give the predicates that some condition or goal asks for."""
    conditions = [c for concept in domain.concepts for c in concept.elements]
    conditions += [c for skill in domain.skills for c in (*skill.elements, *skill.holds)]
    conditions += [c for clause in domain.contradictions for c in clause.elements]
    conditions += [*domain.goals, *(goal for task in domain.tasks for goal in task.goals)]
    conditions += [c for goal in domain.long_term_goals for c in (*goal.goals, *goal.relevance)]
    return frozenset(condition.atom.predicate for condition in conditions)
