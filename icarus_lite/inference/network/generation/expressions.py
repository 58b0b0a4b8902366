"""Tests as Python source: straight for numbers, by the language's own evaluation for the rest.

A comparison is written as the arithmetic it is. Whatever may be out of the ordinary (a symbol
where a number belongs, a result beyond every float, a division by zero) shows in the end as an
error or as an operand that is not finite, and is then left to `evaluate`, which gives the answer or
the error with its place.
"""

from __future__ import annotations

from collections.abc import Mapping

from icarus_lite.inference.network.generation.writing import Lines
from icarus_lite.language.functions import FUNCTIONS, Kind
from icarus_lite.language.syntax import Call, Constant, Expression, Variable
from icarus_lite.symbols import is_number

_COMPARISONS = ("<", "<=", ">", ">=")


def literal(value: object) -> str:
    """Write a value as Python does; a negative number in brackets."""
    text = repr(value)
    return f"({text})" if text.startswith("-") else text


def equality_source(call: Call, names: Mapping[str, str]) -> str:
    """Write a test that cannot fail: `=` or `/=` over variables and constants."""
    parts = [
        names[arg.name] if isinstance(arg, Variable) else literal(arg.value)
        for arg in call.args
        if not isinstance(arg, Call)
    ]
    if call.function == "=":
        return " == ".join(parts)
    if len(parts) == 2:
        return " != ".join(parts)
    return f"len({{{', '.join(parts)}}}) == {len(parts)}"


def write_test(
    lines: Lines, name: str, call: Call, names: Mapping[str, str], ask: str, order: tuple[str, ...]
) -> None:
    """Write a function that asks a test.

    Args:
        lines: Where to.
        name: Its name.
        call: The test.
        names: The identifier of each variable.
        ask: The identifier of the function that evaluates it by the language's own rules.
        order: The variables, in the order of the parameters.
    """
    parameters = ", ".join(names[variable] for variable in order)
    row = f"({parameters}{',' if len(order) == 1 else ''})"
    with lines.block(f"def {name}({parameters}):"):
        lines.add(f"# {call}")
        straight = _comparison(call, names)
        if straight is None:
            lines.add(f"return {ask}({row})")
        else:
            with lines.block("try:"):
                guards, answer, work = straight
                lines.add(*work)
                if guards:
                    with lines.block(f"if {' and '.join(guards)}:"):
                        lines.add(f"return {answer}")
                else:
                    lines.add(f"return {answer}")
            lines.add("except UNUSUAL:", "    pass")
            lines.add(f"return {ask}({row})")
    lines.add("")


def _comparison(call: Call, names: Mapping[str, str]) -> tuple[list[str], str, list[str]] | None:
    """Give what must be finite, the answer, and the lines that compute the operands."""
    if call.function not in _COMPARISONS or len(call.args) < 2:
        return None
    work: list[str] = []
    operands: list[str] = []
    guards: list[str] = []
    sure = False
    for number, argument in enumerate(call.args):
        source = arithmetic_source(argument, names)
        if source is None:
            return None
        if isinstance(argument, Call):
            operand = f"side_{number + 1}"
            work.append(f"{operand} = {source}")
            guards.append(f"-MOST <= {operand} <= MOST")
            source = operand
            sure = True
        elif isinstance(argument, Constant):
            sure = True
        operands.append(source)
    if not sure:
        guards.append(f"-MOST <= {operands[0]} <= MOST")
    return guards, f" {call.function} ".join(operands), work


def arithmetic_source(expression: Expression, names: Mapping[str, str]) -> str | None:
    """Write an expression over numbers; None where it is none or is left to `evaluate`."""
    if isinstance(expression, Constant):
        return literal(expression.value) if is_number(expression.value) else None
    if isinstance(expression, Variable):
        return names.get(expression.name)
    function = FUNCTIONS.get(expression.function)
    if (
        function is None
        or function.gives is not Kind.NUMBER
        or not function.accepts(len(expression.args))
    ):
        return None
    parts = []
    for argument in expression.args:
        part = arithmetic_source(argument, names)
        if part is None:
            return None
        if isinstance(argument, Call) and expression.function in ("/", "min", "max"):
            part = f"finite({part})"  # an infinity would be lost here
        parts.append(part)
    return _operation(expression.function, parts)


def _operation(function: str, parts: list[str]) -> str:
    listed = ", ".join(parts)
    if len(parts) == 2 and function in ("+", "-", "*"):
        return f"({parts[0]} {function} {parts[1]})"
    match function:
        case "+":
            text = f"sum(({listed},))"
        case "-" if len(parts) == 1:
            text = f"(-{listed})"
        case "-":
            text = f"({parts[0]} - sum(({', '.join(parts[1:])})))"
        case "*" | "/":
            text = f"({f' {function} '.join(parts)})"
        case "distance":
            half = len(parts) // 2
            one, other = (", ".join(p) for p in (parts[:half], parts[half:]))
            text = f"dist(({one},), ({other},))"
        case "min" | "max" if len(parts) == 1:
            text = parts[0]
        case _:
            text = f"{function}({listed})"
    return text
