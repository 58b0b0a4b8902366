"""The `__init__` of a data class, written when it is first asked for."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import cache
from types import FunctionType, MemberDescriptorType

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Final


class _Missing:
    """What stands where nothing is given."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "<made anew>"


MISSING: Final = _Missing()
"""The default of a field that has none, or whose default is made anew each time."""


def init_of(cls: Any) -> FunctionType:
    """Give the `__init__` of a class whose fields may be set."""
    return _init(cls, frozen=False)


def init_of_frozen(cls: Any) -> FunctionType:
    """Give the `__init__` of a class whose fields may not be set."""
    return _init(cls, frozen=True)


def _init(cls: Any, *, frozen: bool) -> FunctionType:
    """Give the code of a class's shape, with its own names."""
    fields, names, defaults, known = cls.__late_fields__, {"self": "self"}, [], {}
    shape = ""
    for name, each in fields.items():
        made = each.default_factory is not MISSING
        if not each.init and not made and each.default is MISSING:
            continue
        index = len(shape)
        shape += ("+" if made else "=") if each.init else ("*" if made else "-")
        names[f"_{index}"] = name
        if made:
            known[f"_new_{index}"] = each.default_factory
        elif not each.init:
            known[f"_new_{index}"] = each.default
        if frozen:
            known[f"_set_{index}"] = _setter(cls, name)
        if each.init and (made or each.default is not MISSING):
            defaults.append(each.default)
        elif each.init and defaults:
            raise TypeError(f"non-default argument {name!r} follows default argument")
    template = _template(shape, frozen, hasattr(cls, "__post_init__"))(**known)
    code = template.__code__
    init = FunctionType(
        code.replace(
            co_qualname=f"{cls.__qualname__}.__init__",
            co_varnames=tuple([names.get(each, each) for each in code.co_varnames]),
            co_names=tuple([names.get(each, each) for each in code.co_names]),
        ),
        sys.modules[cls.__module__].__dict__,
        "__init__",
        tuple(defaults),
        template.__closure__,
    )
    init.__annotations__ = {
        **{name: fields[name].annotation for name in cls.__match_args__},
        "return": None,
    }
    return init


def _setter(cls: Any, name: str) -> Callable[[Any, Any], None]:
    """Give the fastest way around `__setattr__`: a slot's own descriptor, if there is one."""
    found = cls.__dict__.get(name)
    if isinstance(found, MemberDescriptorType):
        return found.__set__
    return lambda instance, value: object.__setattr__(instance, name, value)


@cache
def _template(shape: str, frozen: bool, then: bool) -> Callable[..., FunctionType]:  # noqa: FBT001 - a key
    """Compile what all `__init__` of a shape have in common; compiling takes longest.

    Args:
        shape: For each field: = it is given, + given or made anew, * made anew, - always the same.
        frozen: Whether fields are set by `_set_0`, ..., not as attributes.
        then: Whether `__post_init__` follows.
    """
    body, known = [], []
    for index, kind in enumerate(shape):
        value = {
            "=": f"_{index}",
            "+": f"_new_{index}() if _{index} is MISSING else _{index}",
            "*": f"_new_{index}()",
            "-": f"_new_{index}",
        }[kind]
        body.append(f"_set_{index}(self, {value})" if frozen else f"self._{index} = {value}")
        known += [f"_new_{index}"] if kind != "=" else []
        known += [f"_set_{index}"] if frozen else []
    body += ["self.__post_init__()"] if then else []
    given = [f"_{index}" for index, kind in enumerate(shape) if kind in "=+"]
    text = (
        f"def make({', '.join([*known, 'MISSING=MISSING'])}):\n"
        f" def __init__({', '.join(['self', *given])}):\n  "
        + "\n  ".join(body or ["pass"])
        + "\n return __init__"
    )
    made: dict[str, Any] = {"MISSING": MISSING}
    exec(text, made)  # noqa: S102 - as `dataclasses` does
    template: Callable[..., FunctionType] = made["make"]
    return template
