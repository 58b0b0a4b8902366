"""What could be written at a place in a domain file."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from types import MappingProxyType

from icarus_lite.language.checking.vocabulary import Origin
from icarus_lite.language.editing.descriptions import kinds_of
from icarus_lite.language.editing.expectations import accepted, keyword_terminals
from icarus_lite.language.editing.index import Index, Thing
from icarus_lite.language.editing.lexemes import Kind, Lexeme, lexemes
from icarus_lite.language.editing.nesting import Group, nest, open_groups
from icarus_lite.language.editing.occurrences import Occurrence, Place, Role, occurrences
from icarus_lite.language.functions import FUNCTIONS, Function
from icarus_lite.language.keywords import FORMS, MOMENTS, NOT, field_named
from icarus_lite.records import dataclass

_CHOICES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {":maintain": ("yes", "no"), ":request": ("no",)}
)


@dataclass(frozen=True, slots=True)
class Proposal:
    """Something that could be written.

    Args:
        text: The word, marker included.
        role: What it would stand for.
        detail: A few words beside it.
        documentation: A sentence about it.
    """

    text: str
    role: Role
    detail: str = ""
    documentation: str = ""


@dataclass(frozen=True, slots=True)
class Completion:
    """What could be written, and the stretch of text that it replaces."""

    start: int
    stop: int
    proposals: tuple[Proposal, ...]


def complete(
    index: Index,
    path: str,
    offset: int,
    *,
    commands: Collection[str] = (),
    functions: Mapping[str, Function] = FUNCTIONS,
) -> Completion:
    """Propose what could be written at an offset of a file.

    Args:
        index: The domain.
        path: The file, which must be in the index.
        offset: The place of the cursor.
        commands: The commands that drivers are known to offer, without the star.
        functions: What tests may call.
    """
    text = index.text(path)
    words = lexemes(text)
    typed = next((word for word in words if word.start < offset <= word.stop), None)
    if typed is not None and _is_prose(typed, offset):
        return Completion(offset, offset, ())
    if typed is None or typed.kind in (Kind.OPEN, Kind.CLOSE, Kind.STRING, Kind.COMMENT):
        start, stop = offset, offset
    else:
        start, stop = typed.start, typed.stop
    before = [word for word in words if word.stop <= start]
    chain = open_groups(nest(text, before))
    if not chain:
        return Completion(start, stop, ())
    moment = _Moment(index, path, text[:start], text[start:offset], chain, commands, functions)
    fitting = [p for p in moment.proposals() if _fits(p.text, text[start:offset])]
    return Completion(start, stop, tuple(fitting))


def _is_prose(word: Lexeme, offset: int) -> bool:
    """Tell whether the offset lies inside a comment or string, where nothing is proposed."""
    if word.kind is Kind.COMMENT:
        return offset < word.stop or word.text.startswith(";")
    return word.text.startswith('"') and (offset < word.stop or word.kind is Kind.ILLEGAL)


def _fits(proposal: str, typed: str) -> bool:
    """Keep to the kind of word whose marker has been typed; the editor does the rest."""
    if typed[:1] in ("?", "^", ":", "*"):
        return proposal.startswith(typed[0])
    return not typed or proposal[0] not in "?^:*"


@dataclass(frozen=True, slots=True)
class _Moment:
    """A text that is being written, up to the word in question."""

    index: Index
    path: str
    before: str
    typed: str
    chain: Sequence[Group]
    commands: Collection[str]
    functions: Mapping[str, Function]

    def proposals(self) -> Iterator[Proposal]:
        """Propose everything that the parser would take here."""
        terminals = accepted(self.chain)
        yield from self._keywords(terminals)
        if "VARIABLE" in terminals:
            yield from self._variables()
        if "HAT" in terminals:
            yield from self._attributes()
        if "STAR" in terminals and "HAT" not in terminals:
            yield from self._commands()
        if "SYMBOL" in terminals:
            yield from self._symbols()

    def _would_be(self, word: str) -> Occurrence:
        """Say what a word would stand for if it were written here."""
        form = self.before[self.chain[0].start :]
        return occurrences(f"{form} {word}")[-1]

    def _keywords(self, terminals: frozenset[str]) -> Iterator[Proposal]:
        texts = [text for name, text in keyword_terminals().items() if name in terminals]
        given = {item.text for item in self.chain[-1].items if isinstance(item, Lexeme)}
        form = self._would_be("x").place.form
        for text in texts:
            keyword = field_named(text, form) if text.startswith(":") else FORMS.get(text)
            if text == NOT.name:
                yield Proposal(text, Role.NOT, "there is none", NOT.documentation)
            elif keyword is None or keyword.modern or text in given:
                continue
            elif text.startswith(":"):
                yield Proposal(text, Role.FIELD, "field", keyword.documentation)
            else:
                yield Proposal(text, Role.FORM, "form", keyword.documentation)

    def _variables(self) -> Iterator[Proposal]:
        scope = self._would_be("?x").place.scope + self.chain[0].start
        for name in self.index.variables(self.path, scope):
            thing = Thing(Role.VARIABLE, name, path=self.path, scope=scope)
            if name != self.typed or len(self.index.occurrences(thing)) > 1:
                yield Proposal(name, Role.VARIABLE, "variable")

    def _attributes(self) -> Iterator[Proposal]:
        owner = self._would_be("^x").owner
        marker = "*" if self.typed.startswith("*") else "^"
        given = {
            item.text[1:]
            for item in self.chain[-1].items
            if isinstance(item, Lexeme) and item.kind in (Kind.HAT, Kind.STAR)
        }
        for name in self.index.attributes(owner):
            if name not in given:
                yield Proposal(f"{marker}{name}", Role.ATTRIBUTE, f"attribute of {owner}")

    def _commands(self) -> Iterator[Proposal]:
        used = self.index.names(Role.COMMAND)
        for name in sorted({*self.commands, *used} - {self.typed.lstrip("*")}):
            offered = "command of the driver" if name in self.commands else "command"
            yield Proposal(f"*{name}", Role.COMMAND, offered)

    def _symbols(self) -> Iterator[Proposal]:
        word = self._would_be("x")
        if word.place.field == ":break" or word.place.field in _CHOICES:
            yield from self._words_for(word.place)
            return
        match word.role:
            case Role.PREDICATE if word.place.form != "percepts" or word.place.field:
                yield from self._predicates(word.place)
            case Role.SKILL:
                yield from self._named(Role.SKILL)
            case Role.AGENT if word.place.form != "agents":
                yield from self._agents()
            case Role.FUNCTION:
                for function in self.functions.values():
                    yield Proposal(
                        function.name, Role.FUNCTION, function.arity, function.documentation
                    )
            case Role.SYMBOL if word.attribute:
                attribute = self.index.thing(self.path, self._attribute_of(word))
                for value in self.index.values(attribute) if attribute else ():
                    if value != self.typed:
                        yield Proposal(value, Role.SYMBOL, f"value of ^{word.attribute}")

    def _agents(self) -> Iterator[Proposal]:
        given = {item.text for item in self.chain[-1].items if isinstance(item, Lexeme)}
        for name in self.index.names(Role.AGENT):
            used = len(self.index.occurrences(Thing(Role.AGENT, name)))
            if name not in given and (name != self.typed or used > 1):
                yield Proposal(name, Role.AGENT, "agent")

    def _words_for(self, place: Place) -> Iterator[Proposal]:
        """Propose the words that a field has of its own."""
        given = {item.text for item in self.chain[-1].items if isinstance(item, Lexeme)}
        for text in _CHOICES.get(place.field, ()):
            yield Proposal(text, Role.SYMBOL)
        for moment in MOMENTS.get(place.form, {}).values() if place.field == ":break" else ():
            if moment.name not in given:
                yield Proposal(moment.name, Role.MOMENT, "moment", moment.documentation)

    def _attribute_of(self, value: Occurrence) -> Occurrence:
        return Occurrence(Role.ATTRIBUTE, value.attribute, 0, 0, value.place, value.owner)

    def _predicates(self, place: Place) -> Iterator[Proposal]:
        wants_percepts = place.field in (":percepts", ":is")
        is_head = place.form == "concepts" and not place.field
        ends = place.form == "contradictions" and not place.field
        for proposal in self._named(Role.PREDICATE):
            origins = self.index.origins(proposal.text)
            if wants_percepts and (Origin.PERCEPT not in origins or proposal.text == place.clause):
                continue
            if is_head and Origin.CONCEPT not in origins:
                continue
            if ends and not _persists(origins):
                continue
            yield proposal

    def _named(self, role: Role) -> Iterator[Proposal]:
        for name in self.index.names(role):
            thing = Thing(role, name)
            definitions = self.index.definitions(thing)
            # A head that is being written must not propose itself.
            if name == self.typed and len(self.index.occurrences(thing)) == 1:
                continue
            head = self.index.head(definitions[0]) if definitions else ""
            yield Proposal(name, role, head or kinds_of(self.index, thing), "")


def _persists(origins: Collection[Origin]) -> bool:
    """Tell whether beliefs from there stay until something ends them."""
    decided = (Origin.CONCEPT, Origin.PERCEPT)
    return bool(origins) and not any(origin in decided for origin in origins)
