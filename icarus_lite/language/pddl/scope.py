"""The names that a PDDL text may use, and the typed lists that declare them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.language.checking.report import Report
from icarus_lite.language.pddl.nodes import Group, Node, Word
from icarus_lite.language.pddl.syntax import OBJECT, Predicate, Typed, ancestors, is_a
from icarus_lite.language.syntax import Span
from icarus_lite.language.wording import closest, listing
from icarus_lite.records import dataclass, field, replace

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


class RefusedError(Exception):
    """A part of the text cannot be read. It is in the report, and never leaves the reader."""


@dataclass(frozen=True, slots=True)
class Scope:
    """What is declared so far, and where findings go.

    Args:
        report: Where findings go.
        types: Each type with the one above it; `object` left out.
        objects: Constants and objects, each with its type.
        predicates: Declared predicates by name.
        derived: The predicates that rules define.
        variables: The variables that may be used here, each with its type.
    """

    report: Report
    types: dict[str, str] = field(default_factory=dict)
    objects: dict[str, str] = field(default_factory=dict)
    predicates: dict[str, Predicate] = field(default_factory=dict)
    derived: set[str] = field(default_factory=set)
    variables: dict[str, str] = field(default_factory=dict)

    def within(self, bound: Iterable[Typed]) -> Scope:
        """Give the scope inside a quantifier or an action that binds variables."""
        inner = {variable.name: variable.type for variable in bound}
        return replace(self, variables={**self.variables, **inner})

    def refuse(self, span: Span, code: str, message: str, hint: str = "") -> NoReturn:
        """Report an error and give the part up."""
        self.report.error(span, code, message, hint)
        raise RefusedError

    def predicate(self, word: Word, count: int, span: Span) -> Predicate:
        """Give the predicate of that name, which must take that many arguments."""
        predicate = self.predicates.get(word.text)
        if predicate is None:
            meant = closest(word.text, sorted(self.predicates))
            hint = f"did you mean `{meant}`?" if meant else "declare it in (:predicates …)"
            self.refuse(word.span, "PDDL008", f"no predicate is called `{word}`", hint)
        wanted = len(predicate.parameters)
        if wanted != count:
            takes = f"{wanted} argument" if wanted == 1 else f"{wanted} arguments"
            self.refuse(span, "PDDL009", f"`{word}` takes {takes}, not {count}")
        return predicate

    def term(self, node: Node) -> tuple[str, str]:
        """Give a variable, constant or object with its type."""
        if isinstance(node, Group):
            message = f"`({node.head} …)` stands where a variable or an object is expected"
            hint = "numbers and functions that give objects have no counterpart here"
            self.refuse(node.span, "PDDL007", message, hint)
        known = self.variables if node.text.startswith("?") else self.objects
        kind = known.get(node.text)
        if kind is None:
            what = "variable" if node.text.startswith("?") else "object"
            meant = closest(node.text, sorted(known))
            hint = f"did you mean `{meant}`?" if meant else f"declare the {what}"
            self.refuse(node.span, "PDDL008", f"there is no {what} `{node}` here", hint)
        return node.text, kind

    def known_type(self, word: Word) -> str:
        """Give the name of a declared type."""
        if word.text != OBJECT and word.text not in self.types:
            meant = closest(word.text, sorted(self.types))
            hint = f"did you mean `{meant}`?" if meant else "declare it in (:types …)"
            self.refuse(word.span, "PDDL008", f"no type is called `{word}`", hint)
        return word.text

    def is_a(self, name: str, other: str) -> bool:
        """Tell whether every object of a type is also of the other type."""
        return is_a(self.types, name, other)


def typed_list(
    nodes: Sequence[Node], scope: Scope, *, variables: bool, widened: bool = False
) -> tuple[Typed, ...]:
    """Read `a b - t c - u d`: names or variables with their types.

    Args:
        nodes: The list's entries.
        scope: Knows the types.
        variables: Whether variables are declared, rather than objects.
        widened: Whether `(either t u)` may stand for the nearest type above both, as it may where
            a predicate is declared: what its facts can be about decides on nothing.
    """
    found = [
        Typed(word.text, OBJECT if kind is None else scope.known_type(kind), word.span)
        for word, kind in pairs(_widened(nodes, scope) if widened else nodes, scope)
    ]
    seen: set[str] = set()
    for each in found:
        if each.name.startswith("?") is not variables:
            wanted = "a variable such as ?x" if variables else "a name, not a variable"
            scope.refuse(each.span, "PDDL006", f"expected {wanted}, but found `{each.name}`")
        if each.name in seen:
            scope.refuse(each.span, "PDDL011", f"`{each.name}` is declared twice")
        seen.add(each.name)
    return tuple(found)


def _widened(nodes: Sequence[Node], scope: Scope) -> list[Node]:
    """Put the nearest type above all alternatives in the place of each `(either t u)`."""
    found: list[Node] = []
    for node in nodes:
        words = list(node.items[1:]) if isinstance(node, Group) else []
        kinds = [scope.known_type(item) for item in words if isinstance(item, Word)]
        if isinstance(node, Group) and node.head == "either" and len(kinds) == len(words) > 0:
            above = ancestors(scope.types, kinds[0])
            kind = next(each for each in above if all(scope.is_a(k, each) for k in kinds))
            found.append(Word(kind, node.span))
        else:
            found.append(node)
    return found


def pairs(nodes: Sequence[Node], scope: Scope) -> list[tuple[Word, Word | None]]:
    """Split a typed list into names, each with the name of its type or None."""
    found: list[tuple[Word, Word | None]] = []
    waiting: list[Word] = []
    entries = iter(nodes)
    for node in entries:
        if isinstance(node, Group):
            message = f"`({node.head} …)` stands where a name is expected"
            scope.refuse(node.span, "PDDL006", message)
        if node.text != "-":
            waiting.append(node)
            continue
        kind = next(entries, None)
        if isinstance(kind, Group) and kind.head == "either":
            names = [str(item) for item in kind.items[1:] if isinstance(item, Word)]
            message = f"`(either {' '.join(names)})`: a thing has one type here"
            hint = f"declare a type above {listing(names)} and write that one"
            scope.refuse(kind.span, "PDDL007", message, hint)
        if not isinstance(kind, Word) or not waiting:
            message = "a `-` stands between names and their type: a b - block"
            scope.refuse(node.span, "PDDL006", message)
        found += [(word, kind) for word in waiting]
        waiting = []
    return found + [(word, None) for word in waiting]
