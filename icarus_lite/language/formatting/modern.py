"""Older forms and fields rewritten under their modern names, for `icarus fmt --modernize`.

What `assembly` reads as one thing becomes one thing: fields that mean the same are joined in the
place of the first one, in the order of the text.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from icarus_lite.language.formatting.tree import (
    Comment,
    Group,
    Item,
    Leaf,
    Verbatim,
    begins_with_group,
    fields,
    make_group,
)
from icarus_lite.language.older_names import MODERN_FIELDS, MODERN_FORMS
from icarus_lite.records import replace

_NUMBER = re.compile(r"[+-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+-]?[0-9]+)?")
_PERCEPTS = ":percepts"
_ACTION = ":action"


def modernized(tree: Group) -> Group:
    """Rewrite a file's older forms and fields; what has `; fmt: off` before it stays as it is."""
    items: list[Item] = []
    for item in tree.items:
        word = _word(item.node.items[0]) if isinstance(item.node, Group) and item.node.items else ""
        items += _as_tasks(item) if word == "create-problems" else [_form(item, word)]
    return make_group(items, tree.end)


def _form(item: Item, word: str) -> Item:
    """Rename a form, and the fields of its clauses."""
    form = item.node
    name = MODERN_FORMS.get(word, word)
    if not isinstance(form, Group) or name not in ("concepts", "skills", "goals"):
        return item
    items = [replace(form.items[0], node=Leaf(name)), *map(_clause, form.items[1:])]
    return replace(item, node=make_group(items, form.end))


def _clause(item: Item) -> Item:
    """Rename and join the fields of a clause."""
    clause = item.node
    if not begins_with_group(clause) or not isinstance(clause, Group):
        return item
    head, its_fields = fields(clause.items)
    if not _can_be_joined(its_fields):
        return item
    joined: dict[str, list[Item]] = {}
    for field in its_fields:
        keyword = _word(field[0])
        name = MODERN_FIELDS.get(keyword, keyword)
        modern = _field(field, name)
        joined[name] = _join(joined[name], modern) if name in joined else modern
    items = [*head, *(entry for field in joined.values() for entry in field)]
    return replace(item, node=make_group(items, clause.end))


def _field(field: Sequence[Item], name: str) -> list[Item]:
    """Rename one field, and write its values the way the modern one has them."""
    keyword, *values = field
    if _word(keyword) == _PERCEPTS:
        values = [_with_marked_entries(value) for value in values]
    if _word(keyword) == _ACTION and len(values) == 1:
        command = Item(values[0].node)
        values = [replace(values[0], node=make_group([command]))]
    return [replace(keyword, node=Leaf(name)), *values]


def _join(first: list[Item], second: list[Item]) -> list[Item]:
    """Append the entries of one field to another's, with all the comments around them."""
    if len(first) < 2 or len(second) < 2:
        return [*first, *second]
    into, taken = first[-1].node, second[-1].node
    if not isinstance(into, Group) or not isinstance(taken, Group):
        return [*first, *second]
    keyword, value = second[0], second[-1]
    inside, entries = list(into.items), list(taken.items)
    behind = first[-1].after
    moved = list(into.end)
    if inside and not inside[-1].after and not into.end:
        inside[-1] = replace(inside[-1], after=behind)
    else:
        moved += _own_lines(*behind)
    moved += [*keyword.before, *_own_lines(*keyword.prefix, *keyword.after)]
    moved += [*value.before, *_own_lines(*value.prefix)]
    end = list(taken.end)
    if entries:
        entries[0] = replace(entries[0], before=(*moved, *entries[0].before))
    else:
        end = [*moved, *end]
    joined = make_group([*inside, *entries], end)
    return [*first[:-1], replace(first[-1], node=joined, after=value.after)]


def _own_lines(*comments: str) -> list[Comment]:
    return [Comment(comment, blank_before=False) for comment in comments]


def _can_be_joined(its_fields: Sequence[Sequence[Item]]) -> bool:
    """Tell whether a clause is as expected: nothing twice, nothing frozen, attributes by name."""
    keywords = [_word(field[0]) for field in its_fields]
    return len(set(keywords)) == len(keywords) and all(
        not isinstance(value.node, Verbatim)
        and not (_word(field[0]) == _PERCEPTS and _names_attributes_by_strings(value))
        for field in its_fields
        for value in field
    )


def _with_marked_entries(item: Item) -> Item:
    """Write each older `(block ?b xpos ?x)` of a list as `(block ?b ^xpos ?x)`."""
    group = item.node
    if not isinstance(group, Group):
        return item
    return replace(item, node=make_group([_marked(entry) for entry in group.items], group.end))


def _marked(item: Item) -> Item:
    pattern = item.node
    if not isinstance(pattern, Group):
        return item
    items = list(pattern.items)
    if items and _word(items[0]) == "not":
        items[1:] = map(_marked, items[1:])
    elif _alternates(items):
        names = items[2::2]
        items[2::2] = [replace(name, node=Leaf(f"^{_word(name)}")) for name in names]
    return replace(item, node=make_group(items, pattern.end))


def _alternates(items: Sequence[Item]) -> bool:
    """Tell whether names and values follow the name of an object, as in `(block ?b xpos ?x)`."""
    names = [_word(name) for name in items[2::2]]
    has_markers = any(_word(term).startswith("^") for term in items)
    return bool(names) and len(items) % 2 == 0 and not has_markers and all(map(_may_name, names))


def _may_name(word: str) -> bool:
    return bool(word) and word[0] != "?" and not _NUMBER.fullmatch(word)


def _names_attributes_by_strings(item: Item) -> bool:
    """Tell whether a list of patterns has a string where an attribute's name is expected."""
    if not isinstance(item.node, Group):
        return False
    terms = item.node.items
    return (_alternates(terms) and any(_word(name)[0] == '"' for name in terms[2::2])) or any(
        map(_names_attributes_by_strings, terms)
    )


def _as_tasks(item: Item) -> list[Item]:
    """Write each of the older problems as a task, under the name it is read as."""
    form = item.node
    if not isinstance(form, Group):
        return [item]
    keyword, *problems = form.items
    has_other_items = not all(isinstance(problem.node, Group) for problem in problems)
    if not problems or has_other_items:
        return [item]
    # Comments that would have no place of their own among the tasks keep the form as it is.
    if form.end or keyword != Item(keyword.node) or (item.after and problems[-1].after):
        return [item]
    tasks: list[Item] = []
    for number, problem in enumerate(problems, start=1):
        words = ("task", f"problem-{number}", ":goal")
        goal = [*(Item(Leaf(word)) for word in words), Item(problem.node)]
        tasks.append(replace(problem, node=make_group(goal)))
    tasks[-1] = replace(tasks[-1], after=tasks[-1].after or item.after)
    first = tasks[0]
    before = item.before
    if first.before:
        before += (replace(first.before[0], blank_before=item.blank_before), *first.before[1:])
    blank = first.blank_before if first.before else item.blank_before
    prefix = (*item.prefix, *first.prefix)
    tasks[0] = replace(first, before=before, blank_before=blank, prefix=prefix)
    return tasks


def _word(item: Item) -> str:
    return item.node.text if isinstance(item.node, Leaf) else ""
