from __future__ import annotations

from typing import Any

from runtime.controller.program import Program, blocking_names
from runtime.controller.urscript import translate


class Stage:
    """A program with functions that record what was done in which cycle."""

    def __init__(self, text: str) -> None:
        self.cycle = 0
        self.said: list[tuple[int, Any]] = []
        self.let_go = 0

        def sync():
            yield

        def hold():
            try:
                while True:
                    yield
            finally:
                self.let_go += 1

        def say(value):
            self.said.append((self.cycle, value))

        functions = {"say": say, "sync": sync, "hold": hold}
        translation = translate(f"def prog():\n{text}\nend\n", blocking_names(functions))
        self.program = Program(translation, functions)

    def run(self, cycles: int) -> list[tuple[int, Any]]:
        for _ in range(cycles):
            if not self.program.ended:
                self.program.step()
            self.cycle += 1
        return self.said


def test_threads_take_turns_within_a_cycle():
    stage = Stage(
        """
        thread other():
            while True:
                say("other")
                sync()
            end
        end
        t = run other()
        while True:
            say("main")
            sync()
        end
        """
    )
    assert stage.run(2) == [(0, "main"), (0, "other"), (1, "main"), (1, "other")]


def test_a_killed_thread_lets_go_of_what_it_held_and_killing_it_again_does_nothing():
    stage = Stage(
        """
        thread other():
            hold()
        end
        t = run other()
        sync()
        kill t
        kill t
        kill 0
        say("killed")
        sync()
        """
    )
    assert stage.run(2) == [(1, "killed")]
    assert stage.let_go == 1


def test_a_critical_section_keeps_other_threads_out_even_while_it_waits():
    stage = Stage(
        """
        thread other():
            while True:
                say("other")
                sync()
            end
        end
        t = run other()
        enter_critical
        sync()
        say("main")
        exit_critical
        sync()
        """
    )
    assert stage.run(2) == [(1, "main"), (1, "other")]


def test_join_waits_for_a_thread():
    stage = Stage(
        """
        thread other():
            sync()
            sync()
            say("done")
        end
        t = run other()
        join t
        say("joined")
        """
    )
    assert stage.run(5) == [(2, "done"), (3, "joined")]


def test_the_end_of_the_main_thread_is_the_end_of_all():
    stage = Stage("thread other():\nhold()\nend\nt = run other()\nsync()")
    stage.run(2)
    assert stage.program.ended
    assert stage.program.failure is None
    assert stage.let_go == 1


def test_halt_ends_the_program_from_within_a_function():
    stage = Stage('def f():\nhalt\nend\nf()\nsay("never")')
    assert stage.run(1) == []
    assert stage.program.ended
    assert stage.program.failure is None


def test_stopping_from_outside_lets_go_of_everything():
    stage = Stage("hold()")
    stage.run(1)
    stage.program.stop()
    assert stage.let_go == 1
    assert stage.program.ended


def test_a_mistake_in_a_thread_ends_the_whole_program():
    stage = Stage("thread other():\nsync()\nsay(nothing)\nend\nt = run other()\nhold()")
    stage.run(3)
    assert stage.let_go == 1
    assert stage.program.failure is not None
    assert "'nothing' has no value yet" in stage.program.failure


def test_threads_cannot_be_started_without_end():
    stage = Stage(
        "thread other():\nwhile True:\nsync()\nend\nend\nwhile True:\nt = run other()\nend"
    )
    stage.run(1)
    assert stage.program.failure is not None
    assert "threads are running" in stage.program.failure
