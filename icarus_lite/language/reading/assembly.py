"""Parts into a `Domain`: fields in any order, older names included, each thing stated once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import PurePath
from typing import TypeVar

from icarus_lite.language.breakpoint import Breakpoint
from icarus_lite.language.checking.report import Report
from icarus_lite.language.diagnostics import Diagnostic
from icarus_lite.language.older_names import MODERN_FIELDS, MODERN_FORMS
from icarus_lite.language.reading.breakpoints import breakpoints_of_clause, timed
from icarus_lite.language.reading.parts import Clause, Command, Field, Form, Group, Problem, Word
from icarus_lite.language.reading.values import choice, cost, cycles, priority, seconds
from icarus_lite.language.syntax import (
    Atom,
    AttachmentRule,
    Bind,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Contradiction,
    Domain,
    DomainTest,
    LaterCycle,
    LongTermGoal,
    PerceptType,
    SkillClause,
    Source,
    Task,
    Term,
    Variable,
)
from icarus_lite.records import dataclass, field

_Value = TypeVar("_Value", Atom, Bind, Call, Command, Condition, Constant, Group, Word)


def assemble(forms: Iterable[Form], source: Source) -> tuple[Domain, tuple[Diagnostic, ...]]:
    """Make a domain of its forms, in the order of the text.

    Returns:
        The domain and what there is to say about its shape: fields or forms stated twice or
        missing, older spellings. With an error among them the domain is not to be used.
    """
    draft = _Draft(Report(source))
    for form in forms:
        draft.add(form)
    return draft.domain(), tuple(draft.report.diagnostics)


@dataclass(slots=True)
class _Draft:
    """A domain in the making."""

    report: Report
    name: Word | None = None
    documentation: str = ""
    percepts: list[PerceptType] = field(default_factory=list)
    concepts: list[ConceptClause] = field(default_factory=list)
    skills: list[SkillClause] = field(default_factory=list)
    attachments: list[AttachmentRule] = field(default_factory=list)
    contradictions: list[Contradiction] = field(default_factory=list)
    tasks: list[Task] = field(default_factory=list)
    goals: list[Condition] = field(default_factory=list)
    tests: list[DomainTest] = field(default_factory=list)
    long_term_goals: list[LongTermGoal] = field(default_factory=list)
    breakpoints: list[Breakpoint] = field(default_factory=list)
    agents: list[Word] = field(default_factory=list)

    def add(self, form: Form) -> None:
        """Take in one top-level form."""
        modern = MODERN_FORMS.get(form.keyword.text)
        if modern:
            self._note_older(form.keyword, modern)
        match modern or form.keyword.text:
            case "domain":
                self._add_domain(form)
            case "percepts":
                self.percepts += [item for item in form.items if isinstance(item, PerceptType)]
            case "concepts":
                self.concepts += [self._concept(clause) for clause in _clauses(form)]
            case "skills":
                self.skills += [self._skill(clause) for clause in _clauses(form)]
            case "attachments":
                rules = [self._attachment(clause) for clause in _clauses(form)]
                self.attachments += [rule for rule in rules if rule is not None]
            case "task":
                self.tasks.append(self._task(form))
            case "goals":
                self.goals += [item for item in form.items if isinstance(item, Condition)]
            case _:
                self._add_rarer(form)

    def _add_rarer(self, form: Form) -> None:
        match form.keyword.text:
            case "contradictions":
                self.contradictions += [self._contradiction(clause) for clause in _clauses(form)]
            case "long-term-goal":
                self.long_term_goals.append(self._long_term_goal(form))
            case "agents":
                self._add_agents(form)
            case "break":
                self._add_breakpoints(form)
            case "create-problems":
                self._add_problems(form)
            case _:
                self.tests.append(self._test(form))

    def domain(self) -> Domain:
        """Give the domain as it stands."""
        skills = {skill.head.predicate for skill in self.skills}
        return Domain(
            name=self.name.text if self.name else _name_from(self.report.source.path),
            documentation=self.documentation,
            percepts=tuple(self.percepts),
            concepts=tuple(self.concepts),
            skills=tuple(self.skills),
            attachments=tuple(self.attachments),
            tasks=tuple(self.tasks),
            goals=tuple(self.goals),
            tests=tuple(self.tests),
            long_term_goals=tuple(self.long_term_goals),
            breakpoints=tuple([timed(each, skills) for each in self.breakpoints]),
            agents=tuple([agent.text for agent in self.agents]),
            contradictions=tuple(self.contradictions),
            source=self.report.source,
        )

    def _add_domain(self, form: Form) -> None:
        if self.name is not None:
            first = self.name.span
            self.report.error(
                form.keyword.span,
                "ICR011",
                "the domain is named a second time",
                f"it is called `{self.name.text}` at {first.place}; remove one",
            )
            return
        self.name = form.words[0]
        self.documentation = form.words[1].text if len(form.words) > 1 else ""

    def _concept(self, clause: Clause) -> ConceptClause:
        fields = self._fields(clause.fields)
        self._add_moments("concepts", clause, fields)
        return ConceptClause(
            head=clause.head,
            elements=_values(fields, ":elements", Condition),
            tests=_values(fields, ":tests", Call),
            binds=_values(fields, ":binds", Bind),
            span=clause.span,
        )

    def _skill(self, clause: Clause) -> SkillClause:
        fields = self._fields(clause.fields)
        commands = _values(fields, ":actions", Command)
        for command in commands:
            if not command.starred:
                name = command.atom.predicate
                self.report.error(
                    command.atom.span,
                    "ICR026",
                    f"the driver command `{name}` is written without its star",
                    f"write (*{name} …); skills are called in :subskills",
                )
        self._add_moments("skills", clause, fields)
        return SkillClause(
            head=clause.head,
            elements=_values(fields, ":elements", Condition),
            tests=_values(fields, ":tests", Call),
            holds=_values(fields, ":while", Condition),
            actions=tuple(command.atom for command in commands),
            subskills=_values(fields, ":subskills", Atom),
            effects=_values(fields, ":effects", Condition),
            timeout_s=seconds(_values(fields, ":timeout", Constant), self.report),
            span=clause.span,
            agent=_term(fields, ":agent"),
            request=next(iter(_values(fields, ":request", Constant)), None),
            is_asked=self._choice(fields, ":request", default=True),
            cost=cost(_values(fields, ":cost", Constant), self.report),
        )

    def _attachment(self, clause: Clause) -> AttachmentRule | None:
        fields = self._fields(clause.fields)
        until = _values(fields, ":until", Atom)
        child, parent = _term(fields, ":child"), _term(fields, ":parent")
        if child is None or parent is None:
            missing = ":child" if child is None else ":parent"
            self.report.error(
                clause.head.span,
                "ICR011",
                f"the attachment by `{clause.head.predicate}` has no `{missing}`",
                "say which argument moves with which: :child ?obj :parent ?hand",
            )
            return None
        return AttachmentRule(clause.head, until[0] if until else None, child, parent, clause.span)

    def _contradiction(self, clause: Clause) -> Contradiction:
        fields = self._fields(clause.fields, older=False)
        elements = _values(fields, ":elements", Condition)
        tests = _values(fields, ":tests", Call)
        if not elements and not tests:
            self.report.error(
                clause.head.span,
                "ICR011",
                f"the contradiction of `{clause.head.predicate}` has no conditions",
                "say what it cannot go together with: :elements ((apart ?obj ?into))",
            )
        return Contradiction(
            head=clause.head,
            elements=elements,
            tests=tests,
            cycles=cycles(_values(fields, ":cycles", Constant), self.report),
            span=clause.span,
        )

    def _task(self, form: Form) -> Task:
        fields = self._fields(_form_fields(form))
        robot = _values(fields, ":robot", Word)
        agents = _values(fields, ":agents", Word)
        return Task(
            name=form.words[0].text,
            title=form.words[1].text if len(form.words) > 1 else "",
            robot=robot[0].text if robot else None,
            goals=_values(fields, ":goal", Condition),
            init=_values(fields, ":init", Atom),
            agents=tuple([agent.text for agent in agents]),
            span=form.span,
        )

    def _long_term_goal(self, form: Form) -> LongTermGoal:
        fields = self._fields(_form_fields(form))
        name, goals = form.words[0], _values(fields, ":goal", Condition)
        if not goals:
            message = f"the long-term goal `{name.text}` has no `:goal`"
            hint = "say what is to hold: :goal ((attached hubcover case))"
            self.report.error(name.span, "ICR011", message, hint)
        return LongTermGoal(
            name.text,
            goals,
            relevance=_values(fields, ":relevance", Condition),
            priority=priority(_term(fields, ":priority")),
            maintain=self._choice(fields, ":maintain", default=False),
            span=form.span,
        )

    def _choice(
        self, fields: Mapping[str, Iterable[object]], keyword: str, *, default: bool
    ) -> bool:
        return choice(keyword, _values(fields, keyword, Word), self.report, default=default)

    def _add_agents(self, form: Form) -> None:
        for word in form.words:
            first = next((each for each in self.agents if each.text == word.text), None)
            if first is None:
                self.agents.append(word)
                continue
            message = f"the agent `{word.text}` is named twice"
            hint = f"it stands at {first.span.place} already; name each agent once"
            self.report.error(word.span, "ICR011", message, hint)

    def _add_breakpoints(self, form: Form) -> None:
        conditions = [item for item in form.items if isinstance(item, Condition)]
        if not conditions:
            message = "a break form names no belief to stop at"
            hint = "name one: (break (attached ?obj case))"
            self.report.error(form.keyword.span, "ICR011", message, hint)
            return
        self.breakpoints += [Breakpoint(each, span=each.span) for each in conditions]

    def _add_moments(
        self, form: str, clause: Clause, fields: Mapping[str, Iterable[object]]
    ) -> None:
        words = _values(fields, ":break", Word)
        self.breakpoints += breakpoints_of_clause(form, clause, words, self.report)

    def _add_problems(self, form: Form) -> None:
        problems = [item for item in form.items if isinstance(item, Problem)]
        before = len(self.tasks)
        for number, problem in enumerate(problems, start=1):
            task = Task(f"problem-{number}", "", None, problem.conditions, span=problem.span)
            self.tasks.append(task)
        named = ", ".join(task.name for task in self.tasks[before:][:3])
        more = "…" if len(problems) > 3 else ""
        message = "`create-problems` is an older form"
        hint = (
            f"its problems are taken as tasks {named}{more}; write (task NAME :goal (…)) for each"
        )
        self.report.note(form.keyword.span, "ICR028", message, hint)

    def _test(self, form: Form) -> DomainTest:
        fields = self._fields(_form_fields(form), older=False)
        goals = _values(fields, ":goal", Condition)
        if ":plan" in fields and not goals:
            self.report.error(
                form.words[0].span,
                "ICR011",
                f"the test `{form.words[0].text}` has a `:plan` but no `:goal`",
                "say what the plan is for: :goal ((attached hubcover case))",
            )
        return DomainTest(
            name=form.words[0].text,
            init=_values(fields, ":init", Atom),
            percepts=_values(fields, ":percepts", Atom),
            actions=_values(fields, ":action", Atom),
            expect=_values(fields, ":expect", Atom),
            expect_not=_values(fields, ":expect-not", Atom),
            then=tuple([self._later(group) for group in _values(fields, ":then", Group)]),
            goals=goals,
            plan=_values(fields, ":plan", Atom) if ":plan" in fields else None,
            span=form.span,
        )

    def _later(self, group: Group) -> LaterCycle:
        fields = self._fields(group.fields, older=False)
        return LaterCycle(
            percepts=_values(fields, ":percepts", Atom) if ":percepts" in fields else None,
            actions=_values(fields, ":action", Atom),
            expect=_values(fields, ":expect", Atom),
            expect_not=_values(fields, ":expect-not", Atom),
            span=group.span,
        )

    def _fields(self, fields: Iterable[Field], *, older: bool = True) -> dict[str, list[object]]:
        """Collect the fields' values by modern name; older ones are merged in, in order."""
        collected: dict[str, list[object]] = {}
        seen: dict[str, Word] = {}
        for entry in fields:
            keyword = entry.keyword
            modern = MODERN_FIELDS.get(keyword.text) if older else None
            if keyword.text in seen:
                first = seen[keyword.text].span
                self.report.error(
                    keyword.span,
                    "ICR011",
                    f"`{keyword.text}` is given twice",
                    f"it stands at {first.place} already; put both lists into one",
                )
                continue
            seen[keyword.text] = keyword
            values: list[object] = list(entry.values)
            if modern:
                self._note_older(keyword, modern)
            if modern and keyword.text == ":percepts":
                values = [_marked(value) for value in values]
            collected.setdefault(modern or keyword.text, []).extend(values)
        return collected

    def _note_older(self, word: Word, modern: str) -> None:
        message = f"`{word.text}` is an older name of `{modern}`"
        hint = f"write `{modern}`; it means the same"
        if word.text == ":action":
            hint = "write `:actions`, with a further pair of parentheses; it means the same"
        self.report.note(word.span, "ICR028", message, hint)


