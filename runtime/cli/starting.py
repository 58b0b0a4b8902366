"""Where a plan begins: the last recorded frame, what the task gives, or a test of the domain."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from icarus_lite import Belief, FrameError, InferenceError, Value
from icarus_lite.language.syntax import Constant
from runtime.errors import UsageError

if TYPE_CHECKING:
    from icarus_lite.inference import InferenceEngine, Memory
    from icarus_lite.language.syntax import Call, Condition, Domain, DomainTest, LaterCycle, Task
    from icarus_lite.planning import Imagination


@dataclass(frozen=True, slots=True)
class Start:
    """The state to plan from.

    Args:
        engine: Has inferred it, and expands it.
        memory: What is believed and carried over.
        origin: Where it comes from, in words.
    """

    engine: InferenceEngine
    memory: Memory
    origin: str

    def imagination(self) -> Imagination:
        """Give the imagination that expands situations from here."""
        from icarus_lite.planning import Imagination

        return Imagination(
            self.engine.domain, self.memory, self.engine.closure, self.engine.evaluator
        )


class Known:
    """The state as the PDDL exporter asks for it."""

    def __init__(self, start: Start) -> None:
        self._store = start.memory.state.facts()
        self._evaluator = start.engine.evaluator
        self.facts: Sequence[Belief] = tuple(self._store)

    def matches(
        self, conditions: Sequence[Condition], tests: Sequence[Call], bindings: Mapping[str, Value]
    ) -> Iterator[Mapping[str, Value]]:
        """Give the bindings under which conditions and tests hold."""
        from icarus_lite.inference import Matcher

        matcher = Matcher(conditions, tests, tuple(bindings), self._evaluator)
        for found in matcher.matches(self._store, bindings):
            yield found.bindings


def find_task(domain: Domain, name: str) -> Task:
    """Give the task of that name. Raises UsageError, naming those there are."""
    for task in domain.tasks:
        if task.name == name:
            return task
    names = ", ".join(task.name for task in domain.tasks)
    there = f"its tasks are: {names}" if names else "it has no tasks"
    raise UsageError(f"{domain.source.path} has no task {name}; {there}")


def start_state(domain: Domain, task: Task | None, frames: Path | None) -> Start:
    """Give the state to plan from.

    Recorded frames come first, the last of them counts; what the task's `:init` gives besides
    percepts is believed from the start. Without frames, `:init` is the whole state. Without that,
    a test of the domain is taken for an example: the first that plans for the same goal, or else
    the first that perceives every object of the goal.

    Raises:
        UsageError: There is nothing to start from.
        FrameError: The frames are malformed.
        InferenceError: A test of the domain cannot be evaluated.
    """
    from icarus_lite.inference import InferenceEngine, given_memory, given_percepts

    engine = InferenceEngine(domain)
    given = task.init if task is not None else ()
    memory = given_memory(domain, given)
    if frames is not None:
        return Start(engine, _after_frames(engine, memory, frames), f"the last frame of {frames}")
    if task is not None and given:
        memory = engine.step_once(memory, given_percepts(domain, given))
        return Start(engine, memory, f"the facts that task {task.name} gives")
    if task is not None:
        example = _example(domain, task)
        if example is not None:
            memory = _after_test(engine, example)
            return Start(engine, memory, f'the test "{example.name}", for task {task.name}')
    subject = f"task {task.name} gives" if task is not None else "a goal alone gives"
    raise UsageError(
        f"{subject} no state to plan from: record one and name it with --frames IN.jsonl"
        + (", or add :init (…) to the task" if task is not None else "")
    )


def _after_frames(engine: InferenceEngine, memory: Memory, frames: Path) -> Memory:
    from icarus_lite.trace import read_frames

    empty = True
    for frame in read_frames(frames):
        empty = False
        try:
            memory = engine.step(memory, frame.percepts, frame.outcomes)
        except FrameError as error:
            raise FrameError(error.message, path=str(frames), line=frame.line) from None
        except InferenceError as error:
            raise InferenceError(f"{frames}:{frame.line}: {error}") from None
    if empty:
        raise FrameError("holds no frame", path=str(frames))
    return memory


def _example(domain: Domain, task: Task) -> DomainTest | None:
    """Choose the test of a domain that shows a state in which the task may begin."""
    for test in domain.tests:
        if test.goals and test.goals == task.goals:
            return test
    wanted = {t.value for g in task.goals for t in g.atom.args if isinstance(t, Constant)}
    for test in domain.tests:
        perceived = {t.value for p in test.percepts for t in p.args if isinstance(t, Constant)}
        if not test.actions and not test.then and wanted <= perceived:
            return test
    return None


def _after_test(engine: InferenceEngine, test: DomainTest) -> Memory:
    from icarus_lite.inference import Memory, given_percepts
    from icarus_lite.outcomes import Outcome
    from icarus_lite.symbols import Action

    if not test.actions and not test.then:
        return engine.step_once(Memory(), given_percepts(engine.domain, test.percepts))
    memory, percepts = Memory(), test.percepts
    cycles: tuple[DomainTest | LaterCycle, ...] = (test, *test.then)
    for cycle in cycles:
        percepts = percepts if cycle.percepts is None else cycle.percepts
        done = [
            Outcome(
                Action(atom.predicate, tuple(t.value for t in atom.args if isinstance(t, Constant)))
            )
            for atom in cycle.actions
        ]
        memory = engine.step(memory, given_percepts(engine.domain, percepts), done)
    return memory
