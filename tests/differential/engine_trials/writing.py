"""A trial as a person reads it: the domain as an .icr file, the history cycle by cycle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from engine_trials.histories import Change
from engine_trials.vocabulary import SUPERTYPE, Vocabulary
from icarus_lite import Belief
from icarus_lite.language.syntax import ConceptClause
from icarus_lite.symbols import format_value


def domain_text(vocabulary: Vocabulary, clauses: Sequence[ConceptClause]) -> str:
    """Write a domain.

    What no concept defines are the effects of a skill that is never carried out: the checker asks
    where a predicate comes from.
    """
    lines = ["(percepts"]
    for each in vocabulary.percepts:
        above = SUPERTYPE.get(each.name)
        inherited = dict(vocabulary.signatures[above].attributes) if above else {}
        own = [f"^{name}" for name, _ in each.attributes if name not in inherited]
        words = [each.name, *([":is", above] if above else []), *own]
        lines.append(f"  ({' '.join(words)})")
    lines[-1] += ")"
    lines.append("(concepts")
    lines += [clause_text(clause) for clause in clauses]
    lines[-1] += ")"
    variables = {name: f"?{name}" for name in "ab"}
    effects = []
    defined = {clause.head.predicate for clause in clauses}
    perceived = {each.name for each in vocabulary.percepts}
    for each in vocabulary.signatures.values():
        if each.name in defined or each.name in perceived:
            continue
        words = [each.name, *(variables["ab"[i % 2]] for i in range(len(each.args)))]
        words += [f"^{name} {variables['a']}" for name, _ in each.attributes]
        effects.append(f"({' '.join(words)})")
    lines.append("(skills ((note ?a ?b) :elements ((obj ?a) (obj ?b)) :actions ((*note ?a ?b))")
    lines.append(f"  :effects ({' '.join(effects)})))")
    return "\n".join(lines) + "\n"


def clause_text(clause: ConceptClause) -> str:
    """Write a clause of `(concepts …)`."""
    parts = [f"  ({clause.head}"]
    if clause.elements:
        parts.append(f":elements ({' '.join(map(str, clause.elements))})")
    if clause.tests:
        parts.append(f":tests ({' '.join(map(str, clause.tests))})")
    if clause.binds:
        binds = " ".join(f"({each.variable} {each.expression})" for each in clause.binds)
        parts.append(f":binds ({binds})")
    return "\n   ".join(parts) + ")"


def history_text(history: Sequence[Change]) -> str:
    """Write a history, a block of lines for each cycle."""
    return "\n".join(line for i, change in enumerate(history) for line in _lines(i, change)) + "\n"


def _lines(cycle: int, change: Change) -> Iterator[str]:
    yield f"cycle {cycle}"
    for percept in change.percepts:
        yield f"  + {percept}"
    for kind, name in change.gone:
        yield f"  - ({kind} {name})"
    for belief in change.asserted:
        yield f"  asserted  {belief_text(belief)}"
    for belief in change.withdrawn:
        yield f"  withdrawn {belief_text(belief)}"


def belief_text(belief: Belief) -> str:
    """Write a belief with its attributes."""
    given = [f"^{name} {format_value(value)}" for name, value in belief.attributes.items()]
    return f"({' '.join([str(belief)[1:-1], *given])})"
