"""The `__init__` of a data class: the one that works at once, and the one that is compiled."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from types import FunctionType, MemberDescriptorType

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, Final

    from icarus_lite.records.late import Field


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
    _required(fields)
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
    template = _template(shape, frozen=frozen, then=hasattr(cls, "__post_init__"))(**known)
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


def uncompiled_init(cls: Any, *, frozen: bool) -> Callable[..., None]:
    """Give an `__init__` that does the same more slowly, for the first few instances.

    Most classes never have more than a few, and compiling costs as much as sixty of them.
    """
    fields: dict[str, Field] = cls.__late_fields__
    assigned = [
        (_setter(cls, name) if frozen else _setter_of(name), name, each)
        for name, each in fields.items()
        if each.init or each.default_factory is not MISSING or each.default is not MISSING
    ]
    order: tuple[str, ...] = cls.__match_args__
    puts = tuple([put for put, _, _ in assigned])
    is_plain = tuple([name for _, name, _ in assigned]) == order
    required = _required(fields)
    then = getattr(cls, "__post_init__", None)

    def __init__(instance: Any, *given: Any, **named: Any) -> None:  # noqa: N807 - stands for it
        if is_plain and not named and len(given) == len(order):
            for put, value in zip(puts, given):  # noqa: B905 - as many as there are
                put(instance, value)
            if then is not None:
                then(instance)
            return
        values = dict(zip(order, given))  # noqa: B905 - the next lines look at the lengths
        if (
            len(given) > len(order)
            or not values.keys().isdisjoint(named)
            or not named.keys() <= set(order)
            or not required <= values.keys() | named.keys()
        ):
            compiled = init_of_frozen(cls) if frozen else init_of(cls)
            compiled(instance, *given, **named)  # which says what is wrong
            return
        values |= named
        for put, name, each in assigned:
            value = values.get(name, each.default)
            if value is MISSING and each.default_factory is not MISSING:
                value = each.default_factory()
            put(instance, value)
        if then is not None:
            then(instance)

    return __init__


def _required(fields: Mapping[str, Field]) -> frozenset[str]:
    """Give the fields that must be given.

    Raises:
        TypeError: one of them follows one with a default.
    """
    required = []
    defaults = False
    for name, each in fields.items():
        if each.init and each.default is MISSING and each.default_factory is MISSING:
            if defaults:
                raise TypeError(f"non-default argument {name!r} follows default argument")
            required.append(name)
        elif each.init:
            defaults = True
    return frozenset(required)


def _setter_of(name: str) -> Callable[[Any, Any], None]:
    return lambda instance, value: setattr(instance, name, value)


def _setter(cls: Any, name: str) -> Callable[[Any, Any], None]:
    """Give the fastest way around `__setattr__`: a slot's own descriptor, if there is one."""
    found = cls.__dict__.get(name)
    if isinstance(found, MemberDescriptorType):
        return found.__set__
    return lambda instance, value: object.__setattr__(instance, name, value)


_TEMPLATES: dict[tuple[str, bool, bool], Callable[..., FunctionType]] = {}


def _template(shape: str, *, frozen: bool, then: bool) -> Callable[..., FunctionType]:
    """Give what all `__init__` of a shape have in common; it is compiled once."""
    found = _TEMPLATES.get((shape, frozen, then))
    if found is None:
        found = _TEMPLATES[shape, frozen, then] = _compiled(shape, frozen=frozen, then=then)
    return found


def _compiled(shape: str, *, frozen: bool, then: bool) -> Callable[..., FunctionType]:
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
