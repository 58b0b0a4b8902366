"""`icarus explain-rule`: the compiled plan of a concept's clauses, and where their time goes."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from icarus_lite import FrameError, InferenceError
from runtime.cli.app import DomainFile, Json, app, load
from runtime.errors import UsageError

if TYPE_CHECKING:
    from icarus_lite.inference.network import CompiledDomain
    from icarus_lite.inference.profiling import (
        DomainProfile,
        PlannedStep,
        RulePlan,
        StepProfile,
    )
    from icarus_lite.language.syntax import Domain
    from icarus_lite.outcomes import Outcome
    from icarus_lite.symbols import Percept

_WIDTH = 60


@app.command(
    "explain-rule",
    epilog="Example: icarus explain-rule domains/gearbox.icr near --frames recorded.jsonl",
)
def explain_rule(
    file: DomainFile,
    concept: Annotated[str, typer.Argument(help="The concept whose clauses to explain.")],
    frames: Annotated[
        Path | None, typer.Option(help="Recorded frames, or a trace: profile the clauses on them.")
    ] = None,
    *,
    source: Annotated[
        bool, typer.Option("--source", help="Print the generated Python of each clause as well.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Show how the clauses of a concept are compiled, and what each step of them costs.

    With recorded frames, each step is shown with the rows that passed it and the time it took,
    and the clause of the domain that the engine spends most time on is named.
    """
    from icarus_lite.inference.network import compile_domain
    from icarus_lite.inference.profiling import clause_source, rule_plans

    domain = load(file)
    compiled = compile_domain(domain)
    chosen = [p for p in rule_plans(compiled) if p.clause.head.predicate == concept]
    if not chosen:
        raise UsageError(_unknown(domain, file, concept))
    profiled = None if frames is None else _profile(compiled, frames)
    texts = {p.number: clause_source(compiled, p) for p in chosen} if source else {}
    if as_json:
        document = _document(file, concept, chosen, profiled, texts)
        typer.echo(json.dumps(document, ensure_ascii=False))
        return
    for plan in chosen:
        for line in _clause(plan, domain, profiled):
            typer.echo(line)
        for line in texts.get(plan.number, "").splitlines():
            typer.echo(f"  | {line}".rstrip())
        typer.echo()
    if profiled is not None:
        for line in _verdict(profiled):
            typer.echo(line)


def _unknown(domain: Domain, file: Path, concept: str) -> str:
    from icarus_lite.language.wording import closest

    known = sorted({clause.head.predicate for clause in domain.concepts})
    if not known:
        return f"{file} defines no concepts"
    meant = closest(concept, known)
    hint = f"did you mean {meant}?" if meant else f"it has {', '.join(known)}"
    return f"{file} has no concept called {concept}; {hint}"


def _profile(compiled: CompiledDomain, frames: Path) -> DomainProfile:
    from icarus_lite.inference.profiling import DomainProfiler

    profiler = DomainProfiler(compiled)
    for place, percepts, outcomes in _in_turn(frames):
        try:
            profiler.cycle(percepts, outcomes)
        except FrameError as error:
            raise FrameError(f"{place}: {error}") from None
        except InferenceError as error:
            raise InferenceError(f"{place}: {error}") from None
    return profiler.result()


def _in_turn(
    path: Path,
) -> Iterator[tuple[str, tuple[Percept, ...], tuple[Outcome, ...]]]:
    """Give percepts and outcomes of each recorded cycle, with the place they were read from."""
    from icarus_lite.trace import inputs_of, read_frames, read_trace

    if _is_trace(path):
        for number, record in enumerate(read_trace(path).cycles, 2):
            percepts, outcomes = inputs_of(record)
            yield f"{path}:{number}", percepts, outcomes
        return
    for frame in read_frames(path):
        yield f"{path}:{frame.line}", frame.percepts, frame.outcomes


def _is_trace(path: Path) -> bool:
    try:
        with path.open(encoding="utf-8") as lines:
            return '"icarus-trace"' in lines.readline(100)
    except (OSError, UnicodeDecodeError):
        return False  # whoever reads the frames says what is wrong


def _clause(plan: RulePlan, domain: Domain, profiled: DomainProfile | None) -> Iterator[str]:
    """Give the text of one clause with its plan, and its profile if there is one."""
    yield plan.place
    span = plan.clause.span
    lines = domain.source.text_of(span.path).splitlines()[span.line - 1 : span.end_line]
    yield from _indented(textwrap.dedent("\n".join(lines)).splitlines())
    yield from _wrapped(f"kept: {plan.kept}")
    if plan.kernel:
        yield from _wrapped(f"numeric kernel: {plan.kernel}")
    yield ""
    profile = None if profiled is None else profiled.of(plan)
    heading = f"  {'all rows at once':<{_WIDTH}}{'expected':>10}"
    yield heading + (f"{'rows':>10}{'time':>12}" if profile is not None else "")
    for number, step in enumerate(plan.steps):
        told = None if profile is None else profile.steps[number]
        yield from _step(number + 1, step, told, profiled)
    if not plan.steps:
        yield "  nothing to find: it has no conditions"
    if profile is not None:
        rows, time = _count(profile.rows, profile.cycles), _time(profile.seconds, profile.cycles)
        yield f"  {'a cycle, from scratch':<{_WIDTH}}{'':>10}{rows:>10}{time:>12}"
    if profiled is not None and profiled.engine.cycles:
        yield f"  {'a cycle, as the engine does it':<{_WIDTH}}{'':>20}{_spent(plan, profiled)}"
    if plan.updates:
        yield ""
    for update in plan.updates:
        then = " -> ".join(step.what for step in update.steps) or "nothing further to find"
        yield from _wrapped(f"on a change of {update.lead}: {then}")