def _clauses(form: Form) -> list[Clause]:
    return [item for item in form.items if isinstance(item, Clause)]


def _form_fields(form: Form) -> list[Field]:
    return [item for item in form.items if isinstance(item, Field)]


def _values(
    fields: Mapping[str, Iterable[object]], keyword: str, kind: type[_Value]
) -> tuple[_Value, ...]:
    return tuple([value for value in fields.get(keyword, ()) if isinstance(value, kind)])


def _term(fields: Mapping[str, Iterable[object]], keyword: str) -> Term | None:
    for value in fields.get(keyword, ()):
        if isinstance(value, Variable | Constant):
            return value
    return None


def _marked(value: object) -> object:
    """Read the older `(block ?b xpos ?x)` as `(block ?b ^xpos ?x)`."""
    if not isinstance(value, Condition) or value.atom.attributes:
        return value
    atom = value.atom
    names, values = atom.args[1::2], atom.args[2::2]
    keys = [n.value for n in names if isinstance(n, Constant) and isinstance(n.value, str)]
    if not names or len(keys) != len(values) or len(names) != len(values):
        return value
    pairs = tuple(zip(keys, values, strict=True))
    return Condition(
        Atom(atom.predicate, atom.args[:1], pairs, atom.span), value.negated, value.span
    )


def _name_from(path: str) -> str:
    """Name a domain without a (domain …) form after its file."""
    return "unnamed" if path.startswith("<") else PurePath(path).stem or "unnamed"
