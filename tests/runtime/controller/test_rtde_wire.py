from __future__ import annotations

import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.rtde_wire import (
    DataType,
    PackageType,
    Recipe,
    WireError,
    frame,
    take_packages,
)

_DOUBLES = st.floats(allow_nan=False)
_INT32 = st.integers(-(2**31), 2**31 - 1)
_UINT32 = st.integers(0, 2**32 - 1)
_VALUES = {
    DataType.BOOL: st.booleans(),
    DataType.UINT8: st.integers(0, 255),
    DataType.UINT32: _UINT32,
    DataType.UINT64: st.integers(0, 2**64 - 1),
    DataType.INT32: _INT32,
    DataType.DOUBLE: _DOUBLES,
    DataType.VECTOR3D: st.tuples(*[_DOUBLES] * 3),
    DataType.VECTOR6D: st.tuples(*[_DOUBLES] * 6),
    DataType.VECTOR6INT32: st.tuples(*[_INT32] * 6),
    DataType.VECTOR6UINT32: st.tuples(*[_UINT32] * 6),
}


@st.composite
def _packages(draw):
    kinds = tuple(draw(st.lists(st.sampled_from(DataType), min_size=1, max_size=12)))
    names = tuple(f"variable_{index}" for index in range(len(kinds)))
    return Recipe(1, names, kinds), tuple(draw(_VALUES[kind]) for kind in kinds)


@given(_packages())
def test_what_is_packed_is_unpacked_again(package):
    recipe, values = package
    packed = recipe.pack(values)
    assert len(packed) == recipe.size
    assert recipe.unpack(packed) == values


def test_values_are_big_endian_and_without_padding():
    recipe = Recipe(1, ("a", "b"), (DataType.UINT8, DataType.DOUBLE))
    assert recipe.pack((7, 1.0)) == b"\x07" + struct.pack(">d", 1.0)


def test_a_package_of_another_size_is_refused():
    recipe = Recipe(3, ("a",), (DataType.DOUBLE,))
    with pytest.raises(WireError, match="recipe 3 has 8 bytes, but 96 came"):
        recipe.unpack(bytes(96))


@given(
    st.lists(st.tuples(st.integers(0, 255), st.binary(max_size=50)), max_size=5),
    st.integers(1, 7),
)
def test_packages_are_found_however_the_stream_is_cut(packages, cut):
    stream = b"".join(struct.pack(">HB", 3 + len(data), kind) + data for kind, data in packages)
    buffer, found = bytearray(), []
    for at in range(0, len(stream), cut):
        buffer += stream[at : at + cut]
        found.extend(take_packages(buffer))
    assert found == packages
    assert not buffer


def test_a_size_smaller_than_the_header_is_beyond_recovery():
    with pytest.raises(WireError, match="shorter than its own header"):
        list(take_packages(bytearray(b"\x00\x01V")))


def test_a_frame_counts_its_own_header():
    assert frame(PackageType.START, b"\x01") == b"\x00\x04S\x01"
