"""Translating URScript expressions: the lower half of the translator.

Every operator becomes a call of a checked helper, every function call a call of one of the
program's own generators or a look-up in the closed table of built-in functions.
"""

from __future__ import annotations

import itertools
import math
from typing import Final

from runtime.controller.tokens import ScriptError, Token

_DEEPEST: Final = 40  # nesting; Python's own compiler would refuse a little later, less clearly

_COMPARISONS: Final = frozenset(("==", "!=", "<", ">", "<=", ">="))
_ADDITIVE: Final = {"+": "_add", "-": "_subtract"}
_MULTIPLICATIVE: Final = {"*": "_multiply", "/": "_divide", "%": "_modulo"}


class ExpressionReader:
    """A recursive-descent parser of expressions that gives each as Python text.

    Args:
        tokens: The whole program.
        blocking: The built-in functions that take time and must be waited for.
    """

    def __init__(self, tokens: list[Token], blocking: frozenset[str]) -> None:
        self._tokens = tokens
        self._at = 0
        self._blocking = blocking
        self._nesting = 0
        pairs = itertools.pairwise(tokens)
        self._functions = {b.text for a, b in pairs if a.text in ("def", "thread")}

    def _expression(self) -> str:
        # A comment may stand between `=` and its value: the value is then on the next line.
        self._skip_newlines()
        self._deepen()
        left = self._conjunction()
        while self._next.text in ("or", "xor"):
            word = self._take().text
            right = self._conjunction()
            operator = "or" if word == "or" else "!="
            left = f"(_bool({left}) {operator} _bool({right}))"
        self._nesting -= 1
        return left

    def _conjunction(self) -> str:
        left = self._negation()
        while self._next.text == "and":
            self._take()
            left = f"(_bool({left}) and _bool({self._negation()}))"
        return left

    def _negation(self) -> str:
        if self._next.text == "not":
            self._take()
            self._deepen()
            negated = f"(not {self._negation()})"
            self._nesting -= 1
            return negated
        left = self._sum()
        while self._next.text in _COMPARISONS:
            sign = self._take().text
            left = f"({left} {sign} {self._sum()})"
        return left

    def _sum(self) -> str:
        left = self._product()
        while self._next.text in _ADDITIVE:
            helper = _ADDITIVE[self._take().text]
            left = f"{helper}({left}, {self._product()})"
        return left

    def _product(self) -> str:
        left = self._factor()
        while self._next.text in _MULTIPLICATIVE:
            helper = _MULTIPLICATIVE[self._take().text]
            left = f"{helper}({left}, {self._factor()})"
        return left

    def _factor(self) -> str:
        if self._next.text in ("-", "+"):
            sign = self._take().text
            self._deepen()
            operand = self._factor()
            self._nesting -= 1
            return f"_negate({operand})" if sign == "-" else operand
        base = self._operand()
        while self._next.text == "[":
            for index in self._bracketed():
                base = f"_item({base}, {index})"
        if self._next.text == "^":
            self._take()
            self._deepen()
            base = f"_power({base}, {self._factor()})"
            self._nesting -= 1
        return base

    def _operand(self) -> str:  # noqa: C901, PLR0911 - one case for each kind of operand
        token = self._take()
        match token.kind, token.text:
            case "number", text:
                return _literal(text)
            case "string", text:
                return repr(text[1:-1])
            case "keyword", ("True" | "False") as text:
                return text
            case "keyword", "run":
                return self._run()
            case "sign", "(":
                inner = self._expression()
                self._expect(")")
                return f"({inner})"
            case "sign", "[":
                self._at -= 1
                return f"_list({', '.join(self._bracketed())})"
            case "name", "p" if self._next.text == "[":
                elements = self._bracketed()
                if len(elements) == 6:
                    return f"_pose({', '.join(elements)})"
                indexed = "v_p"
                for index in elements:
                    indexed = f"_item({indexed}, {index})"
                return indexed
            case "name", name:
                return self._call(token) if self._next.text == "(" else f"v_{name}"
            case _:
                self._at -= 1
                return self._fail("a value is expected")

    def _run(self) -> str:
        name = self._take_kind("name")
        if name.text not in self._functions:
            raise ScriptError(f"line {name.line}: there is no thread '{name.text}' to run")
        values, named = self._arguments()
        if named:
            raise ScriptError(f"line {name.line}: a thread takes no named arguments")
        return f"_run(f_{name.text}, ({''.join(f'{v}, ' for v in values)}))"

    def _call(self, name: Token) -> str:
        values, named = self._arguments()
        if name.text in self._functions:
            copies = [f"_copy({value})" for value in values]
            copies += [f"v_{key}=_copy({value})" for key, value in named]
            return f"(yield from f_{name.text}({', '.join(copies)}))"
        positional = "".join(f"{value}, " for value in values)
        keywords = ", ".join(f"{key!r}: {value}" for key, value in named)
        call = f"({name.text!r}, ({positional}), {{{keywords}}})"
        return f"(yield from _wait{call})" if name.text in self._blocking else f"_call{call}"

    def _arguments(self) -> tuple[list[str], list[tuple[str, str]]]:
        self._expect("(")
        values: list[str] = []
        named: list[tuple[str, str]] = []
        while self._next.text != ")":
            if self._next.kind == "name" and self._tokens[self._at + 1].text == "=":
                key = self._take().text
                self._take()
                named.append((key, self._expression()))
            elif named:
                self._fail("a positional argument cannot follow a named one")
            else:
                values.append(self._expression())
            if self._next.text != ")":
                self._expect(",")
        self._expect(")")
        return values, named

    def _bracketed(self) -> list[str]:
        self._expect("[")
        elements: list[str] = []
        while self._next.text != "]":
            elements.append(self._expression())
            if self._next.text != "]":
                self._expect(",")
        self._expect("]")
        return elements

    # Tokens

    @property
    def _next(self) -> Token:
        return self._tokens[self._at]

    def _take(self) -> Token:
        token = self._tokens[self._at]
        if token.kind != "end of text":
            self._at += 1
        return token

    def _take_kind(self, kind: str) -> Token:
        if self._next.kind != kind:
            self._fail(f"a {kind} is expected")
        return self._take()

    def _expect(self, text: str) -> None:
        if self._next.text != text or self._next.kind == "string":
            self._fail(f"`{text}` is expected")
        self._take()

    def _skip_newlines(self) -> None:
        while self._next.kind == "newline":
            self._at += 1

    def _deepen(self) -> None:
        self._nesting += 1
        if self._nesting > _DEEPEST:
            raise ScriptError(f"line {self._next.line}: nested more than {_DEEPEST} deep")

    def _fail(self, what: str) -> str:
        found = "the end of the line" if self._next.kind == "newline" else repr(self._next.text)
        if self._next.kind == "end of text":
            found = "the end of the program"
        raise ScriptError(f"line {self._next.line}: {what}, not {found}")


def _literal(text: str) -> str:
    """Write a number so that Python reads it the same: octal-looking and huge ones included."""
    if text.isdigit() and len(text) <= 10 and int(text) < 1 << 31:
        return str(int(text))
    value = float(text)
    if math.isinf(value):
        raise ScriptError(f"the number {text[:20]} is too large")
    return repr(value)
