"""Commands that show a cycle: beliefs, percepts, who moves with whom, goals, plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rich.console import RenderableType
from rich.table import Table
from rich.tree import Tree

from icarus_lite.language.syntax import Constant
from icarus_lite.symbols import Belief, Percept, Value, format_value
from icarus_lite.trace import Instant, matching, pattern_of
from runtime.repl.command import Command, Takes, no_words
from runtime.repl.session import Session
from runtime.repl.showing import decided, line, lines, rows, summary
from runtime.repl.supposing import supposed_instant


def beliefs(session: Session, text: str) -> Iterator[RenderableType]:
    """Show the beliefs, or those that match."""
    instant = supposed_instant(session)
    if session.supposed:
        yield line("(as supposed: " + ", ".join(map(str, session.supposed.edits)) + ")", "yellow")
    if text:
        yield from _matches(text, instant)
        return
    found = [str(belief) for belief in instant.state.beliefs]
    yield lines(found or [f"nothing is believed in cycle {instant.cycle}"])


def _matches(text: str, instant: Instant) -> Iterator[RenderableType]:
    pattern = pattern_of(text)
    found = matching(pattern, instant)
    if not found:
        yield line(f"nothing matches {pattern} in cycle {instant.cycle}; try why-not {pattern}")
        return
    names = [name for name in pattern.variables if not name.startswith("?_")]
    if not names or all(isinstance(term, Constant) for term in pattern.args):
        yield lines(_in_full(fact) for fact, _ in found)
        return
    table = Table(box=None, pad_edge=False, header_style="dim")
    for column in ("", *dict.fromkeys(names)):
        table.add_column(column)
    for fact, bound in found:
        cells = (format_value(bound[name]) for name in dict.fromkeys(names))
        table.add_row(line(str(fact)), *cells)
    yield table


def _in_full(fact: Belief) -> str:
    attributes = "".join(f" ^{name} {format_value(v)}" for name, v in fact.attributes.items())
    return f"{str(fact)[:-1]}{attributes})"


def percepts(session: Session, text: str) -> Iterator[RenderableType]:
    """Show what is perceived."""
    instant = supposed_instant(session)
    wanted = text.split()
    found = [
        percept
        for percept in instant.state.percepts
        if not wanted or percept.name in wanted or percept.type in wanted
    ]
    if not found:
        yield line(f"nothing of the kind is perceived in cycle {instant.cycle}")
    for kind in dict.fromkeys(percept.type for percept in found):
        yield _table(kind, [percept for percept in found if percept.type == kind])


def _table(kind: str, found: list[Percept]) -> Table:
    columns = list(dict.fromkeys(name for percept in found for name in percept.attributes))
    table = Table(box=None, pad_edge=False, header_style="dim", title_justify="left")
    table.add_column(kind)
    for column in columns:
        table.add_column(f"^{column}", justify="right")
    for percept in found:
        cells = (_cell(percept.attributes.get(column)) for column in columns)
        table.add_row(format_value(percept.name), *cells)
    return table


def _cell(value: Value | None) -> str:
    return "" if value is None else format_value(value)


def hierarchy(session: Session, text: str) -> Iterator[RenderableType]:
    """Show who moves with whom, and who of them is seen."""
    no_words(text, "hierarchy")
    instant = supposed_instant(session)
    links = instant.state.hierarchy.links
    if not links:
        yield line(f"nothing is attached to anything in cycle {instant.cycle}")
        return
    children: dict[Value, list[Value]] = {}
    for child, link in links.items():
        children.setdefault(link.parent, []).append(child)
    seen = _seen(session.record, instant)
    for root in [parent for parent in children if parent not in links]:
        tree = Tree(line(f"{format_value(root)}  {seen.get(str(root), '')}"))
        _grow(tree, root, children, instant, seen)
        yield tree


def _grow(
    tree: Tree,
    parent: Value,
    children: Mapping[Value, list[Value]],
    instant: Instant,
    seen: Mapping[str, str],
) -> None:
    for child in children.get(parent, ()):
        link = instant.state.hierarchy.links[child]
        since = f"by {link.action} in cycle {link.cycle}"
        known = seen.get(str(child), "not perceived")
        branch = tree.add(line(f"{format_value(child)}  {known}; {since}"))
        _grow(branch, child, children, instant, seen)


def _seen(record: Mapping[str, object], instant: Instant) -> dict[str, str]:
    """Say how each object is known: by its anchor if that is on record, else by what it says."""
    known = {}
    for percept in instant.state.percepts:
        attributes = percept.attributes
        hidden = attributes.get("seen") == "no"
        known[percept.name] = "not seen, kept" if hidden else "perceived"
    for row in rows(record, "anchors"):
        status = str(row.get("status"))
        known[str(row.get("name"))] = "seen" if status == "visible" else f"kept, {status}"
    return known


def goal(session: Session, text: str) -> Iterator[RenderableType]:
    """Show the goals and intentions, and which are achieved."""
    no_words(text, "goal")
    record = session.record
    found = [
        f"{'achieved' if row['satisfied'] else 'open':<9} {row['goal']}"
        + "".join(f"  {key}: {row[key]}" for key in ("status", "reason") if row.get(key))
        for row in rows(record, "goals")
    ]
    found += [
        f"{'done' if row['done'] else 'open':<9} {row['skill']}  (to be carried out)"
        for row in rows(record, "intentions")
    ]
    yield lines(found or ["the agent has no goal"])


def plan(session: Session, text: str) -> Iterator[RenderableType]:
    """Show the plan of the cycle."""
    no_words(text, "plan")
    steps = session.record.get("path")
    if not isinstance(steps, list) or not steps:
        yield line(f"there is no plan in cycle {session.cycle}: {decided(session.record)}")
        return
    yield lines(f"{number:>3}  {step}" for number, step in enumerate(steps, 1))


def path(session: Session, text: str) -> Iterator[RenderableType]:
    """Show what the present step is for, level by level."""
    no_words(text, "path")
    found = session.record.get("skills")
    if not isinstance(found, dict):
        yield line(f"nothing is being done in cycle {session.cycle}: {decided(session.record)}")
        return
    told = [f"for {' '.join(map(str, found.get('aims', ())))}"]
    for depth, level in enumerate(found.get("levels", ()), 1):
        bound = ", ".join(f"{k} = {format_value(v)}" for k, v in level["bindings"].items())
        told.append(f"{'  ' * depth}{level['skill']}  line {level['line']}, {bound}")
    yield lines(told)


def candidates(session: Session, text: str) -> Iterator[RenderableType]:
    """Show which skills were considered, and why the others were not chosen."""
    no_words(text, "candidates")
    found = rows(session.record, "candidates")
    told = [
        f"{'*' if row['chosen'] else ' '} {row['skill']}"
        + (f"  {row['why_not']}" if row["why_not"] else "")
        for row in found
    ]
    failures = [f"  {row['reason']}: {row['text']}" for row in rows(session.record, "failures")]
    if not told:
        told = [f"no choice was made in cycle {session.cycle}: {decided(session.record)}"]
    yield lines([*told, *failures])


def show(session: Session, text: str) -> Iterator[RenderableType]:
    """Tell the cycle in a few lines."""
    no_words(text, "show")
    yield summary(session.record)


LOOKING = (
    Command(
        "beliefs",
        "[PATTERN]",
        "Show all beliefs, or what matches a pattern, with its bindings.",
        "beliefs (attached ?part case)",
        beliefs,
        Takes.PATTERN,
        ("b",),
    ),
    Command(
        "percepts", "[NAME …]", "Show what is perceived.", "percepts plug", percepts, Takes.OBJECT
    ),
    Command(
        "hierarchy",
        "",
        "Show who moves with whom, who is seen and who is kept.",
        "hierarchy",
        hierarchy,
        aliases=("h",),
    ),
    Command(
        "goal", "", "Show the goals, and which are achieved.", "goal", goal, aliases=("goals",)
    ),
    Command("plan", "", "Show the steps of the plan, the present one first.", "plan", plan),
    Command("path", "", "Show what the present step is for, from goal to skill.", "path", path),
    Command(
        "candidates",
        "",
        "Show the skills that were considered, and why the others were not chosen.",
        "candidates",
        candidates,
    ),
    Command("show", "", "Tell the cycle: reports, changes, decision.", "show", show),
)
