"""Translating URScript into Python generators.

Each `def` and `thread` becomes a generator function; a `yield` inside means "until the next
control cycle". Variables get the prefix `v_` and functions `f_`, every operator goes through a
checked helper, and there is no attribute access, so that a program reaches the closed table of
functions it is given and nothing else.

A name assigned with `global` anywhere is global everywhere, unless it is a parameter; every other
name is local to the function that assigns it.

Source: Universal Robots, "The URScript Programming Language".
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field
from types import CodeType
from typing import Final

from runtime.controller.expressions import ExpressionReader
from runtime.controller.tokens import ScriptError, Token, tokenise

FILE_NAME: Final = "<urscript>"
"""The file name of translated code, by which its lines are found in a traceback."""


@dataclass(frozen=True, slots=True)
class Translation:
    """A program as Python code.

    Args:
        name: The program's name, or "unnamed" for bare statements.
        code: Compiled; executing it defines the generator function `f_main`.
        lines: For each line of the Python text, from 1, the URScript line it came from.
    """

    name: str
    code: CodeType
    lines: tuple[int, ...]


def translate(text: str, blocking: frozenset[str]) -> Translation:
    """Translate a program: one top-level `def`, or bare statements.

    Args:
        text: URScript, with all version markers already resolved.
        blocking: The built-in functions that take time and must be waited for.

    Raises:
        ScriptError: The text is no program; it says what was found where.
    """
    tokens = tokenise(text)
    translator = _Translator(tokens, blocking)
    name, lines = translator.program()
    source = "\n".join(line for _, line in lines)
    try:
        code = compile(source, FILE_NAME, "exec", dont_inherit=True)
    except (SyntaxError, RecursionError, MemoryError, ValueError) as error:
        raise ScriptError(f"the program is too large or too deeply nested ({error})") from error
    return Translation(name, code, (0, *(line for line, _ in lines)))


@dataclass(slots=True)
class _Function:
    """A function being translated."""

    parameters: frozenset[str]
    depth: int
    assigned: set[str] = field(default_factory=set)
    lines: list[tuple[int, str]] = field(default_factory=list)


class _Translator(ExpressionReader):
    """A recursive-descent parser of statements that writes Python as it reads."""

    def __init__(self, tokens: list[Token], blocking: frozenset[str]) -> None:
        super().__init__(tokens, blocking)
        pairs = itertools.pairwise(tokens)
        self._globals = {b.text for a, b in pairs if a.text == "global"}
        self._function = _Function(frozenset(), 0)

    def program(self) -> tuple[str, list[tuple[int, str]]]:
        self._skip_newlines()
        if self._next.text == "def":
            name = self._tokens[self._at + 1].text
            self._define(1)
            self._skip_newlines()
            if self._next.kind != "end of text":
                self._fail("the program goes on after its end")
            lines = [(line, f"    {text}") for line, text in self._function.lines]
            return name, [(1, "def f_main():"), *lines, (1, f"    yield from f_{name}()")]
        function = self._function = _Function(frozenset(), 1)
        while self._next.kind != "end of text":
            self._statement(1)
            self._skip_newlines()
        return "unnamed", [(1, "def f_main():"), *self._body_lines(function, 1)]

    # Statements

    def _define(self, depth: int) -> None:
        start = self._take()
        name = self._take_kind("name").text
        self._expect("(")
        parameters: list[str] = []
        while self._next.text != ")":
            parameters.append(self._take_kind("name").text)
            if self._next.text != ")":
                self._expect(",")
        self._expect(")")
        self._expect(":")
        outer = self._function
        inner = self._function = _Function(frozenset(parameters), depth)
        self._block(depth)
        self._function = outer
        listed = ", ".join(f"v_{parameter}" for parameter in parameters)
        pad = "    " * (depth - 1)
        outer.lines.append((start.line, f"{pad}def f_{name}({listed}):"))
        outer.lines.extend(self._body_lines(inner, depth))

    def _body_lines(self, function: _Function, depth: int) -> list[tuple[int, str]]:
        pad = "    " * depth
        shared = sorted((function.assigned & self._globals) - function.parameters)
        head = [(0, pad + "yield from ()")]  # a generator even if nothing in it waits
        if shared:
            head.insert(0, (0, pad + "global " + ", ".join(f"v_{name}" for name in shared)))
        return head + function.lines

    def _block(self, depth: int, *stops: str) -> bool:
        """Translate statements up to and including `end`, or up to one of `stops`.

        Returns:
            Whether it ended with `end`.
        """
        self._deepen()
        before = len(self._function.lines)
        self._skip_newlines()
        while self._next.text != "end" and self._next.text not in stops:
            if self._next.kind == "end of text":
                self._fail("an `end` is missing")
            self._statement(depth)
            self._skip_newlines()
        if len(self._function.lines) == before:
            self._emit(depth, "pass")
        self._nesting -= 1
        if self._next.text != "end":
            return False
        self._take()
        return True

    def _statement(self, depth: int) -> None:
        token = self._next
        if token.kind == "keyword":
            self._keyword_statement(token, depth)
        elif token.kind == "name" and self._assignment(depth):
            pass
        else:
            expression = self._expression()
            self._emit(depth, expression, token.line)

    def _keyword_statement(self, token: Token, depth: int) -> None:  # noqa: C901 - one case each
        match token.text:
            case "def" | "thread":
                self._define(depth + 1)
            case "if":
                self._if(depth)
            case "while":
                self._take()
                condition = self._expression()
                self._expect(":")
                self._emit(depth, f"while {condition}:", token.line)
                self._emit(depth + 1, "_tick()", token.line)
                self._block(depth + 1)
            case "return":
                self._take()
                bare = self._next.kind in ("newline", "end of text") or self._next.text == "end"
                self._emit(depth, "return " + ("None" if bare else self._expression()), token.line)
            case "break" | "continue":
                self._take()
                self._emit(depth, token.text, token.line)
            case "halt" | "enter_critical" | "exit_critical":
                self._take()
                self._emit(depth, f"_{token.text}()", token.line)
            case "kill":
                self._take()
                self._emit(depth, f"_kill({self._expression()})", token.line)
            case "join":
                self._take()
                self._emit(depth, f"(yield from _join({self._expression()}))", token.line)
            case "global" | "local":
                self._take()
                if not self._assignment(depth):
                    self._fail(f"a variable to assign is expected after `{token.text}`")
            case "sec":
                self._fail("secondary programs are not supported by this stand-in controller")
            case _:
                self._emit(depth, self._expression(), token.line)

    def _if(self, depth: int) -> None:
        word = "if"
        while True:
            token = self._take()
            head = "else:" if word == "else" else f"{word} {self._expression()}:"
            self._expect(":")
            self._emit(depth, head, token.line)
            stops = () if word == "else" else ("elif", "else")
            if self._block(depth + 1, *stops):
                return
            word = self._next.text

    def _assignment(self, depth: int) -> bool:
        """Translate `name = …` or `name[i] = …`; go back to the start if it is neither."""
        start, name = self._at, self._take()
        if name.kind != "name":
            self._at = start
            return False
        indices: list[str] = []
        if self._next.text == "[":
            indices = self._bracketed()
        if self._next.text != "=":
            self._at = start
            return False
        self._take()
        value = self._expression()
        if not indices:
            self._function.assigned.add(name.text)
            self._emit(depth, f"v_{name.text} = _copy({value})", name.line)
            return True
        target = f"v_{name.text}"
        for index in indices[:-1]:
            target = f"_item({target}, {index})"
        self._emit(depth, f"_store({target}, {indices[-1]}, {value})", name.line)
        return True

    def _emit(self, depth: int, text: str, line: int = 0) -> None:
        self._function.lines.append((line, "    " * depth + text))
