"""Where everything in a domain is defined and used, over the files it is made of."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterable, Iterator

from icarus_lite.language.checking.vocabulary import Origin
from icarus_lite.language.editing.occurrences import Occurrence, Role, occurrences
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED

_THINGS = (
    Role.PREDICATE,
    Role.SKILL,
    Role.COMMAND,
    Role.FUNCTION,
    Role.ATTRIBUTE,
    Role.VARIABLE,
    Role.SYMBOL,
    Role.AGENT,
)
_ORIGINS = {"percepts": Origin.PERCEPT, "concepts": Origin.CONCEPT}
_PATTERN = re.compile(r"[^()\";]*")
_DEFINED_HERE = (Role.PREDICATE, Role.SKILL)


@dataclass(frozen=True, slots=True)
class File:
    """A text with what its words stand for.

    Args:
        path: What tells it from other files.
        text: The text.
        words: Its occurrences, in order.
    """

    path: str
    text: str
    words: tuple[Occurrence, ...]

    @classmethod
    def read(cls, path: str, text: str) -> File:
        """Read a text, whatever is wrong with it."""
        return cls(path, text, occurrences(text))


@dataclass(frozen=True, slots=True)
class Thing:
    """What several words of a domain stand for together.

    Args:
        role: What kind of thing it is.
        name: Its name, without marker.
        owner: For an attribute, the predicate that it is declared for.
        path: For a variable, the file of its clause.
        scope: For a variable, the offset of its clause.
    """

    role: Role
    name: str
    owner: str = ""
    path: str = ""
    scope: int = 0


@dataclass(frozen=True, slots=True)
class Located:
    """An occurrence and the file it stands in."""

    path: str
    occurrence: Occurrence


class Index:
    """What the words of a domain stand for, and which of them stand for the same.

    Args:
        files: The files that belong together through `include`.
    """

    def __init__(self, files: Iterable[File]) -> None:
        self._files = {file.path: file for file in files}
        self._supertypes: dict[str, str] = {}
        self._attributes: dict[str, dict[str, None]] = {}
        self._origins: dict[str, dict[Origin, None]] = {}
        self._given: set[str] = set()
        for _, occurrence in self._all():
            self._learn(occurrence)
        self._things: dict[Thing, list[Located]] = {}
        for path, occurrence in self._all():
            thing = self.thing(path, occurrence)
            if thing is not None:
                self._things.setdefault(thing, []).append(Located(path, occurrence))

    def at(self, path: str, offset: int) -> Occurrence | None:
        """Give the word at an offset, or the one that ends there."""
        found = self._files[path].words
        index = bisect_right(found, offset, key=lambda occurrence: occurrence.start)
        for candidate in found[max(index - 2, 0) : index][::-1]:
            if candidate.role is not Role.PARENTHESIS and offset <= candidate.stop:
                return candidate
        return None

    def thing(self, path: str, occurrence: Occurrence) -> Thing | None:
        """Say which thing a word stands for, or None for punctuation, comments and the like."""
        match occurrence.role:
            case Role.VARIABLE:
                scope = occurrence.place.scope
                return Thing(Role.VARIABLE, occurrence.name, path=path, scope=scope)
            case Role.ATTRIBUTE:
                return Thing(Role.ATTRIBUTE, occurrence.name, self._owner(occurrence))
            case role if role in _THINGS:
                return Thing(role, occurrence.name)
        return None

    def occurrences(self, thing: Thing) -> tuple[Located, ...]:
        """Give all words that stand for a thing, in the order of the files and their texts."""
        return tuple(self._things.get(thing, ()))

    def definitions(self, thing: Thing) -> tuple[Located, ...]:
        """Give the words that define a thing; for a variable, its first one."""
        found = self.occurrences(thing)
        if thing.role is Role.VARIABLE:
            return found[:1]
        defining = [located for located in found if located.occurrence.defines]
        # What has clauses or a declaration is defined by them, whatever effects assert besides.
        firm = [located for located in defining if located.occurrence.place.form != "skills"]
        return tuple(firm or defining)

    def head(self, located: Located) -> str:
        """Give the pattern that a name begins, on one line: `(near ?a ?b)`."""
        match = _PATTERN.match(self._files[located.path].text, located.occurrence.start)
        return f"({' '.join(match[0].split())})" if match else f"({located.occurrence.name})"

    def clause(self, located: Located) -> str:
        """Give the text of the clause, percept type, task or test that a word stands in."""
        place = located.occurrence.place
        return self._files[located.path].text[place.scope : place.end]

    def words(self, path: str) -> tuple[Occurrence, ...]:
        """Give the words of a file, in order."""
        return self._files[path].words

    def text(self, path: str) -> str:
        """Give the text of a file."""
        return self._files[path].text

    def names(self, role: Role) -> tuple[str, ...]:
        """Give the names of a role; of predicates and skills only those that are defined.

        A predicate or skill that is only used is probably misspelt, unless a task gives facts of
        it; commands, symbols and functions are defined elsewhere.
        """
        found = {
            thing.name: None
            for thing, located in self._things.items()
            if thing.role is role
            and (
                role not in _DEFINED_HERE
                or any(each.occurrence.defines for each in located)
                or (role is Role.PREDICATE and thing.name in self._given)
            )
        }
        return (*found, ATTACHED) if role is Role.PREDICATE and ATTACHED not in found else (*found,)

    def attributes(self, predicate: str) -> tuple[str, ...]:
        """Give the attributes that patterns with a predicate may have, inherited ones last."""
        found: dict[str, None] = {}
        for name in self._lineage(predicate):
            found.update(self._attributes.get(name, {}))
        return tuple(found)

    def subtypes(self, percept: str) -> tuple[str, ...]:
        """Give the percept types that inherit from one, directly or through others."""
        return tuple(name for name in self._supertypes if percept in self._lineage(name))

    def values(self, attribute: Thing) -> tuple[str, ...]:
        """Give the symbols that an attribute is compared with or given, in order of occurrence."""
        found: dict[str, None] = {}
        for thing, located in self._things.items():
            if thing.role is not Role.SYMBOL:
                continue
            for each in located:
                word = each.occurrence
                if word.attribute == attribute.name and attribute.owner == self._owner(word):
                    found[thing.name] = None
        return tuple(found)

    def variables(self, path: str, scope: int) -> tuple[str, ...]:
        """Give the variables of the clause that begins at an offset."""
        return tuple(
            thing.name
            for thing in self._things
            if thing.role is Role.VARIABLE and (thing.path, thing.scope) == (path, scope)
        )

    def origins(self, predicate: str) -> tuple[Origin, ...]:
        """Say where beliefs with a predicate come from."""
        found = self._origins.get(predicate, {})
        if not found and predicate in self._given:
            found = {Origin.GIVEN: None}
        if predicate != ATTACHED:
            return tuple(found)
        own = (origin for origin in found if origin not in (Origin.EFFECT, Origin.GIVEN))
        return (*own, Origin.ATTACHMENT)

    def _all(self) -> Iterator[tuple[str, Occurrence]]:
        for path, file in self._files.items():
            for occurrence in file.words:
                yield path, occurrence

    def _learn(self, occurrence: Occurrence) -> None:
        place = occurrence.place
        if occurrence.role is Role.ATTRIBUTE and occurrence.defines:
            self._attributes.setdefault(occurrence.owner, {})[occurrence.name] = None
        elif occurrence.role is Role.PREDICATE and occurrence.defines:
            origin = _ORIGINS.get(place.form, Origin.EFFECT)
            self._origins.setdefault(occurrence.name, {})[origin] = None
        elif occurrence.role is Role.PREDICATE and (place.form, place.field) == ("percepts", ":is"):
            self._supertypes[place.clause] = occurrence.name
        elif occurrence.role is Role.PREDICATE and (place.form, place.field) == ("task", ":init"):
            self._given.add(occurrence.name)

    def _lineage(self, predicate: str) -> Iterable[str]:
        lineage: dict[str, None] = {}
        while predicate and predicate not in lineage:
            lineage[predicate] = None
            predicate = self._supertypes.get(predicate, "")
        return lineage

    def _owner(self, occurrence: Occurrence) -> str:
        """Give the predicate for which the attribute, or the attribute of a value, is declared."""
        name = occurrence.attribute or occurrence.name
        declaring = [
            each
            for each in self._lineage(occurrence.owner)
            if name in self._attributes.get(each, {})
        ]
        return declaring[-1] if declaring else occurrence.owner
