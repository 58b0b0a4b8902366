"""All that could come to hold if nothing were ever undone, and the clause instances it takes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

from icarus_lite.errors import InferenceError
from icarus_lite.inference import Evaluator
from icarus_lite.language.syntax import ConceptClause
from icarus_lite.planning.beginning import Beginning
from icarus_lite.planning.grounding.attaching import Attaching
from icarus_lite.planning.grounding.clauses import GroundedClause
from icarus_lite.planning.grounding.facts import GIVEN, HELD, FactBase, static_index
from icarus_lite.planning.grounding.prepared import Prepared
from icarus_lite.planning.grounding.views import Attributes, Cells, Index, sorted_attributes
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Action, Value

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

Found = tuple[Cells, tuple[int, ...], tuple[int, ...]]
"""An instance: what its variables are bound to, the facts that it rests on, those it makes true."""


@dataclass(frozen=True, slots=True)
class Reached:
    """What could come to hold.

    Args:
        base: The facts that may change, numbered.
        found: The instances of each clause.
        initial: The facts that hold now, derived ones left out.
        permanent: Those of them that hold whatever is done: percepts.
    """

    base: FactBase
    found: tuple[list[Found], ...]
    initial: frozenset[int]
    permanent: frozenset[int]


def reach(prepared: Prepared, beginning: Beginning, excluded: Collection[Action] = ()) -> Reached:
    """Find all facts and instances that the beliefs of now lead to, nothing being undone.

    Negated conditions on what may change are left for later.

    Raises:
        InferenceError: a test or bind cannot be evaluated for what is believed now.
    """
    base = FactBase()
    permanent, asserted = _begin(base, prepared, beginning)
    initial = len(base.atoms)
    found: tuple[list[Found], ...] = tuple([] for _ in prepared.clauses)
    scope = _scope(prepared, beginning, base, found, initial, excluded)
    exec(prepared.program.code, scope)  # noqa: S102 - the source is written by `compile_program`
    leads: dict[str, list[tuple[Callable[..., None], Index, object]]] = {}
    for lead in prepared.program.leads:
        function: Any = scope[lead.name]
        if lead.view is None:
            function()
            continue
        key = lead.key if len(lead.key) != 1 else lead.key[0]
        known = leads.setdefault(lead.view.predicate, [])
        known.append((function, base.index(lead.view), key))
    while (taken := base.take_in()) is not None:
        predicate, numbers = taken
        if predicate.startswith((GIVEN, HELD)):
            _pass_on(base, predicate, numbers)
        for find, news, sought in leads.get(predicate, ()):
            fresh = news.get(sought)
            if fresh:
                find(fresh, numbers[0])
        for _, news, _ in leads.get(predicate, ()):
            news.clear()
    return Reached(base, found, permanent | asserted, permanent)


def _begin(
    base: FactBase, prepared: Prepared, beginning: Beginning
) -> tuple[frozenset[int], frozenset[int]]:
    """Note what holds now of what may change; give what will always hold, and the rest."""
    permanent = {
        base.note(fact.predicate, fact.args, sorted_attributes(fact.attributes))
        for fact in beginning.percepts
        if fact.predicate in prepared.fluents
    }
    perceived = {(fact.predicate, fact.args) for fact in beginning.percepts}
    asserted = set()
    changing = [each for each in beginning.asserted if each.predicate in prepared.fluents]
    for belief in sorted(changing, key=str):
        predicate = belief.predicate
        if (predicate, belief.args) in perceived:
            continue
        name = GIVEN + predicate if predicate in prepared.concepts else predicate
        asserted.add(base.note(name, belief.args, sorted_attributes(belief.attributes)))
    if ATTACHED in prepared.fluents:
        pairs = sorted(beginning.hierarchy.pairs(), key=str)
        asserted.update(base.note(prepared.hierarchy, pair) for pair in pairs)
    return frozenset(permanent), frozenset(asserted)


def _pass_on(base: FactBase, predicate: str, numbers: Sequence[int]) -> None:
    """Note that what is given or held of a concept holds."""
    name = predicate.removeprefix(GIVEN).removeprefix(HELD)
    for number in numbers:
        _, args, attributes = base.atoms[number]
        base.note(name, args, attributes)


def _scope(
    prepared: Prepared,
    beginning: Beginning,
    base: FactBase,
    found: Sequence[list[Found]],
    initial: int,
    excluded: Collection[Action],
) -> dict[str, object]:
    """Give what the compiled functions look into and write to, by the names they have for it."""
    program = prepared.program
    scope: dict[str, object] = dict(program.constants)
    for name, view in program.indexes.items():
        scope[name] = base.index(view)
    rows: dict[str, list[tuple[Cells, Attributes]]] = {}
    for name, view in program.static.items():
        if view.predicate not in rows:
            rows[view.predicate] = _static_facts(view.predicate, beginning)
        scope[name] = static_index(view, rows[view.predicate])
    if program.tests or program.binds:
        scope |= _expressions(prepared, beginning.evaluator, initial)
    for clause in prepared.clauses:
        name = clause.clause.head.predicate
        scope[f"banned{clause.number}"] = {a.args for a in excluded if a.name == name}
        scope |= _outlets(clause, prepared, base, found[clause.number])
    return scope


def _expressions(
    prepared: Prepared, evaluator: Evaluator, initial: int
) -> dict[str, Callable[[Cells, tuple[int, ...]], Value | bool | None]]:
    """Give what evaluates the tests and `:binds` of the compiled functions."""
    from icarus_lite.inference import expressions  # noqa: PLC0415 - most of PDDL has none

    compiled = {}
    for name, (_, test, names) in prepared.program.tests.items():
        slots = _slots(names)
        asked = expressions.compile_test(test, slots, evaluator.functions, evaluator.path)
        compiled[name] = _guarded(asked, initial, otherwise=False)
    for name, (number, place, names) in prepared.program.binds.items():
        concept = prepared.clauses[number].clause
        assert isinstance(concept, ConceptClause)
        bound, slots = concept.binds[place].expression, _slots(names)
        computed = expressions.compile_bind(bound, slots, evaluator.functions, evaluator.path)
        compiled[name] = _guarded(computed, initial, otherwise=None)
    return compiled


def _outlets(
    clause: GroundedClause, prepared: Prepared, base: FactBase, found: list[Found]
) -> dict[str, object]:
    """Give what the functions of one clause write to."""
    number = clause.number
    outlets: dict[str, object] = {f"found{number}": found.append}
    for place, atom in enumerate(clause.effects):
        predicate = atom.predicate
        if atom.attributes:
            outlets[f"note{number}_{place}"] = base.noter(predicate)
        else:
            outlets[f"numbers{number}_{place}"] = base.numbers_of(predicate)
    if clause.attaching is not None:
        attach = _attacher(clause.attaching, clause.variables, base, prepared.hierarchy)
        outlets[f"attach{number}"] = attach
    return outlets


def _static_facts(predicate: str, beginning: Beginning) -> list[tuple[Cells, Attributes]]:
    """Give the facts of a predicate that does not change: percepts first, then as sorted."""
    facts = [
        (fact.args, sorted_attributes(fact.attributes))
        for ((_, fact, _),) in beginning.facts.rows(predicate).values()
    ]
    if any(fact.predicate == predicate for fact in beginning.percepts):
        return facts
    try:
        return sorted(facts)
    except TypeError:  # numbers and symbols in one place
        return sorted(facts, key=str)


def _slots(names: Sequence[str]) -> Mapping[str, int]:
    return {name: slot for slot, name in enumerate(names)}


def _guarded(
    compute: Callable[[Cells], Value | bool], initial: int, *, otherwise: bool | None
) -> Callable[[Cells, tuple[int, ...]], Value | bool | None]:
    """Give a default to what has no value, unless it is asked about what is believed now.

    Grounding asks about situations that need never come about.
    """

    def guarded(row: Cells, numbers: tuple[int, ...]) -> Value | bool | None:
        try:
            return compute(row)
        except InferenceError:
            if all(number < initial for number in numbers):
                raise
            return otherwise

    return guarded


def _attacher(
    attaching: Attaching, names: Sequence[str], base: FactBase, predicate: str
) -> Callable[[Cells], tuple[int, ...]]:
    """Give a function that notes the attachments an instance may make."""

    def attach(row: Cells) -> tuple[int, ...]:
        pairs = attaching.pairs(dict(zip(names, row, strict=True)))
        return tuple([base.note(predicate, pair) for pair in pairs])

    return attach
