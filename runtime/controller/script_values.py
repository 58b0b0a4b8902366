"""What a running URScript program computes with: numbers, truth values, text, lists and poses.

Every operation checks its operands, so that no program can build a value larger than itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeAlias

from runtime.controller.tokens import ScriptError
from runtime.kinematics import Joints, Pose

ScriptValue: TypeAlias = Any  # int, float, bool, str, None, list of these, or ScriptPose
"""A value of the program. Lists are copied on assignment, so two names never share one."""

_INTEGER_LIMIT: Final = 1 << 31
_BEYOND_ANY_ARM: Final = 1e9  # in any unit; what is squared later must not overflow


class ScriptPose(list[float]):
    """A pose literal's value: position in m and rotation vector in rad, told from a joint list."""

    __slots__ = ()


def make_pose(*elements: ScriptValue) -> ScriptPose:
    """Make a pose of six numbers. Raises ScriptError for anything else."""
    return ScriptPose(number(element) for element in elements)


def make_list(*elements: ScriptValue) -> list[ScriptValue]:
    """Make a list; its elements may be lists of plain values, as in a matrix, but no deeper."""
    for element in elements:
        if isinstance(element, list) and any(isinstance(inner, list) for inner in element):
            raise ScriptError("a list nested more than two deep is not supported")
    return [copy(element) for element in elements]


def copy(value: ScriptValue) -> ScriptValue:
    """Copy a value for an assignment or an argument: URScript passes lists by value."""
    if not isinstance(value, list):
        return value
    if isinstance(value, ScriptPose):
        return ScriptPose(value)
    return [list(element) if isinstance(element, list) else element for element in value]


def item(value: ScriptValue, index: ScriptValue) -> ScriptValue:
    """Read one element of a list or pose. Raises ScriptError outside of it."""
    return value[_checked_index(value, index)]


def store(value: ScriptValue, index: ScriptValue, element: ScriptValue) -> None:
    """Replace one element of a list or pose by a plain value. Raises ScriptError outside of it."""
    if isinstance(element, list):
        raise ScriptError("an element of a list can be replaced by a plain value only")
    value[_checked_index(value, index)] = element


def number(value: ScriptValue) -> float:
    """Give a value that is an int or float. Raises ScriptError for anything else."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ScriptError(f"a number is expected here, not {_describe(value)}")
    return value


def finite(value: ScriptValue, what: str) -> float:
    """Give a number an arm can be asked about at all. Raises ScriptError otherwise."""
    given = float(number(value))
    if not -_BEYOND_ANY_ARM < given < _BEYOND_ANY_ARM:  # not a number included
        raise ScriptError(f"{what} is {given:g}, which is beyond any arm")
    return given


def joints(value: ScriptValue, what: str = "the joint list") -> Joints:
    """Give six finite numbers, rad or rad/s. Raises ScriptError for anything else."""
    q1, q2, q3, q4, q5, q6 = _six(value, what)
    return q1, q2, q3, q4, q5, q6


def pose(value: ScriptValue, what: str = "the pose") -> Pose:
    """Give six finite numbers, m and rad. Raises ScriptError for anything else."""
    x, y, z, rx, ry, rz = _six(value, what)
    return x, y, z, rx, ry, rz


def arithmetic() -> dict[str, Callable[..., ScriptValue]]:
    """Give the operators by the names the translator writes them with."""
    return {
        "_add": lambda a, b: _bounded(number(a) + number(b)),
        "_subtract": lambda a, b: _bounded(number(a) - number(b)),
        "_multiply": lambda a, b: _bounded(number(a) * number(b)),
        "_divide": lambda a, b: number(a) / number(b),
        "_modulo": lambda a, b: (
            math.fmod(number(a), number(b))
            if isinstance(a, float) or isinstance(b, float)
            else int(math.fmod(a, b))
        ),
        # Through floats, so that a tower of powers cannot grow an endless integer.
        "_power": lambda a, b: math.pow(number(a), number(b)),
        "_negate": lambda a: _bounded(-number(a)),
        "_pose": make_pose,
        "_list": make_list,
        "_copy": copy,
        "_item": item,
        "_store": store,
        "_bool": bool,
    }


def _six(value: ScriptValue, what: str) -> Sequence[float]:
    if not isinstance(value, list) or len(value) != 6:
        raise ScriptError(f"{what} must have six numbers, not {_describe(value)}")
    return [finite(element, what) for element in value]


def _checked_index(value: ScriptValue, index: ScriptValue) -> int:
    if not isinstance(value, list):
        raise ScriptError(f"{_describe(value)} has no elements")
    if isinstance(index, bool) or not isinstance(index, int):
        raise ScriptError(f"an index must be an integer, not {_describe(index)}")
    if not 0 <= index < len(value):
        raise ScriptError(f"index {index} is outside a list of {len(value)}")
    return index


def _bounded(result: float) -> float:
    if isinstance(result, int) and not -_INTEGER_LIMIT <= result < _INTEGER_LIMIT:
        raise ScriptError(f"{result} does not fit a 32-bit integer")
    return result


def _describe(value: ScriptValue) -> str:
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if value is None:
        return "nothing"
    return f"{value!r}"
