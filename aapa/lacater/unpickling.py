"""Reads pickles of numpy arrays in plain containers, and nothing else.

A pickle is a program: loaded naively it may call anything. Here the few calls by which numpy
writes an array lead to placeholders of our own; every other name is refused. No array is made
before its size is known to fit the bytes that are there.
"""

from __future__ import annotations

import io
import pickle
import re
import struct
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar, Final, NoReturn

import numpy as np
from numpy.typing import NDArray

from aapa.errors import DatasetError

LARGEST_FILE: Final = 64 * 2**20
"""Bytes. 300 frames of 1,000 detections each are 12 MB."""

_DTYPE_CODE = re.compile(r"[biu][1248]|f[248]")
_LARGEST_DIMENSIONS = 8


def load_arrays(path: Path) -> object:
    """Load a pickle of numbers, text, arrays, lists, tuples and dicts.

    Raises:
        DatasetError: The file cannot be read, is cut off or damaged, or wants anything but that.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(LARGEST_FILE + 1)
    except OSError as error:
        raise DatasetError(f"cannot be read: {error.strerror}", path=str(path)) from error
    if len(content) > LARGEST_FILE:
        raise DatasetError(f"is larger than {LARGEST_FILE // 2**20} MiB", path=str(path))
    try:
        return _Unpacking(len(content)).plain(_Interpreter(io.BytesIO(content)).load())
    except _Refused as refused:
        raise DatasetError(str(refused), path=str(path)) from refused
    except MemoryError as error:
        raise DatasetError("wants more memory than there is", path=str(path)) from error
    except Exception as error:  # no closed set of errors is promised for bad input
        raise DatasetError(
            "is no whole pickle; it may be cut off or damaged", path=str(path)
        ) from error


class _Refused(Exception):  # noqa: N818 - an answer, caught right above
    """The pickle wants something that detections do not need."""


class _DType:
    """A number format, as far as it is known; the byte order follows with the state."""

    def __init__(self, code: object, *_flags: object) -> None:
        if not isinstance(code, str) or _DTYPE_CODE.fullmatch(code) is None:
            raise _Refused(f"holds an array of {code!r}; expected whole or decimal numbers")
        self.code = code
        self.order = "="

    def __setstate__(self, state: object) -> None:
        if not isinstance(state, tuple) or len(state) < 2 or state[1] not in ("<", ">", "|", "="):
            raise _Refused("holds an array with a damaged number format")
        self.order = str(state[1])

    def resolved(self) -> np.dtype[np.generic]:
        return np.dtype(f"{self.order}{self.code}")


class _Array:
    """An array whose content follows with the state."""

    def __init__(self) -> None:
        self.values: NDArray[np.generic] | None = None

    def __setstate__(self, state: object) -> None:
        if not isinstance(state, tuple) or len(state) != 5:
            raise _Refused("holds a damaged array")
        _, shape, dtype, by_columns, content = state
        self.values = _array(content, dtype, shape, "F" if by_columns else "C")


class _NDArrayType:
    """Stands for numpy's own array type, which is only ever handed on, never called."""


def _reconstruct(kind: object, _shape: object, _code: object) -> _Array:
    if kind is not _NDArrayType:
        raise _Refused("holds an object that is no plain array")
    return _Array()


def _from_buffer(content: object, dtype: object, shape: object, order: object) -> _Array:
    made = _Array()
    made.values = _array(content, dtype, shape, "F" if order == "F" else "C")
    return made


def _scalar(dtype: object, content: object) -> int | float:
    values = _array(content, dtype, (1,), "C")
    number: int | float = values.tolist()[0]
    return number


def _no_bytes(*given: object) -> bytes:
    # Protocols 0 to 2 write no bytes at all as this call.
    if given:
        raise _Refused("holds bytes that arrays do not use")
    return b""


def _latin(text: object, encoding: object) -> bytes:
    # Protocols 0 to 2 know no bytes; they write text and this call.
    if not isinstance(text, str) or encoding != "latin1":
        raise _Refused("holds text in an encoding that arrays do not use")
    return text.encode("latin1")


