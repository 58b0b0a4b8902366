"""One concept as Python source: how the changes that its clauses gather come to be beliefs."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference.network.design import Head, Keeping
from icarus_lite.inference.network.generation.rules import Wiring
from icarus_lite.inference.network.generation.writing import Lines
from icarus_lite.inference.network.relations import Facts, Relation


def write_head(lines: Lines, head: Head, wiring: Wiring) -> None:
    """Write how a concept that does not depend on itself is settled and loaded."""
    name, number = head.facts.name, head.number
    clause = head.bodies[0].number
    lines.add(f"# ({head.facts.predicate}{' ?' * head.facts.arity}) is kept as: {head.keeping}")
    if head.keeping is Keeping.UNIQUE:
        _unique(lines, name, number, clause)
    elif head.keeping is Keeping.COUNTED:
        _counted(lines, name, number, clause)
    with lines.block(f"def load_{name}():"):
        lines.add(*(f"{wiring.fills[body.number]}()" for body in head.bodies))
        lines.add(f"{name}.update({name}_changes)", f"{name}_changes.clear()")
        lines.add(f"if len({name}) > most: too_many({clause})")
        lines.add(f"index_{name}()")
    lines.add("")


def _unique(lines: Lines, name: str, number: int, clause: int) -> None:
    with lines.block(f"def settle_{name}():"):
        lines.add("gained, lost = [], []")
        with lines.block(f"for key, change in {name}_changes.items():"):
            with lines.block("if change > 0:"):
                lines.add(f"show_{name}(key, 1)", "gained.append(key)")
            with lines.block("elif change:"):
                lines.add(f"withdraw_{name}(key, 1)", "lost.append(key)")
        _end_of_settling(lines, name, number, clause)


def _counted(lines: Lines, name: str, number: int, clause: int) -> None:
    with lines.block(f"def settle_{name}():"):
        lines.add("gained, lost = [], []")
        with lines.block(f"for key, change in {name}_changes.items():"):
            lines.add("if not change: continue", f"before = {name}.get(key, 0)")
            with lines.block("if not before:"):
                lines.add(f"show_{name}(key, change)", "gained.append(key)")
            with lines.block("elif before + change:"):
                lines.add(f"{name}[key] = before + change")
            with lines.block("else:"):
                lines.add(f"withdraw_{name}(key, 0)", "lost.append(key)")
        _end_of_settling(lines, name, number, clause)


def _end_of_settling(lines: Lines, name: str, number: int, clause: int) -> None:
    lines.add(f"{name}_changes.clear()")
    with lines.block("if gained or lost:"):
        lines.add(f"record(({number}, gained, lost, ()))")
        lines.add(f"tick({clause})")
        lines.add(f"if len({name}) > most: too_many({clause})")
    lines.add("")


def write_component(lines: Lines, heads: Sequence[Head], wiring: Wiring) -> None:
    """Write how concepts that depend on one another are settled and loaded.

    Beliefs that rest on something gone are doubted, with all that rests on them, and taken out;
    those that can be proved from what is left come back, and so does what follows from them
    (delete and rederive; Gupta, Mumick and Subrahmanian 1993). Each belief keeps the stage at
    which it was proved, so that a proof can keep to beliefs of lower stages and never circles.
    """
    number = heads[0].component
    clause = heads[0].bodies[0].number
    shown = " ".join(f"({head.facts.predicate}{' ?' * head.facts.arity})" for head in heads)
    lines.add(f"# {shown}: recursive")
    for head in heads:
        _provable(lines, head)
    _grow(lines, heads, wiring, number, clause)
    _doubt(lines, heads, wiring, number, clause)
    _tell(lines, heads, wiring)
    _load(lines, heads, wiring, number)


def _doubt(lines: Lines, heads: Sequence[Head], wiring: Wiring, number: int, clause: int) -> None:
    """Write how beliefs are doubted, taken out, and proved again."""
    names = [head.facts.name for head in heads]
    with lines.block(f"def settle_component_{number}():"):
        for name in names:
            lines.add(f"{name}_doubted = {{}}")
            lines.add(f"{name}_work = [key for key in {name}_lost if key in {name}]")
        with lines.block(f"while {' or '.join(f'{name}_work' for name in names)}:"):
            lines.add(f"tick({clause})")
            for head in heads:
                name = head.facts.name
                with lines.block(f"while {name}_work:"):
                    lines.add(f"key = {name}_work.pop()")
                    lines.add(f"if key in {name}_doubted: continue")
                    lines.add(f"{name}_doubted[key] = {name}[key]")
                    lines.add(*_reach(head.facts, wiring))
            for name in names:
                lines.add(f"{name}_work += [key for key in {name}_reached if key in {name}]")
                lines.add(f"{name}_reached.clear()")
        for name in names:
            with lines.block(f"for key in {name}_doubted:"):
                lines.add(f"delete_{name}(key, None)")
        for name in names:
            lines.add(f"{name}_new = {{}}")
            opening = f"for key in (*{name}_doubted, *{name}_gained):"
            condition = f"if key not in {name} and {name}_is_provable(key):"
            with lines.block(opening), lines.block(condition):
                lines.add(f"{name}_new[key] = None", f"insert_{name}(key, next(stage))")
        lines.add(f"grow_component_{number}({', '.join(f'{name}_new' for name in names)})")


def _tell(lines: Lines, heads: Sequence[Head], wiring: Wiring) -> None:
    """Write, into the same function, how what has changed is told.

    The rules above see the changes one by one, so they are taken back and then shown.
    """
    lines.indent()
    for head in heads:
        n, name = head.number, head.facts.name
        lines.add(f"{name}_lost.clear()", f"{name}_gained.clear()")
        lines.add(f"gained_{n} = [key for key in {name}_new if key not in {name}_doubted]")
        lines.add(f"lost_{n} = [key for key in {name}_doubted if key not in {name}]")
    told = [h for h in heads if h.facts.name in wiring.present or h.facts.name in wiring.absent]
    for head in told:
        n, name = head.number, head.facts.name
        lines.add(f"stages_{n} = [{name}[key] for key in gained_{n}]")
        with lines.block(f"for key in gained_{n}:"):
            lines.add(f"delete_{name}(key, None)")
        with lines.block(f"for key in lost_{n}:"):
            lines.add(f"insert_{name}(key, {name}_doubted[key])")
    for head in told:
        n, name = head.number, head.facts.name
        with lines.block(f"for key in lost_{n}:"):
            lines.add(f"withdraw_{name}(key, None)")
        with lines.block(f"for key, at in zip(gained_{n}, stages_{n}):"):
            lines.add(f"show_{name}(key, at)")
    for head in heads:
        n = head.number
        with lines.block(f"if gained_{n} or lost_{n}:"):
            lines.add(f"record(({n}, gained_{n}, lost_{n}, ()))")
    lines.indent(-1)
    lines.add("")


def _reach(facts: Relation, wiring: Wiring) -> list[str]:
    functions = wiring.grown.get(facts.name, [])
    cells = "*key" if facts.keys > 1 else "key"
    return [f"{function}({cells if facts.keys else ''})" for function in functions]


def _provable(lines: Lines, head: Head) -> None:
    name = head.facts.name
    with lines.block(f"def {name}_is_provable(key):"):
        cells = "*key" if head.facts.keys > 1 else "key" if head.facts.keys else ""
        for body in head.bodies:
            with lines.block(f"for _ in prove_{name}_{body.number + 1}({cells}):"):
                lines.add("return True")
        lines.add("return False")
    lines.add("")


def _grow(lines: Lines, heads: Sequence[Head], wiring: Wiring, number: int, clause: int) -> None:
    names = [head.facts.name for head in heads]
    parameters = ", ".join(f"{name}_new" for name in names)
    with lines.block(f"def grow_component_{number}({parameters}):"):
        for name in names:
            lines.add(f"{name}_work = list({name}_new)")
        with lines.block(f"while {' or '.join(f'{name}_work' for name in names)}:"):
            lines.add(f"tick({clause})")
            for head in heads:
                name = head.facts.name
                with lines.block(f"while {name}_work:"):
                    lines.add(f"key = {name}_work.pop()", *_reach(head.facts, wiring))
            for head in heads:
                name = head.facts.name
                opening = f"for key in {name}_reached:"
                with lines.block(opening), lines.block(f"if key not in {name}:"):
                    lines.add(f"insert_{name}(key, next(stage))")
                    lines.add(f"{name}_new[key] = None", f"{name}_work.append(key)")
                lines.add(f"{name}_reached.clear()")
                own = (body for body in head.bodies if head.facts in body.relations)
                clause = next(own, head.bodies[0]).number
                lines.add(f"if len({name}) > most: too_many({clause})")
    lines.add("")


def _load(lines: Lines, heads: Sequence[Head], wiring: Wiring, number: int) -> None:
    with lines.block(f"def load_component_{number}():"):
        for head in heads:
            name = head.facts.name
            fills = [wiring.fills[b.number] for b in head.bodies if b.number in wiring.fills]
            lines.add(*(f"{fill}()" for fill in fills))
            lines.add(f"{name}_new = {name}_gained.copy()", f"{name}_gained.clear()")
            with lines.block(f"for key in {name}_new:"):
                lines.add(f"insert_{name}(key, next(stage))")
        lines.add(f"grow_component_{number}({', '.join(f'{h.facts.name}_new' for h in heads)})")
    lines.add("")


def cells_of(relations: Sequence[Relation], head: Head) -> tuple[Facts, ...]:
    """Give the relations that hold a concept's beliefs with some of their attributes."""
    facts = head.facts
    return tuple(
        each
        for each in relations
        if isinstance(each, Facts)
        and each.cells
        and (each.predicate, each.arity) == (facts.predicate, facts.arity)
    )
