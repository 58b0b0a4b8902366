"""Where a belief could come from at all: concepts, effects, attachments; or nowhere."""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.inference.explaining.context import Context
from icarus_lite.inference.explaining.fitting import fit
from icarus_lite.inference.supports import bind_pattern
from icarus_lite.language.checking.vocabulary import Definition, Origin
from icarus_lite.language.syntax import Atom, AttachmentRule, Span
from icarus_lite.language.wording import closest, listing
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED


@dataclass(frozen=True, slots=True)
class Source:
    """An action that has a belief among its effects.

    Args:
        action: The action, bound as far as the belief says.
        spans: The clauses with the effect, or the attachment.
        asserts: Whether success asserts it. Where concepts define the belief, success only lets
            the planner expect it.
    """

    action: Atom
    spans: tuple[Span, ...]
    asserts: bool = True

    def __str__(self) -> str:
        lines = [span.in_line for span in self.spans if span.line]
        place = f" ({listing(lines)})" if lines else ""
        if self.asserts:
            return f"the success of {self.action}{place} would assert it"
        return f"{self.action}{place} is expected to bring it about, but perception decides"


def sources(asked: Atom, context: Context) -> tuple[Source, ...]:
    """Give each action that has a belief which matches a pattern among its effects."""
    merged: dict[tuple[Atom, bool], list[Span]] = {}
    for action, span, asserts in _sources(asked, context):
        merged.setdefault((action, asserts), []).append(span)
    return tuple(
        Source(action, tuple(spans), asserts) for (action, asserts), spans in merged.items()
    )


def _sources(asked: Atom, context: Context) -> Iterator[tuple[Atom, Span, bool]]:
    if asked.predicate == ATTACHED:
        for rule in context.domain.attachments:
            action = _attaching(asked, rule)
            if action is not None:
                yield action, rule.span, True
    asserts = Origin.CONCEPT not in context.origins(asked.predicate)
    for clause in context.domain.skills:
        for effect in clause.effects:
            found = None if effect.negated else fit(effect.atom, asked)
            if found is not None:
                yield bind_pattern(clause.head, found.bindings), clause.span, asserts
                break


def _attaching(asked: Atom, rule: AttachmentRule) -> Atom | None:
    found = fit(Atom(ATTACHED, (rule.child, rule.parent)), asked)
    return None if found is None else bind_pattern(rule.attach, found.bindings)


def impossible(asked: Atom, context: Context) -> tuple[str, ...]:
    """Say why nothing could ever make a belief true, whatever is perceived and done.

    Empty where something could.
    """
    definitions = context.names.predicates.get(asked.predicate, ())
    known = [*context.names.predicates, *(p.type for p in context.state.percepts)]
    if not definitions and asked.predicate not in known:
        return (_unknown(asked.predicate, context),)
    arities = sorted({each.arity for each in definitions})
    if arities and len(asked.args) not in arities:
        takes = listing([str(arity) for arity in arities], "or")
        things = "argument" if arities == [1] else "arguments"
        return (f"`{asked.predicate}` takes {takes} {things}, not {len(asked.args)}",)
    return tuple(_impossible_values(asked, definitions, context))


def _unknown(name: str, context: Context) -> str:
    meant = closest(name, sorted({*context.names.predicates, *context.names.skills}))
    hint = f"; did you mean `{meant}`?" if meant else ""
    return f"no percept, concept, effect or skill is called `{name}`{hint}"


def _impossible_values(
    asked: Atom, definitions: tuple[Definition, ...], context: Context
) -> Iterator[str]:
    attributes = frozenset[str]().union(*(each.attributes for each in definitions))
    for name, _ in asked.attributes:
        if definitions and name not in attributes:
            meant = closest(name, sorted(attributes))
            hint = f"; did you mean ^{meant}?" if meant else ""
            yield f"`{asked.predicate}` never has an attribute ^{name}{hint}"
            return
    origins = context.origins(asked.predicate)
    if not definitions or Origin.PERCEPT in origins or Origin.GIVEN in origins:
        return
    if any(fit(c.head, asked, c.binds) for c in context.domain.concepts):
        return
    if any(source.asserts for source in sources(asked, context)):
        return
    if asked.predicate == ATTACHED and not context.domain.attachments:
        yield "no action ever attaches anything"
    else:
        yield f"no concept and no effect ever makes {asked} true: their constants differ from it"