def _indented(lines: Iterable[str]) -> Iterator[str]:
    return (f"  {line}".rstrip() for line in lines)


def _wrapped(text: str) -> Sequence[str]:
    return textwrap.wrap(text, 98, initial_indent="  ", subsequent_indent="    ")


def _step(
    number: int, step: PlannedStep, told: StepProfile | None, profiled: DomainProfile | None
) -> Iterator[str]:
    words = [step.what] if step.negated else [str(each) for each in (*step.atoms, *step.tests)]
    first, *others = words
    line = f"  {f'{number}  {first}':<{_WIDTH}}"
    if len(line) > _WIDTH + 2:
        yield line
        line = " " * (_WIDTH + 2)
    line += f"{'' if step.expected is None else f'{step.expected:.3g}':>10}"
    if told is not None and profiled is not None:
        line += f"{_count(told.rows_out, profiled.cycles):>10}"
        line += f"{_time(told.seconds, profiled.cycles):>12}"
        line += "  too many: rows were left out" if told.cut else ""
    yield line.rstrip()
    yield from (f"     {word}" for word in others)
    yield f"     - {step.how}; {step.why}"


def _count(rows: int, cycles: int) -> str:
    mean = rows / cycles if cycles else 0
    return f"{mean:.0f}" if mean >= 100 or mean == int(mean) else f"{mean:.1f}"


def _time(seconds: float, cycles: int) -> str:
    micros = 1e6 * seconds / cycles if cycles else 0.0
    return f"{micros / 1000:.1f} ms" if micros >= 10_000 else f"{micros:.0f} us"


def _spent(plan: RulePlan, profiled: DomainProfile) -> str:
    engine = profiled.engine
    seconds = engine.clauses[plan.number]
    share = 100 * seconds / engine.seconds if engine.seconds else 0.0
    return f"{_time(seconds, engine.cycles):>12}  {share:.0f} % of a cycle"


def _verdict(profiled: DomainProfile) -> Iterator[str]:
    """Point to the slow clause, and in it to the step where rows multiply."""
    engine, cycles = profiled.engine, profiled.cycles
    if not cycles:
        yield "0 cycles: there is nothing to measure"
        return
    times = f"the first took the engine {_time(engine.first, 1)}"
    if engine.cycles:
        times += f", each of the others {_time(engine.seconds, engine.cycles)} on average"
    yield f"{cycles} {'cycle' if cycles == 1 else 'cycles'}: {times}"
    slowest = profiled.slowest
    if slowest is None or slowest.widest is None:
        return
    plan, widest = slowest.plan, slowest.widest
    time = _time(slowest.seconds, cycles)
    if engine.cycles:
        time = _spent(plan, profiled).strip().replace("  ", ", ")
    yield f"slowest clause of the domain: {plan.clause.head} at {plan.place}, {time}"
    number = slowest.steps.index(widest) + 1
    yield (
        f"its widest step is number {number}: {_count(widest.rows_out, cycles)} rows, of which "
        f"{_count(slowest.rows, cycles)} get through to the end"
    )


def _document(
    file: Path,
    concept: str,
    chosen: Sequence[RulePlan],
    profiled: DomainProfile | None,
    texts: Mapping[int, str],
) -> dict[str, object]:
    document: dict[str, object] = {"file": str(file), "concept": concept}
    document["clauses"] = [_clause_document(plan, profiled, texts) for plan in chosen]
    if profiled is not None:
        slowest = profiled.slowest
        engine = profiled.engine
        document["cycles"] = profiled.cycles
        document["engine"] = {
            "first_seconds": engine.first,
            "cycles": engine.cycles,
            "seconds": engine.seconds,
        }
        document["slowest"] = slowest and {
            "head": str(slowest.plan.clause.head),
            "place": slowest.plan.place,
        }
    return document


def _clause_document(
    plan: RulePlan, profiled: DomainProfile | None, texts: Mapping[int, str]
) -> dict[str, object]:
    profile = None if profiled is None else profiled.of(plan)
    steps: list[dict[str, object]] = []
    for number, step in enumerate(plan.steps):
        row: dict[str, object] = {
            "what": step.what,
            "how": step.how,
            "why": step.why,
            "expected": step.expected,
        }
        if profile is not None:
            told = profile.steps[number]
            row |= {"rows_in": told.rows_in, "rows_out": told.rows_out}
            row |= {"seconds": told.seconds, "cut": told.cut}
        steps.append(row)
    document: dict[str, object] = {
        "head": str(plan.clause.head),
        "place": plan.place,
        "line": plan.clause.span.line,
        "kept": plan.kept,
        "kernel": plan.kernel or None,
        "steps": steps,
        "updates": [
            {"when": update.lead, "then": [step.what for step in update.steps]}
            for update in plan.updates
        ],
    }
    if profile is not None:
        document |= {"rows": profile.rows, "seconds": profile.seconds}
    if profiled is not None:
        document["engine_seconds"] = profiled.engine.clauses[plan.number]
    if plan.number in texts:
        document["source"] = texts[plan.number]
    return document
