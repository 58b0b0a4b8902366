"""Running a translated program: cooperative threads, one turn each in a control cycle."""

from __future__ import annotations

import inspect
import re
import traceback
from collections.abc import Callable, Generator, Mapping
from typing import Any, Final, TypeAlias

from runtime.controller.script_values import ScriptValue, arithmetic
from runtime.controller.tokens import ScriptError
from runtime.controller.urscript import FILE_NAME, Translation

Thread: TypeAlias = Generator[None, None, ScriptValue]
"""A running thread: each `next` is one control cycle."""

_LOOPS_A_CYCLE: Final = 20_000
_MOST_THREADS: Final = 50
_MAIN: Final = 1

_NAMED: Final = re.compile(r"'[vf]_(\w+)'")
_COMPARED: Final = re.compile(r"'(<|>|<=|>=)' not supported")

# What a program can make Python raise: mistakes of its author, not of this module.
_MISTAKES: Final = (
    ArithmeticError,
    AttributeError,
    LookupError,
    MemoryError,
    NameError,
    RecursionError,
    TypeError,
    ValueError,
)


class _Halt(Exception):  # noqa: N818 - not an error: the program asked for its end
    pass


def blocking_names(functions: Mapping[str, Callable[..., Any]]) -> frozenset[str]:
    """Give the functions that take time: those that are generators."""
    return frozenset(name for name, one in functions.items() if inspect.isgeneratorfunction(one))


class Program:
    """A program under way.

    Args:
        translation: What to run.
        functions: The closed table of built-in functions; generators take control cycles.
    """

    def __init__(
        self, translation: Translation, functions: Mapping[str, Callable[..., Any]]
    ) -> None:
        self.name: Final = translation.name
        self.ended = False
        self.failure: str | None = None
        self.current = _MAIN
        self._translation = translation
        self._functions = functions
        self._critical: int | None = None
        self._loops = 0
        self._started = _MAIN
        namespace: dict[str, Any] = {
            "__builtins__": {},
            **arithmetic(),
            "_call": self._call,
            "_wait": self._wait,
            "_run": self._run,
            "_kill": self._kill,
            "_join": self._join,
            "_tick": self._tick,
            "_halt": self._halt,
            "_enter_critical": self._enter_critical,
            "_exit_critical": self._exit_critical,
        }
        # The code defines one generator function; it can name nothing but what stands above.
        exec(translation.code, namespace)  # noqa: S102
        self._threads: dict[int, Thread] = {_MAIN: namespace["f_main"]()}

    def step(self) -> None:
        """Give each thread its turn in this control cycle; in a critical section only one."""
        self._loops = 0
        done: set[int] = set()
        while not self.ended:
            waiting = [thread for thread in self._threads if thread not in done]
            if self._critical is not None:
                waiting = [thread for thread in waiting if thread == self._critical]
            if not waiting:
                return
            done.add(waiting[0])
            self._advance(waiting[0])

    def stop(self) -> None:
        """End the program: every thread where it stands."""
        self.ended = True
        self._critical = None
        for thread in self._threads.values():
            thread.close()
        self._threads.clear()

    def _advance(self, number: int) -> None:
        self.current = number
        try:
            next(self._threads[number])
        except StopIteration:
            self._threads.pop(number, None)
            if self._critical == number:
                self._critical = None
            if number == _MAIN:
                self.stop()
        except _Halt:
            self.stop()
        except ScriptError as error:
            self._fail(error, str(error))
        except _MISTAKES as error:
            self._fail(error, _explain(error))

    def _fail(self, error: BaseException, reason: str) -> None:
        self.failure = f"line {self._line(error)} of {self.name}: {reason}"
        self.stop()

    def _line(self, error: BaseException) -> int:
        frames = traceback.walk_tb(error.__traceback__)
        found = [line for frame, line in frames if frame.f_code.co_filename == FILE_NAME]
        return self._translation.lines[found[-1]] if found else 0

    # What the translated code calls

    def _call(
        self, name: str, values: tuple[ScriptValue, ...], named: dict[str, ScriptValue]
    ) -> ScriptValue:
        function = self._functions.get(name)
        if function is None:
            raise ScriptError(f"{name}() is not supported by this stand-in controller")
        try:
            return function(*values, **named)
        except TypeError as error:
            try:
                inspect.signature(function).bind(*values, **named)
            except TypeError:
                given = ", ".join([*("…" for _ in values), *(f"{key}=…" for key in named)])
                raise ScriptError(f"{name}() cannot be called as {name}({given})") from error
            raise

    def _wait(
        self, name: str, values: tuple[ScriptValue, ...], named: dict[str, ScriptValue]
    ) -> Thread:
        result = yield from self._call(name, values, named)
        return result

    def _run(self, function: Callable[..., Thread], values: tuple[ScriptValue, ...]) -> int:
        if len(self._threads) >= _MOST_THREADS:
            raise ScriptError(f"more than {_MOST_THREADS} threads are running")
        self._started += 1
        self._threads[self._started] = function(*values)
        return self._started

    def _kill(self, number: ScriptValue) -> None:
        if number == self.current:
            raise ScriptError("a thread cannot kill itself")
        thread = self._threads.pop(number, None)
        if thread is not None:
            thread.close()

    def _join(self, number: ScriptValue) -> Thread:
        while number in self._threads and number != self.current:
            yield

    def _tick(self) -> None:
        self._loops += 1
        if self._loops > _LOOPS_A_CYCLE:
            raise ScriptError("an endless loop: it never waits, for sync() or for anything else")

    def _halt(self) -> None:
        raise _Halt

    def _enter_critical(self) -> None:
        self._critical = self.current

    def _exit_critical(self) -> None:
        self._critical = None


def _explain(error: Exception) -> str:
    """Say what a Python mistake means for the author of the program."""
    text = str(error)
    if isinstance(error, NameError) and (named := _NAMED.search(text)) is not None:
        return f"'{named[1]}' has no value yet"
    if isinstance(error, TypeError) and (compared := _COMPARED.match(text)) is not None:
        return f"these two cannot be compared with {compared[1]}"
    if isinstance(error, RecursionError):
        return "functions call each other without end"
    if isinstance(error, ZeroDivisionError):
        return "a division by zero"
    return text.replace("f_", "").replace("v_", "")
