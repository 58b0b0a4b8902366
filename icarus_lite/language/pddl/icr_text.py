"""A syntax tree written out as the text of a domain file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.language.syntax import Atom, ConceptClause, Domain, PerceptType, SkillClause, Task
from icarus_lite.symbols import format_value

_WIDTH = 100


def domain_text(domain: Domain, remarks: Iterable[str] = ()) -> str:
    """Write a domain: its forms in the usual order, one field a line.

    Percepts, concepts, skills and tasks are written, which is all that an import makes.

    Args:
        domain: What to write.
        remarks: Comments at the beginning.
    """
    documentation = f" {_quoted(domain.documentation)}" if domain.documentation else ""
    lines = [f"; {remark}" for remark in remarks]
    lines += ["", f"(domain {format_value(domain.name)}{documentation})"]
    if domain.percepts:
        lines += ["", *_form("percepts", [[_percept(each)] for each in domain.percepts], "")]
    if domain.concepts:
        lines += ["", *_form("concepts", [_concept(each) for each in domain.concepts])]
    if domain.skills:
        lines += ["", *_form("skills", [_skill(each) for each in domain.skills])]
    for task in domain.tasks:
        lines += ["", *_task(task)]
    return "\n".join(lines).lstrip("\n") + "\n"


def _form(keyword: str, entries: Sequence[list[str]], between: str | None = None) -> list[str]:
    lines = [f"({keyword}"]
    for number, entry in enumerate(entries):
        if number and between is None:
            lines.append("")
        lines += [f"  {line}" if line else line for line in entry]
    lines[-1] += ")"
    return lines


def _percept(percept: PerceptType) -> str:
    words = [percept.name]
    if percept.supertype is not None:
        words += [":is", percept.supertype]
    return f"({' '.join([*words, *(f'^{name}' for name in percept.attributes)])})"


def _concept(clause: ConceptClause) -> list[str]:
    fields = [(":elements", clause.elements), (":tests", clause.tests)]
    return _clause(clause.head, [field for field in fields if field[1]])


def _skill(clause: SkillClause) -> list[str]:
    commands = [f"(*{str(command)[1:]}" for command in clause.actions]
    fields: list[tuple[str, Sequence[object]]] = [
        (":elements", clause.elements),
        (":tests", clause.tests),
        (":actions", commands),
        (":effects", clause.effects),
    ]
    return _clause(clause.head, [field for field in fields if field[1]])


def _task(task: Task) -> list[str]:
    title = f" {_quoted(task.title)}" if task.title else ""
    lines = [f"(task {format_value(task.name)}{title}"]
    lines += _field(":init", task.init, "  ")
    lines += _field(":goal", task.goals, "  ")
    lines[-1] += ")"
    return lines


def _clause(head: Atom, fields: Sequence[tuple[str, Sequence[object]]]) -> list[str]:
    lines = [f"({head}"]
    for keyword, values in fields:
        lines += _field(keyword, values, " ")
    lines[-1] += ")"
    return lines


def _field(keyword: str, values: Sequence[object], indent: str) -> list[str]:
    """Write a field: its values side by side, aligned under the first where they need lines."""
    opening = f"{indent}{keyword} ("
    lines = [opening]
    for value in values:
        text = str(value)
        if lines[-1] != opening and len(lines[-1]) + len(text) + 4 > _WIDTH:
            lines.append(" " * len(opening) + text)
        else:
            lines[-1] += text if lines[-1] == opening else f" {text}"
    lines[-1] += ")"
    return lines


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'
