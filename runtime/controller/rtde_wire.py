"""RTDE on the wire: framing, the data types and the recipes made of them.

Big-endian throughout. A package is a 16-bit size (its three header bytes included), one type
byte, and a payload. Source: Universal Robots, "Real-Time Data Exchange (RTDE) Guide".
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import IntEnum, StrEnum
from typing import Final, TypeAlias

Scalar: TypeAlias = float | int | bool
Value: TypeAlias = Scalar | tuple[Scalar, ...]
"""What one variable holds: a number, a truth value, or a fixed number of them."""

HEADER: Final = struct.Struct(">HB")
"""Package size and package type."""


class PackageType(IntEnum):
    """The type byte of a package: ASCII letters by design of the protocol."""

    PROTOCOL_VERSION = ord("V")
    CONTROLLER_VERSION = ord("v")
    TEXT_MESSAGE = ord("M")
    DATA = ord("U")
    SETUP_OUTPUTS = ord("O")
    SETUP_INPUTS = ord("I")
    START = ord("S")
    PAUSE = ord("P")


class DataType(StrEnum):
    """The types a variable may have, by the names the protocol uses."""

    BOOL = "BOOL"
    UINT8 = "UINT8"
    UINT32 = "UINT32"
    UINT64 = "UINT64"
    INT32 = "INT32"
    DOUBLE = "DOUBLE"
    VECTOR3D = "VECTOR3D"
    VECTOR6D = "VECTOR6D"
    VECTOR6INT32 = "VECTOR6INT32"
    VECTOR6UINT32 = "VECTOR6UINT32"


_FORMATS: Final[dict[DataType, tuple[str, int]]] = {
    DataType.BOOL: ("?", 1),
    DataType.UINT8: ("B", 1),
    DataType.UINT32: ("I", 1),
    DataType.UINT64: ("Q", 1),
    DataType.INT32: ("i", 1),
    DataType.DOUBLE: ("d", 1),
    DataType.VECTOR3D: ("d", 3),
    DataType.VECTOR6D: ("d", 6),
    DataType.VECTOR6INT32: ("i", 6),
    DataType.VECTOR6UINT32: ("I", 6),
}


class WireError(ValueError):
    """Bytes that are not what the protocol says they should be."""


@dataclass(frozen=True, slots=True)
class Recipe:
    """An agreed list of variables, packed one after the other without padding.

    Args:
        number: The recipe id that leads each data package of protocol 2; 1 to 255.
        names: The variables, in order.
        types: Their types, in the same order.
    """

    number: int
    names: tuple[str, ...]
    types: tuple[DataType, ...]
    _layout: struct.Struct = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        codes = "".join("{1}{0}".format(*_FORMATS[kind]) for kind in self.types)
        object.__setattr__(self, "_layout", struct.Struct(">" + codes))

    @property
    def size(self) -> int:
        """Bytes of the packed values, without the recipe id."""
        return self._layout.size

    def pack(self, values: Sequence[Value]) -> bytes:
        """Pack one value for each variable, in order."""
        flat: list[Scalar] = []
        for value in values:
            if isinstance(value, tuple):
                flat.extend(value)
            else:
                flat.append(value)
        return self._layout.pack(*flat)

    def unpack(self, data: bytes) -> tuple[Value, ...]:
        """Give one value for each variable, vectors as tuples.

        Raises:
            WireError: The number of bytes is not this recipe's.
        """
        if len(data) != self.size:
            raise WireError(f"recipe {self.number} has {self.size} bytes, but {len(data)} came")
        flat = self._layout.unpack(data)
        values: list[Value] = []
        at = 0
        for kind in self.types:
            count = _FORMATS[kind][1]
            values.append(flat[at] if count == 1 else tuple(flat[at : at + count]))
            at += count
        return tuple(values)


def frame(kind: PackageType, payload: bytes = b"") -> bytes:
    """Put the header before a payload."""
    return HEADER.pack(HEADER.size + len(payload), kind) + payload


def take_packages(buffer: bytearray) -> Iterator[tuple[int, bytes]]:
    """Remove each complete package from the front of a buffer and give its type and payload.

    Raises:
        WireError: The size field cannot be right; the stream is beyond recovery.
    """
    while len(buffer) >= HEADER.size:
        size, kind = HEADER.unpack_from(buffer)
        if size < HEADER.size:
            raise WireError(f"a package of {size} bytes is shorter than its own header")
        if len(buffer) < size:
            return
        payload = bytes(buffer[HEADER.size : size])
        del buffer[:size]
        yield kind, payload
