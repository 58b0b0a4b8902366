"""Everything that can be wrong with a domain before it runs, found in one go."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from icarus_lite.language.diagnostics import Diagnostic, in_order
from icarus_lite.language.explanations import closest, listing
from icarus_lite.language.expressions import check_expressions
from icarus_lite.language.functions import Function, PythonFunctions, function_table
from icarus_lite.language.report import Report
from icarus_lite.language.stratification import negation_cycles, recursive_concepts
from icarus_lite.language.syntax import (
    Atom,
    AttachmentRule,
    ConceptClause,
    Condition,
    Constant,
    Domain,
    DomainTest,
    LaterCycle,
    SkillClause,
    Variable,
)
from icarus_lite.language.variables import check_concept_variables, check_skill_variables
from icarus_lite.language.vocabulary import ATTACHED, Definition, Origin, Vocabulary, vocabulary


def check_domain(
    domain: Domain, functions: PythonFunctions | None = None
) -> tuple[Diagnostic, ...]:
    """Find every error, warning and note in a domain.

    Args:
        domain: A domain as parsed.
        functions: Python functions that its tests may call, by name.

    Returns:
        The diagnostics in the order of the text; none of them an error if the domain can run.

    Raises:
        InferenceError: A Python function has the name of a function of the language.
    """
    return _Check(domain, function_table(functions)).run()


class _Check:
    """One check of one domain."""

    def __init__(self, domain: Domain, functions: Mapping[str, Function]) -> None:
        self._domain = domain
        self._functions = functions
        self._names: Vocabulary = vocabulary(domain)
        self._report = Report(domain.source)
        self._assumed: set[str] = set()

    def run(self) -> tuple[Diagnostic, ...]:
        """Check everything."""
        self._percept_types()
        self._concepts()
        self._negation()
        for skill in self._domain.skills:
            self._skill(skill)
        for rule in self._domain.attachments:
            self._attachment(rule)
        self._tasks()
        self._conditions(self._domain.goals)
        for test in self._domain.tests:
            self._test(test)
        return in_order(self._report.diagnostics)

    def _percept_types(self) -> None:
        first: dict[str, int] = {}
        for percept in self._domain.percepts:
            if percept.name in first:
                message = f"the percept type `{percept.name}` is declared twice"
                hint = f"it is declared in line {first[percept.name]} already; merge the two"
                self._report.error(percept.span, "ICR011", message, hint)
            first.setdefault(percept.name, percept.span.line)
            for name in _repeated(percept.attributes):
                message = f"the attribute `^{name}` is declared twice"
                self._report.error(percept.span, "ICR011", message, "remove one of them")

    def _concepts(self) -> None:
        recursive = recursive_concepts(self._domain.concepts)
        first: dict[str, ConceptClause] = {}
        for clause in self._domain.concepts:
            name = clause.head.predicate
            self._heads_agree(clause, first.setdefault(name, clause))
            self._conditions(clause.elements)
            check_expressions(clause.tests, clause.binds, self._functions, self._report)
            check_concept_variables(clause, self._report, recursive=name in recursive)

    def _heads_agree(self, clause: ConceptClause, first: ConceptClause) -> None:
        head, place = clause.head, self._report.name_of(clause.head)
        self._attributes_once(head)
        if clause is first:
            if self._defined(head.predicate, Origin.PERCEPT):
                message = f"`{head.predicate}` is both a percept type and a concept"
                hint = "its clauses add to what is perceived; :elements can use percepts directly"
                self._report.warning(place, "ICR032", message, hint)
            if head.predicate == ATTACHED and len(head.args) != 2:
                self._wrong_arity(head, 2, "its arguments are child and parent")
            return
        if len(head.args) != len(first.head.args):
            hint = f"its clause in line {first.span.line} begins with {first.head}"
            self._wrong_arity(head, len(first.head.args), hint)
        ours, theirs = ({name for name, _ in atom.attributes} for atom in (head, first.head))
        if ours != theirs:
            message = f"this clause of `{head.predicate}` has different attributes"
            hint = f"its clause in line {first.span.line} begins with {first.head}"
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
            self._wrong_arity(head, first.arity, f"its first clause is in line {first.span.line}")
        self._no_attributes(head)
        if bool(clause.actions) == bool(clause.subskills):
            has = "both :actions and :subskills" if clause.actions else "nothing to do"
            hint = ":actions for what the driver does, or :subskills for what other skills do"
            self._report.error(
                self._report.name_of(head), "ICR022", f"the skill `{name}` has {has}", hint
            )
        self._conditions((*clause.elements, *clause.holds, *clause.effects))
        check_expressions(clause.tests, (), self._functions, self._report)
        for command in clause.actions:
            self._no_attributes(command)
        for call in clause.subskills:
            self._call_of_skill(call)
        check_skill_variables(clause, self._report)

    def _call_of_skill(self, call: Atom) -> None:
        self._no_attributes(call)
        skill = self._names.skills.get(call.predicate)
        if skill is None:
            meant = closest(call.predicate, self._names.skills)
            hint = f"did you mean `{meant}`?" if meant else "add a clause for it to (skills …)"
            message = f"there is no skill `{call.predicate}`"
            self._report.error(self._report.name_of(call), "ICR023", message, hint)
        elif len(call.args) != skill.arity:
            self._wrong_arity(call, skill.arity, f"its first clause is in line {skill.span.line}")

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
        self._no_attributes(pattern)
        skill = self._names.skills.get(pattern.predicate)
        if skill is not None:
            if len(pattern.args) != skill.arity:
                hint = f"its first clause is in line {skill.span.line}"
                self._wrong_arity(pattern, skill.arity, hint)
        elif self._names.skills:
            meant = closest(pattern.predicate, self._names.skills)
            hint = f"did you mean `{meant}`?" if meant else "only an observed action can match it"
            message = f"no skill is called `{pattern.predicate}`"
            self._report.warning(self._report.name_of(pattern), "ICR023", message, hint)

    def _tasks(self) -> None:
        first: dict[str, int] = {}
        for task in self._domain.tasks:
            if task.name in first:
                message = f"there are two tasks `{task.name}`"
                hint = f"the first is in line {first[task.name]}; give each its own name"
                self._report.error(task.span, "ICR020", message, hint)
            first.setdefault(task.name, task.span.line)
            if not task.goals:
                message = f"the task `{task.name}` has no goal"
                hint = "say what must hold in the end: :goal ((attached hubcover case))"
                self._report.error(task.span, "ICR021", message, hint)
            self._conditions(task.goals)

    def _test(self, test: DomainTest) -> None:
        self._cycle_of_test(test, test.percepts)
        for later in test.then:
            self._cycle_of_test(later, later.percepts or ())
        self._conditions(test.goals)
        for step in test.plan or ():
            self._action_pattern(step)
            self._ground(step, "a plan of a test")

    def _cycle_of_test(self, test: DomainTest | LaterCycle, percepts: Iterable[Atom]) -> None:
        for percept in percepts:
            if self._defined(percept.predicate, Origin.PERCEPT):
                self._pattern(percept)
            elif self._domain.percepts:
                self._unknown_percept(percept)
            self._ground(percept, "a percept of a test")
            for name in percept.args[:1]:
                if isinstance(name, Constant) and not isinstance(name.value, str):
                    message = f"the object's name {name} is a number"
                    hint = "objects are named by symbols, such as o1"
                    self._report.error(name.span, "ICR014", message, hint)
        for action in test.actions:
            self._action_pattern(action)
            self._ground(action, "an action of a test")
        for atom in (*test.expect, *test.expect_not):
            self._pattern(atom)

    def _unknown_percept(self, percept: Atom) -> None:
        declared = [declaration.name for declaration in self._domain.percepts]
        meant = closest(percept.predicate, declared)
        hint = f"did you mean `{meant}`?" if meant else f"declared are {listing(declared)}"
        message = f"`{percept.predicate}` is not a percept type"
        self._report.error(self._report.name_of(percept), "ICR013", message, hint)

    def _ground(self, atom: Atom, what: str) -> None:
        for term in (*atom.args, *(value for _, value in atom.attributes)):
            if isinstance(term, Variable):
                message = f"{what} cannot hold the variable {term}"
                self._report.error(term.span, "ICR025", message, "write the object or value itself")

    def _conditions(self, conditions: Iterable[Condition]) -> None:
        for condition in conditions:
            self._pattern(condition.atom)

    def _pattern(self, atom: Atom) -> None:
        """Check predicate, number of arguments and attributes of a pattern over beliefs."""
        self._attributes_once(atom)
        definitions = self._names.predicates.get(atom.predicate, ())
        known = frozenset[str]().union(*(definition.attributes for definition in definitions))
        unknown = [name for name, _ in atom.attributes if name not in known]
        if not self._domain.percepts and (unknown or not definitions):
            self._assume_percept(atom, unknown if definitions else [])
            return
        if not definitions:
            self._unknown_predicate(atom)
            return
        if all(len(atom.args) != definition.arity for definition in definitions):
            self._wrong_arity(atom, definitions[0].arity, _defined_where(definitions[0]))
        for name in unknown:
            self._unknown_attribute(atom, name, known)

    def _assume_percept(self, atom: Atom, undefined: Sequence[str]) -> None:
        """Let a domain without percept declarations, as older ones are, name what it perceives."""
        if atom.predicate in self._assumed:
            return
        self._assumed.add(atom.predicate)
        others = sorted(self._names.predicates.keys() - {atom.predicate})
        meant = closest(atom.predicate, others)
        hint = "declare what is perceived: (percepts (object ^type ^x ^y))"
        if meant:
            hint = f"did you mean `{meant}`? otherwise {hint}"
        message = f"`{atom.predicate}` is taken to be perceived, for nothing defines it"
        if undefined:
            message = (
                f"`{atom.predicate}` is taken to be perceived: no clause has `^{undefined[0]}`"
            )
        self._report.warning(self._report.name_of(atom), "ICR027", message, hint)

    def _unknown_predicate(self, atom: Atom) -> None:
        known = self._names.predicates
        meant = closest(atom.predicate, sorted(known))
        hint = "define it in (concepts …), declare it in (percepts …), or assert it by an effect"
        if atom.predicate in self._names.skills:
            hint = "it is a skill; conditions speak of its effects"
        elif atom.predicate in self._functions:
            hint = "it is a function: move it to :tests"
        elif meant:
            hint = f"did you mean `{meant}`?"
        message = f"nothing is ever known about `{atom.predicate}`"
        label = "neither perceived, derived nor asserted"
        self._report.error(self._report.name_of(atom), "ICR013", message, hint, label=label)

    def _unknown_attribute(self, atom: Atom, name: str, known: frozenset[str]) -> None:
        meant = closest(name, sorted(known))
        if meant:
            hint = f"did you mean `^{meant}`?"
        elif known:
            hint = f"its attributes are {listing(f'^{each}' for each in sorted(known))}"
        else:
            hint = "it has no attributes"
        message = f"`{atom.predicate}` has no attribute `^{name}`"
        self._report.error(self._report.attribute_of(atom, name), "ICR015", message, hint)

    def _attributes_once(self, atom: Atom) -> None:
        for name in _repeated([name for name, _ in atom.attributes]):
            message = f"the attribute `^{name}` is given twice"
            self._report.error(atom.span, "ICR011", message, "remove one of them")

    def _no_attributes(self, atom: Atom) -> None:
        for name, _ in atom.attributes:
            message = f"the action `{atom.predicate}` cannot have the attribute `^{name}`"
            hint = "actions have positional arguments only"
            self._report.error(self._report.attribute_of(atom, name), "ICR015", message, hint)

    def _wrong_arity(self, atom: Atom, arity: int, hint: str) -> None:
        takes = f"{arity} argument" if arity == 1 else f"{arity} arguments"
        message = f"`{atom.predicate}` takes {takes}, not {len(atom.args)}"
        self._report.error(atom.span, "ICR014", message, hint)

    def _defined(self, predicate: str, origin: Origin) -> bool:
        definitions = self._names.predicates.get(predicate, ())
        return any(definition.origin is origin for definition in definitions)


def _defined_where(definition: Definition) -> str:
    where = f" in line {definition.span.line}" if definition.span.line else ""
    match definition.origin:
        case Origin.PERCEPT:
            return f"it is a percept{where}: its one argument is the object's name"
        case Origin.CONCEPT:
            return f"it is a concept, first defined{where}"
        case Origin.EFFECT:
            return f"it is first asserted by an effect{where}"
        case Origin.ATTACHMENT:
            return "its arguments are child and parent"


def _repeated(names: Iterable[str]) -> list[str]:
    """Give the names that occur more than once, each one time, in order."""
    seen: dict[str, int] = {}
    for name in names:
        seen[name] = seen.get(name, 0) + 1
    return [name for name, count in seen.items() if count > 1]
