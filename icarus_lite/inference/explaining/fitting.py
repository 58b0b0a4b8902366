"""Whether the head of a clause, or an effect, can stand for what is asked about."""

from __future__ import annotations

from collections.abc import Mapping

from icarus_lite.language.syntax import Atom, Bind, Call, Constant, Expression, Term, Variable
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value


@dataclass(frozen=True, slots=True)
class Fit:
    """How a head stands for a pattern.

    Args:
        bindings: What the pattern binds of the head's variables.
        demands: What it demands besides: that two variables agree because the pattern names one
            variable twice, or that a computed attribute has the value it names.
    """

    bindings: Mapping[str, Value]
    demands: tuple[Call, ...] = ()


def fit(head: Atom, asked: Atom, binds: tuple[Bind, ...] = ()) -> Fit | None:
    """Match the head of a clause with a pattern, both of which may have variables.

    Args:
        head: The head, or an effect.
        asked: The pattern; its variables are its own, whatever their names.
        binds: How the clause computes attributes of the head.

    Returns:
        None where no instance of the head matches the pattern: the number of arguments or a
        constant differs, or an attribute is asked for that it does not have.
    """
    if head.predicate != asked.predicate or len(head.args) != len(asked.args):
        return None
    have = dict(head.attributes)
    if any(name not in have for name, _ in asked.attributes):
        return None
    pairs = list(zip(head.args, asked.args, strict=True))
    pairs += [(have[name], term) for name, term in asked.attributes]
    bindings: dict[str, Value] = {}
    groups: dict[str, list[Term]] = {}
    for own, theirs in pairs:
        if isinstance(theirs, Variable):
            groups.setdefault(theirs.name, []).append(own)
        elif not _bind(own, theirs.value, bindings):
            return None
    demands: list[Call] = []
    for terms in groups.values():
        known = [value for term in terms if (value := _value(term, bindings)) is not None]
        if known and not all(_bind(term, known[0], bindings) for term in terms):
            return None
        if not known:
            first, *others = dict.fromkeys(terms)
            demands += [Call("=", (first, other), first.span) for other in others]
    computed = {bind.variable.name: bind.expression for bind in binds}
    for name in [name for name in bindings if name in computed]:
        wanted = Constant(bindings.pop(name))
        demands.append(Call("=", (_expanded(computed[name], computed), wanted)))
    return Fit(bindings, tuple(_spread(each, computed) for each in demands))


def _bind(term: Term, value: Value, bindings: dict[str, Value]) -> bool:
    if isinstance(term, Variable):
        return bindings.setdefault(term.name, value) == value
    return term.value == value


def _value(term: Term, bindings: Mapping[str, Value]) -> Value | None:
    return bindings.get(term.name) if isinstance(term, Variable) else term.value


def _expanded(expression: Expression, computed: Mapping[str, Expression]) -> Expression:
    """Replace computed variables by what computes them; a bind only uses those before it."""
    if isinstance(expression, Call):
        return _spread(expression, computed)
    if isinstance(expression, Variable) and expression.name in computed:
        return _expanded(computed[expression.name], computed)
    return expression


def _spread(call: Call, computed: Mapping[str, Expression]) -> Call:
    args = tuple(_expanded(each, computed) for each in call.args)
    return Call(call.function, args, call.span)
