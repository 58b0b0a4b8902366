"""The syntax tree of a domain: what the text says, with the place of every word.

Spans never take part in comparison, so two trees are equal when they mean the same.
"""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Value, format_value

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.language.breakpoint import Breakpoint


@dataclass(frozen=True, slots=True)
class Source:
    """The text a tree was read from.

    Args:
        path: The file, as shown in messages.
        text: Its text.
        included: The files it includes, directly or through others, in the order of the text.
    """

    path: str
    text: str
    included: tuple[Source, ...] = ()

    def text_of(self, path: str) -> str:
        """Give the text of this file, or of the included file with that path."""
        for source in self.included:
            if source.path == path:
                return source.text
        return self.text


@dataclass(frozen=True, slots=True)
class Span:
    """A stretch of source text; lines and columns count from 1, the end column is exclusive.

    `path` names the file where that is an included one; it is empty for the domain's own file.
    """

    line: int
    column: int
    end_line: int
    end_column: int
    path: str = field(default="", compare=False)

    @property
    def place(self) -> str:
        """Where it begins: `3:14`, or `parts.icr:3:14` in an included file."""
        place = f"{self.line}:{self.column}"
        return f"{self.path}:{place}" if self.path else place

    @property
    def in_line(self) -> str:
        """The line in which it begins: `line 3`, or `line 3 of parts.icr` in an included file."""
        return f"line {self.line} of {self.path}" if self.path else f"line {self.line}"


NOWHERE = Span(0, 0, 0, 0)


@dataclass(frozen=True, slots=True)
class Variable:
    """A variable, its name written with the question mark: `?obj`."""

    name: str
    span: Span = field(default=NOWHERE, compare=False)

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, slots=True)
class Constant:
    """A symbol, string or number."""

    value: Value
    span: Span = field(default=NOWHERE, compare=False)

    def __str__(self) -> str:
        return format_value(self.value)


Term = Variable | Constant


@dataclass(frozen=True, slots=True)
class Atom:
    """A pattern `(predicate arg … ^attribute value …)`, for percepts, beliefs and actions.

    An action's predicate is written without its leading star.
    """

    predicate: str
    args: tuple[Term, ...] = ()
    attributes: tuple[tuple[str, Term], ...] = ()
    span: Span = field(default=NOWHERE, compare=False)

    def __str__(self) -> str:
        words = [self.predicate, *map(str, self.args)]
        words += [f"^{name} {value}" for name, value in self.attributes]
        return f"({' '.join(words)})"

    @property
    def variables(self) -> tuple[str, ...]:
        """The names of its variables in order of occurrence, repeats included."""
        terms = (*self.args, *(value for _, value in self.attributes))
        return tuple(term.name for term in terms if isinstance(term, Variable))


@dataclass(frozen=True, slots=True)
class Condition:
    """A literal of `:elements`, `:effects` or a goal: an atom or its negation."""

    atom: Atom
    negated: bool = False
    span: Span = field(default=NOWHERE, compare=False)

    def __str__(self) -> str:
        return f"(not {self.atom})" if self.negated else str(self.atom)


@dataclass(frozen=True, slots=True)
class Call:
    """An expression `(function argument …)` of `:tests` or `:binds`."""

    function: str
    args: tuple[Expression, ...]
    span: Span = field(default=NOWHERE, compare=False)

    def __str__(self) -> str:
        return f"({' '.join([self.function, *map(str, self.args)])})"


Expression = Variable | Constant | Call


@dataclass(frozen=True, slots=True)
class Bind:
    """One `(?v expression)` of `:binds`."""

    variable: Variable
    expression: Expression


