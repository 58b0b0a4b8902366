"""Data classes whose `__init__` is compiled only where many instances are made.

What `dataclasses.dataclass` does at once is done in two parts here. Slots, equality, hash, order of
the fields: at once, by functions that all classes share. The `__init__`, which has to be compiled,
and what `dataclasses` itself asks for (`__dataclass_fields__`): when somebody asks.

Of the options there are those that this package makes use of: `frozen`, `slots` and `eq` of a
class; `default`, `default_factory`, `init`, `compare` and `repr` of a field.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from operator import attrgetter
from reprlib import recursive_repr
from types import MethodType

from icarus_lite.records.writing import MISSING, init_of, init_of_frozen, uncompiled_init

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, TypeVar

    _T = TypeVar("_T")


class Field:
    """What `field` tells of a field."""

    __slots__ = ("annotation", "compare", "default", "default_factory", "init", "repr")

    def __init__(
        self,
        default: Any = MISSING,
        default_factory: Any = MISSING,
        *,
        init: bool = True,
        compare: bool = True,
        repr: bool = True,  # noqa: A002 - as in `dataclasses`
    ) -> None:
        self.annotation: Any = None
        self.default = default
        self.default_factory = default_factory
        self.init = init
        self.compare = compare
        self.repr = repr

    @property
    def options(self) -> dict[str, Any]:
        """All that `dataclasses.field` is told of it."""
        told = {"default": self.default, "default_factory": self.default_factory}
        given = {key: value for key, value in told.items() if value is not MISSING}
        return {**given, "init": self.init, "compare": self.compare, "repr": self.repr}


def field(
    *,
    default: Any = MISSING,
    default_factory: Any = MISSING,
    init: bool = True,
    compare: bool = True,
    repr: bool = True,  # noqa: A002 - as in `dataclasses`
) -> Any:
    """Tell more of a field than its default; see `dataclasses.field`."""
    if default is not MISSING and default_factory is not MISSING:
        raise ValueError("cannot specify both default and default_factory")
    return Field(default, default_factory, init=init, compare=compare, repr=repr)


def dataclass(
    cls: Any = None, /, *, frozen: bool = False, slots: bool = False, eq: bool = True
) -> Any:
    """Make a data class; see `dataclasses.dataclass`."""
    if cls is None:
        return lambda cls: _made(cls, frozen, slots, eq)
    return _made(cls, frozen, slots, eq)


def replace(instance: _T, /, **changes: Any) -> _T:
    """Give an instance like this one but for some fields; see `dataclasses.replace`."""
    cls: Any = type(instance)
    for name in cls.__match_args__:
        if name not in changes:
            changes[name] = getattr(instance, name)
    made: _T = cls(**changes)
    return made


class _Standard:
    """An attribute of a class as the standard library would have made it, once somebody asks."""

    __slots__ = ("_name",)

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, instance: Any, owner: Any = None) -> Any:
        import dataclasses  # noqa: PLC0415 - costs more than all of this

        cls = next(each for each in owner.__mro__ if "__late_options__" in each.__dict__)
        frozen, eq = cls.__late_options__
        members: dict[str, Any] = {"__annotations__": {}, "__module__": cls.__module__}
        for name, each in cls.__late_fields__.items():
            members["__annotations__"][name] = each.annotation
            members[name] = dataclasses.field(**each.options)
        standard: Any = dataclasses.dataclass(frozen=frozen, eq=eq)(type(cls.__name__, (), members))
        made = getattr(standard, self._name)
        setattr(cls, self._name, made)
        return made


_FIELDS, _PARAMS = _Standard("__dataclass_fields__"), _Standard("__dataclass_params__")

_UNCOMPILED = 32
"""How many instances of a class are made before its `__init__` is compiled."""


class _LateInit:
    """An `__init__` that is compiled when many instances are made, or somebody looks at it."""

    __slots__ = ("_frozen", "_left", "_owner", "_uncompiled")

    def __init__(self, *, frozen: bool) -> None:
        self._frozen, self._left = frozen, _UNCOMPILED
        self._uncompiled: Callable[..., None] | None = None

    def __set_name__(self, owner: Any, name: str) -> None:
        self._owner = owner

    def __get__(self, instance: Any, owner: Any = None) -> Any:
        if instance is None or not self._left:
            compiled = init_of_frozen(self._owner) if self._frozen else init_of(self._owner)
            self._owner.__init__ = compiled
            return compiled if instance is None else MethodType(compiled, instance)
        self._left -= 1
        if self._uncompiled is None:
            self._uncompiled = uncompiled_init(self._owner, frozen=self._frozen)
        return MethodType(self._uncompiled, instance)


def _made(cls: Any, frozen: bool, slots: bool, eq: bool) -> Any:  # noqa: FBT001 - as they came
    fields: dict[str, Field] = {}
    for base in cls.__mro__[-1:0:-1]:
        fields.update(base.__dict__.get("__late_fields__", {}))
    own = _own_fields(cls)
    fields.update(own)
    added = _added(cls, fields, frozen=frozen, slots=slots, eq=eq)
    made = (_with_slots if slots else _without_slots)(cls, own, added)
    if frozen:
        _freeze(made, frozenset(fields))
    return made


def _added(
    cls: Any, fields: dict[str, Field], *, frozen: bool, slots: bool, eq: bool
) -> dict[str, Any]:
    """Give what a class gets besides what is written in it."""
    own = cls.__dict__
    methods: dict[str, Any] = {
        "__init__": _LateInit(frozen=frozen),
        "__repr__": _representation,
    }
    if eq:
        methods["__eq__"] = _equality(key := _key(fields))
        # Python sets `__hash__` to None in a class that defines `__eq__` alone.
        if own.get("__hash__") is None:
            methods["__hash__"] = _hash(key) if frozen else None
    if frozen and slots:
        methods["__getstate__"], methods["__setstate__"] = _state_of, _set_state
    added = {
        name: method
        for name, method in methods.items()
        if name not in own or (name == "__hash__" and "__eq__" in own)
    }
    added["__late_fields__"] = fields
    added["__late_options__"] = (frozen, eq)
    added["__match_args__"] = tuple([name for name, each in fields.items() if each.init])
    added["__dataclass_fields__"], added["__dataclass_params__"] = _FIELDS, _PARAMS
    return added


def _with_slots(cls: Any, own: Iterable[str], added: Mapping[str, Any]) -> Any:
    """Make a class anew, for slots cannot be added to one."""
    left_out = {*own, "__dict__", "__weakref__"}
    members = {name: each for name, each in cls.__dict__.items() if name not in left_out}
    inherited = {slot for base in cls.__mro__[1:-1] for slot in _slots(base)}
    members["__slots__"] = tuple([n for n in added["__late_fields__"] if n not in inherited])
    members.update(added)
    made = type(cls)(cls.__name__, cls.__bases__, members)
    made.__qualname__ = cls.__qualname__
    return made


def _without_slots(cls: Any, own: Mapping[str, Field], added: Mapping[str, Any]) -> Any:
    """Add to a class; its instances find their defaults in it."""
    for name, each in own.items():
        if each.default is not MISSING:
            setattr(cls, name, each.default)
        elif isinstance(cls.__dict__.get(name), Field):
            delattr(cls, name)
    for name, method in added.items():
        setattr(cls, name, method)
        if isinstance(method, _LateInit):
            method.__set_name__(cls, name)
    return cls


def _own_fields(cls: Any) -> dict[str, Field]:
    """Give the fields that a class adds, by name."""
    fields = {}
    for name, annotation in cls.__dict__.get("__annotations__", {}).items():  # noqa: RUF063 - `inspect` costs more
        if str(annotation).startswith(("ClassVar", "typing.ClassVar")):
            continue
        default = cls.__dict__.get(name, MISSING)
        each = default if isinstance(default, Field) else Field(default)
        if each.default.__class__.__hash__ is None:
            raise ValueError(
                f"mutable default {type(each.default)} for field {name} is not allowed: "
                "use default_factory"
            )
        each.annotation = annotation
        fields[name] = each
    return fields


def _slots(base: Any) -> Iterable[str]:
    slots = base.__dict__.get("__slots__", ())
    return (slots,) if isinstance(slots, str) else slots


def _freeze(cls: Any, names: frozenset[str]) -> None:
    def __setattr__(self: Any, name: str, value: Any) -> None:  # noqa: N807 - becomes a method
        if type(self) is cls or name in names:
            _refuse("assign to", name)
        super(cls, self).__setattr__(name, value)

    def __delattr__(self: Any, name: str) -> None:  # noqa: N807 - becomes a method
        if type(self) is cls or name in names:
            _refuse("delete", name)
        super(cls, self).__delattr__(name)

    cls.__setattr__, cls.__delattr__ = __setattr__, __delattr__


def _refuse(what: str, name: str) -> None:
    from dataclasses import FrozenInstanceError  # noqa: PLC0415 - costs more than all of this

    raise FrozenInstanceError(f"cannot {what} field {name!r}")


def _key(fields: Mapping[str, Field]) -> Callable[[Any], tuple[Any, ...]]:
    """Give what makes a tuple of the fields that are compared."""
    names = [name for name, each in fields.items() if each.compare]
    if not names:
        return lambda _instance: ()
    get: Callable[[Any], Any] = attrgetter(*names)
    return get if len(names) > 1 else lambda instance: (get(instance),)


def _equality(key: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any, Any], Any]:
    def __eq__(self: Any, other: Any) -> Any:  # noqa: N807 - becomes a method
        if other.__class__ is self.__class__:
            return key(self) == key(other)
        return NotImplemented

    return __eq__


def _hash(key: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any], int]:
    def __hash__(self: Any) -> int:  # noqa: N807 - becomes a method
        return hash(key(self))

    return __hash__


@recursive_repr("...")
def _representation(self: Any) -> str:
    names = [name for name, each in self.__late_fields__.items() if each.repr]
    shown = ", ".join([f"{name}={getattr(self, name)!r}" for name in names])
    return f"{self.__class__.__qualname__}({shown})"


def _state_of(self: Any) -> list[Any]:
    return [getattr(self, name) for name in self.__late_fields__]


def _set_state(self: Any, state: list[Any]) -> None:
    for name, value in zip(self.__late_fields__, state, strict=True):
        object.__setattr__(self, name, value)
