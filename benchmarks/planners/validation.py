"""Is this a plan? Decided on the PDDL text itself, by code that shares nothing with the planner.

Only what the sixty problems use is understood: conjunctions of literals and of (in)equalities;
anything else is an error rather than a guess.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TypeAlias

Expression: TypeAlias = "str | list[Expression]"
Atom: TypeAlias = tuple[str, ...]


def flaw(domain: Path, problem: Path, plan: list[Atom]) -> str:
    """Say what is wrong with a plan; nothing if it leads to the goal.

    Args:
        domain: The PDDL domain.
        problem: The PDDL problem.
        plan: Actions, each with its arguments.
    """
    sections, tasks = read(domain)[2:], read(problem)[2:]
    above = dict(typed(part(sections, ":types")))
    kinds = dict(typed(part(sections, ":constants") + part(tasks, ":objects")))
    schemas = {str(each[1]): fields(each[2:]) for each in sections if each[0] == ":action"}
    state = {tuple(map(str, fact)) for fact in part(tasks, ":init")}
    for number, (name, *arguments) in enumerate(plan, 1):
        place = f"step {number}, ({' '.join((name, *arguments))})"
        if name not in schemas:
            return f"{place}: no such action"
        schema = schemas[name]
        parameters = typed(list(schema[":parameters"]))
        if len(parameters) != len(arguments):
            return f"{place}: takes {len(parameters)} arguments"
        values = {p: a for (p, _), a in zip(parameters, arguments, strict=True)}
        for parameter, kind in parameters:
            if not is_a(above, kinds.get(values[parameter], ""), kind):
                return f"{place}: {values[parameter]} is no {kind}"
        for positive, atom in literals(schema.get(":precondition", []), values):
            holds = atom[1] == atom[2] if atom[0] == "=" else atom in state
            if holds is not positive:
                return f"{place}: {'' if positive else 'not '}{atom} does not hold"
        effects = literals(schema[":effect"], values)
        state -= {atom for positive, atom in effects if not positive}
        state |= {atom for positive, atom in effects if positive}
    for positive, atom in literals(part(tasks, ":goal")[0], {}):
        if (atom in state) is not positive:
            return f"in the end {'' if positive else 'not '}{atom} does not hold"
    return ""


def read(path: Path) -> list[Expression]:
    """Read a PDDL file: nested lists of lower-case words."""
    text = re.sub(r";[^\n]*", "", path.read_text(encoding="utf-8").lower())
    stack: list[list[Expression]] = [[]]
    for word in re.findall(r"[()]|[^\s()]+", text):
        if word == "(":
            stack.append([])
        elif word == ")":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(word)
    [define] = stack[0]
    assert isinstance(define, list)
    return define


def part(sections: list[Expression], name: str) -> list[Expression]:
    """Give what stands in a section; nothing if there is none."""
    return next((list(each[1:]) for each in sections if each[0] == name), [])


def fields(entries: list[Expression]) -> dict[str, Expression]:
    """Give the fields of an action by their keywords."""
    return {str(key): value for key, value in zip(entries[::2], entries[1::2], strict=True)}


def typed(entries: list[Expression]) -> list[tuple[str, str]]:
    """Give names with their types."""
    found: list[tuple[str, str]] = []
    waiting: list[str] = []
    words = iter(map(str, entries))
    for word in words:
        if word == "-":
            kind = next(words)
            found += [(each, kind) for each in waiting]
            waiting = []
        else:
            waiting.append(word)
    return found + [(each, "object") for each in waiting]


def is_a(above: dict[str, str], kind: str, wanted: str) -> bool:
    """Tell whether a type is another, or below it."""
    passed = set()
    while kind and kind != wanted and kind not in passed:
        passed.add(kind)
        kind = above.get(kind, "object")
    return bool(kind) and wanted in (kind, "object")


def literals(formula: Expression, values: dict[str, str]) -> list[tuple[bool, Atom]]:
    """Give the literals of a conjunction, variables replaced, with whether they are positive."""
    if not formula:
        return []
    if formula[0] == "and":
        return [each for item in formula[1:] for each in literals(item, values)]
    if formula[0] == "not":
        [(positive, atom)] = literals(formula[1], values)
        return [(not positive, atom)]
    if not all(isinstance(word, str) for word in formula) or formula[0] in ("or", "imply"):
        raise ValueError(f"{formula} is more than a literal")
    return [(True, tuple(values.get(str(word), str(word)) for word in formula))]