@dataclass(frozen=True, slots=True)
class PerceptType:
    """A declared percept type and its attribute names, without markers.

    A subtype, `(part :is object ^grip)`, has the attributes of its supertype besides its own, and
    its percepts match the patterns of the supertype.
    """

    name: str
    attributes: tuple[str, ...]
    supertype: str | None = None
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class ConceptClause:
    """One way for a concept to be true. Clauses with one head name are alternatives."""

    head: Atom
    elements: tuple[Condition, ...] = ()
    tests: tuple[Call, ...] = ()
    binds: tuple[Bind, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class SkillClause:
    """One way to carry a skill out: primitive with `actions`, a macro with `subskills`.

    A skill of another agent is primitive as well: that agent knows how to carry it out, and needs
    no commands of ours.

    Args:
        head: The skill's name and arguments.
        elements: Start conditions (`:elements`).
        tests: Numeric start conditions (`:tests`).
        holds: Conditions that must keep holding while it runs (`:while`).
        actions: Commands for the driver, their names without the star.
        subskills: Skill calls, in order.
        effects: What will be believed once it has succeeded.
        timeout_s: Seconds after which it counts as failed, or None.
        agent: Whose skill it is (`:agent`), a name or a variable of the head; None for whoever
            runs the domain.
        request: What that agent is told when it is to do it, variables to be filled in
            (`:request "please hold ?base"`), a string; None where nothing is stated.
        is_asked: False where that agent does it unasked (`:request no`).
        cost: What it counts for in a plan (`:cost`); None where nothing is stated.
    """

    head: Atom
    elements: tuple[Condition, ...] = ()
    tests: tuple[Call, ...] = ()
    holds: tuple[Condition, ...] = ()
    actions: tuple[Atom, ...] = ()
    subskills: tuple[Atom, ...] = ()
    effects: tuple[Condition, ...] = ()
    timeout_s: float | None = None
    span: Span = field(default=NOWHERE, compare=False)
    agent: Term | None = None
    request: Constant | None = None
    is_asked: bool = True
    cost: int | None = None

    @property
    def is_primitive(self) -> bool:
        """Whether it is done in one step rather than through subskills."""
        return bool(self.actions) or (self.agent is not None and not self.subskills)


@dataclass(frozen=True, slots=True)
class AttachmentRule:
    """An attach action, the action that undoes it, and who is child and parent (the paper's AD)."""

    attach: Atom
    until: Atom | None
    child: Term
    parent: Term
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Contradiction:
    """What ends a belief that would persist: `((holding ?h ?o) :elements (…) :cycles 3)`.

    Args:
        head: The beliefs that are withdrawn; it binds variables, as a positive element does.
        elements: What must be perceived and believed for that, or with `not` must not.
        tests: Comparisons that must hold besides.
        cycles: For how many cycles in a row, from 1.
    """

    head: Atom
    elements: tuple[Condition, ...] = ()
    tests: tuple[Call, ...] = ()
    cycles: int = 1
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Task:
    """A named goal for a robot: `(task 1.1 "title" :robot ur5 :goal (…))`.

    `agents` are the others who work on it, such as `human`. `init` are ground facts that are
    given at the start (`:init`): percepts, attachments, and what no camera sees.
    """

    name: str
    title: str
    robot: str | None
    goals: tuple[Condition, ...]
    agents: tuple[str, ...] = ()
    init: tuple[Atom, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class LongTermGoal:
    """A goal pursued whenever it is relevant: `(long-term-goal tidy :goal (…) :relevance (…))`.

    Args:
        name: What it is called.
        goals: What is to hold.
        relevance: When it is worth pursuing; always if empty.
        priority: The higher goes first among those that are relevant; a variable takes the value
            that the relevance binds it to.
        maintain: Whether it is kept up once it is reached, as long as it is relevant.
    """

    name: str
    goals: tuple[Condition, ...]
    relevance: tuple[Condition, ...] = ()
    priority: float | Variable = 0.0
    maintain: bool = False
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class LaterCycle:
    """A cycle of a test after its first one, an entry of `:then`.

    Args:
        percepts: What is perceived in it; None where it says nothing, and all is perceived as
            in the cycle before.
        actions: What has succeeded since the cycle before.
        expect: What must be believed in it.
        expect_not: What must not be believed in it.
    """

    percepts: tuple[Atom, ...] | None
    actions: tuple[Atom, ...]
    expect: tuple[Atom, ...]
    expect_not: tuple[Atom, ...]
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class DomainTest:
    """A `(test …)` form: given these percepts and this action, expect these beliefs.

    Args:
        name: What it shows, in words.
        percepts: What is perceived in the first cycle.
        actions: What has succeeded just before it.
        expect: What must be believed in it.
        expect_not: What must not be believed in it.
        then: The cycles that follow, in order.
        goals: A goal for which, after the last cycle, there must be a plan; empty for none.
        plan: The steps of that plan; None where only its existence matters.
        init: What is believed before the first cycle, no percepts among it.
    """

    name: str
    percepts: tuple[Atom, ...]
    actions: tuple[Atom, ...]
    expect: tuple[Atom, ...]
    expect_not: tuple[Atom, ...]
    then: tuple[LaterCycle, ...] = ()
    goals: tuple[Condition, ...] = ()
    plan: tuple[Atom, ...] | None = None
    init: tuple[Atom, ...] = ()
    span: Span = field(default=NOWHERE, compare=False)


@dataclass(frozen=True, slots=True)
class Domain:
    """A whole domain, as the text states it. `agents` are the others who work here."""

    name: str
    documentation: str = ""
    percepts: tuple[PerceptType, ...] = ()
    concepts: tuple[ConceptClause, ...] = ()
    skills: tuple[SkillClause, ...] = ()
    attachments: tuple[AttachmentRule, ...] = ()
    tasks: tuple[Task, ...] = ()
    goals: tuple[Condition, ...] = ()
    tests: tuple[DomainTest, ...] = ()
    long_term_goals: tuple[LongTermGoal, ...] = ()
    breakpoints: tuple[Breakpoint, ...] = ()
    agents: tuple[str, ...] = ()
    contradictions: tuple[Contradiction, ...] = ()
    source: Source = field(default=Source("<text>", ""), compare=False)


def variables_of(expression: Expression) -> Iterator[str]:
    """Give the names of the variables of an expression, repeats included."""
    if isinstance(expression, Variable):
        yield expression.name
    elif isinstance(expression, Call):
        for argument in expression.args:
            yield from variables_of(argument)
