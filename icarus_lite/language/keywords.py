"""The words the language itself is made of, each with the sentence that says what it means.

Editors, highlighters and documentation all take their words from here. Which of them may stand
where is the grammar's business; that none is missing here is a test's.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto
from types import MappingProxyType

from icarus_lite.records import dataclass


class Content(Enum):
    """What the entries of a form or field are."""

    TYPES = auto()  # declarations of percept types
    CLAUSES = auto()  # a head with fields
    CONDITIONS = auto()  # patterns over beliefs, possibly inside `not`
    CALLS = auto()  # tests
    BINDS = auto()  # variables with expressions
    COMMANDS = auto()  # commands for the driver
    SKILLS = auto()  # calls or observations of skills
    SUPERTYPE = auto()  # the name of a percept type
    CYCLES = auto()  # lists of fields, each for one cycle
    MOMENTS = auto()  # when a breakpoint stops a run
    AGENTS = auto()  # names of agents
    CHOICE = auto()  # yes or no
    TERMS = auto()  # variables, symbols, strings, numbers


@dataclass(frozen=True, slots=True)
class Keyword:
    """A word of the language.

    Args:
        name: As written, a field with its colon.
        content: What its entries are.
        documentation: What it means, in one sentence or two.
        modern: The name to write instead, if this one is an older spelling.
    """

    name: str
    content: Content
    documentation: str
    modern: str = ""


def _table(*keywords: Keyword) -> Mapping[str, Keyword]:
    return MappingProxyType({keyword.name: keyword for keyword in keywords})


def _older(name: str, modern: Keyword) -> Keyword:
    text = f"An older name of `{modern.name}`. {modern.documentation}"
    return Keyword(name, modern.content, text, modern.name)


def _moment(name: str, documentation: str) -> Keyword:
    return Keyword(name, Content.MOMENTS, documentation)


_CONCEPTS = Keyword(
    "concepts",
    Content.CLAUSES,
    "What can be derived: each clause is one way for its head to be true. Clauses with one head "
    "name are alternatives.",
)
_SKILLS = Keyword(
    "skills",
    Content.CLAUSES,
    "What can be done: each clause is one way to carry its head out, and says when it may start "
    "and what will be believed once it has succeeded.",
)
_GOALS = Keyword("goals", Content.CONDITIONS, "What shall hold whenever no task says otherwise.")

FORMS: Mapping[str, Keyword] = _table(
    Keyword("domain", Content.TERMS, "The domain's name and, in a string, what it is about."),
    Keyword("include", Content.TERMS, "Reads another file as if its forms stood here."),
    Keyword(
        "percepts",
        Content.TYPES,
        "What can be perceived: each type with the attributes that its percepts may have.",
    ),
    _CONCEPTS,
    _SKILLS,
    Keyword(
        "attachments",
        Content.CLAUSES,
        "Which action attaches which object to what, and which action undoes it.",
    ),
    Keyword(
        "contradictions",
        Content.CLAUSES,
        "What ends a belief that would persist: each clause says what its head cannot go together "
        "with for long.",
    ),
    Keyword("agents", Content.AGENTS, "Who else works here, and may be asked to do something."),
    Keyword("task", Content.TERMS, "A named goal, and the robot that is to reach it."),
    _GOALS,
    Keyword(
        "long-term-goal",
        Content.TERMS,
        "A goal to pursue whenever it is relevant, by priority.",
    ),
    Keyword(
        "break",
        Content.CONDITIONS,
        "Where the REPL stops a run: when one of the literals begins to hold, or one of the skills "
        "starts.",
    ),
    Keyword(
        "test",
        Content.TERMS,
        "Percepts and actions, with the beliefs that are expected of them.",
    ),
    _older("create-concepts", _CONCEPTS),
    _older("create-skills", _SKILLS),
    _older("create-goals", _GOALS),
    Keyword("create-problems", Content.CONDITIONS, "An older form of tasks: their goals.", "task"),
)
"""The first words of the top-level forms."""

_ELEMENTS = Keyword(
    ":elements",
    Content.CONDITIONS,
    "The percepts and beliefs that must be there, or with `not` must not. In a skill they are the "
    "conditions under which it may start.",
)
_WHILE = Keyword(
    ":while",
    Content.CONDITIONS,
    "What must keep holding while the skill runs; otherwise it is broken off.",
)
_SUBSKILLS = Keyword(":subskills", Content.SKILLS, "Skills to carry out one after another.")

_ACTIONS = Keyword(":actions", Content.COMMANDS, "The commands that the driver is given, in order.")
_BINDS = Keyword(
    ":binds", Content.BINDS, "Variables that are computed, for attributes of the head."
)

FIELDS: Mapping[str, Keyword] = _table(
    _ELEMENTS,
    Keyword(
        ":tests",
        Content.CALLS,
        "Comparisons of what the elements have bound; all of them must hold.",
    ),
    _BINDS,
    _WHILE,
    _ACTIONS,
    _SUBSKILLS,
    Keyword(
        ":effects",
        Content.CONDITIONS,
        "What is believed once the skill has succeeded, and with `not` no longer.",
    ),
    Keyword(":timeout", Content.TERMS, "The seconds after which the skill counts as failed."),
    Keyword(":agent", Content.AGENTS, "Whose skill it is, if it is another agent's."),
    Keyword(
        ":request",
        Content.CHOICE,
        "What that agent is told when it is to do it; `no` if it needs no word.",
    ),
    Keyword(
        ":cost",
        Content.TERMS,
        "What the skill counts for in a plan: 1 for one's own if nothing is said, 10 for another "
        "agent's.",
    ),
    Keyword(
        ":break",
        Content.MOMENTS,
        "When the REPL stops a run at this concept or skill.",
    ),
    Keyword(":until", Content.SKILLS, "The action that detaches again."),
    Keyword(":child", Content.TERMS, "The argument that moves with its parent while attached."),
    Keyword(":parent", Content.TERMS, "The argument that the child moves with."),
    Keyword(
        ":cycles",
        Content.TERMS,
        "For how many cycles in a row the conditions must hold; 1 if nothing is said.",
    ),
    Keyword(":is", Content.SUPERTYPE, "The percept type of which this one is a special case."),
    Keyword(":robot", Content.TERMS, "The robot that the task is for."),
    Keyword(":agents", Content.AGENTS, "The other agents that take part in the task."),
    Keyword(":goal", Content.CONDITIONS, "What must hold in the end, or with `not` must not."),
    Keyword(":init", Content.CONDITIONS, "What is believed when the task, or the test, begins."),
    Keyword(":relevance", Content.CONDITIONS, "What must hold for the goal to matter."),
    Keyword(":priority", Content.TERMS, "How urgent the goal is; greater comes first."),
    Keyword(
        ":maintain",
        Content.CHOICE,
        "Whether the goal is kept up once it is reached: `yes` or `no`.",
    ),
    Keyword(":percepts", Content.CONDITIONS, "What is perceived, without variables."),
    Keyword(":action", Content.SKILLS, "The actions that have just succeeded, one cycle each."),
    Keyword(":expect", Content.CONDITIONS, "Beliefs that must be there in the end."),
    Keyword(":expect-not", Content.CONDITIONS, "Beliefs that must not be there in the end."),
    Keyword(":then", Content.CYCLES, "Further cycles, each with its own percepts and actions."),
    Keyword(":plan", Content.SKILLS, "The steps that the planner must find from there."),
    _older(":conditions", _ELEMENTS),
    _older(":relations", _ELEMENTS),
    _older(":start", _ELEMENTS),
    _older(":requires", _WHILE),
    _older(":subgoals", _SUBSKILLS),
    _older(":attributes", _BINDS),
)
"""The fields of clauses, tasks and tests."""

IN_CLAUSES: Mapping[str, Keyword] = _table(
    _older(":percepts", _ELEMENTS), _older(":action", _ACTIONS)
)
"""Fields that are older names in the clauses of concepts and skills, and modern elsewhere."""

MOMENTS: Mapping[str, Mapping[str, Keyword]] = MappingProxyType(
    {
        _CONCEPTS.name: _table(
            _moment("on-gain", "When a belief with this head begins to hold."),
            _moment("on-loss", "When a belief with this head ceases to hold."),
        ),
        _SKILLS.name: _table(
            _moment("on-start", "When this skill starts."),
            _moment("on-success", "When this skill has succeeded."),
            _moment("on-failure", "When this skill has failed, or was broken off."),
        ),
    }
)
"""What `:break` may say, by the form of its clause."""

NOT = Keyword(
    "not",
    Content.CONDITIONS,
    "There is none: variables that occur only inside it may have any value. In `:tests` it turns "
    "a comparison round.",
)


def field_named(name: str, form: str) -> Keyword | None:
    """Give the field with a name, as it is meant in a form.

    Args:
        name: As written, with its colon.
        form: The modern name of the form.
    """
    older = IN_CLAUSES.get(name) if form in (_CONCEPTS.name, _SKILLS.name) else None
    return older or FIELDS.get(name)