def _array(content: object, dtype: object, shape: object, order: str) -> NDArray[np.generic]:
    if not isinstance(dtype, _DType):
        raise _Refused("holds an array without a number format")
    if not isinstance(content, bytes | bytearray):
        raise _Refused("holds an array of objects; expected numbers")
    if (
        not isinstance(shape, tuple)
        or len(shape) > _LARGEST_DIMENSIONS
        or any(type(side) is not int or side < 0 for side in shape)
    ):
        raise _Refused("holds an array with a damaged shape")
    flat = np.frombuffer(content, dtype=dtype.resolved())
    count = 1
    for side in shape:
        count *= side
    if count != flat.size:
        raise _Refused("holds an array whose shape does not fit its bytes")
    return flat.reshape(shape, order="F" if order == "F" else "C")


_ADMITTED: Final[dict[tuple[str, str], object]] = {
    ("numpy", "ndarray"): _NDArrayType,
    ("numpy", "dtype"): _DType,
    ("_codecs", "encode"): _latin,
    ("__builtin__", "bytes"): _no_bytes,
    ("builtins", "bytes"): _no_bytes,
    **{
        (f"numpy.{core}.{module}", name): stand_in
        for core in ("core", "_core")
        for module, name, stand_in in (
            ("multiarray", "_reconstruct", _reconstruct),
            ("multiarray", "scalar", _scalar),
            ("numeric", "_frombuffer", _from_buffer),
        )
    },
}


class _Interpreter(pickle._Unpickler):  # noqa: SLF001 - undocumented, but for this very use
    """Runs a pickle with nothing to call but the stand-ins.

    This is the interpreter written in Python: that in C keeps its memo in a table as long as the
    largest index put into it, which five bytes of a hostile file can make 64 gigabytes.
    """

    # What the base class sets up when it loads.
    read: Callable[[int], bytes]
    stack: list[object]

    def _load_bytearray(self) -> None:
        # The original makes room for the length that the file claims before it reads.
        (length,) = struct.unpack("<Q", self.read(8))
        self.stack.append(bytearray(self.read(length)))

    def _load_build(self) -> None:
        # The original sets attributes of whatever there is, our own functions included.
        state, target = self.stack.pop(), self.stack[-1]
        if not isinstance(target, _Array | _DType):
            raise _Refused("changes something that is no array")
        target.__setstate__(state)

    dispatch: ClassVar = {
        **pickle._Unpickler.dispatch,  # noqa: SLF001 - as above
        pickle.BYTEARRAY8[0]: _load_bytearray,  # type: ignore[dict-item]
        pickle.BUILD[0]: _load_build,  # type: ignore[dict-item]
    }

    def find_class(self, module: str, name: str, /) -> object:
        """Give the stand-in for a name, or refuse it."""
        stand_in = _ADMITTED.get((module, name))
        if stand_in is None:
            raise _Refused(f"asks for {module}.{name}, which no detections need; not loaded")
        return stand_in

    def persistent_load(self, pid: object, /) -> NoReturn:
        """Refuse: detections refer to nothing outside."""
        raise _Refused(f"refers to something outside of the file ({pid!r})")


class _Unpacking:
    """Puts the arrays in place of the stand-ins.

    Values are counted: a list that holds itself, or ten times another that holds ten times a
    third, is small in the file and without end here.
    """

    def __init__(self, most: int) -> None:
        self.left = most

    def plain(self, value: object) -> object:
        self.left -= 1
        if self.left < 0:
            raise _Refused("holds more values than detections have, or holds itself")
        if isinstance(value, _Array):
            if value.values is None:
                raise _Refused("holds a damaged array")
            return value.values
        if isinstance(value, list):
            return [self.plain(item) for item in value]
        if isinstance(value, tuple):
            return tuple(self.plain(item) for item in value)
        if isinstance(value, dict):
            return {self.plain(key): self.plain(item) for key, item in value.items()}
        if value is None or type(value) in (bool, int, float, str):
            return value
        raise _Refused(f"holds a {type(value).__name__.lstrip('_')}; expected numbers and arrays")
