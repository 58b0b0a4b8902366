"""Honest pickles are read as they are; hostile ones do nothing but get refused."""

from __future__ import annotations

import os
import pickle
import struct
from contextlib import suppress

import numpy as np
import pytest

from aapa.errors import DatasetError
from aapa.lacater import unpickling
from aapa.lacater.unpickling import load_arrays


def stored(folder, content):
    path = folder / "video.pkl"
    path.write_bytes(content)
    return path


def same(first, second):
    assert type(first) is type(second)
    if isinstance(first, np.ndarray):
        assert first.dtype == second.dtype
        assert first.shape == second.shape
        assert (first == second).all()
    elif isinstance(first, dict):
        assert list(first) == list(second)
        for key in first:
            same(first[key], second[key])
    elif isinstance(first, list | tuple):
        assert len(first) == len(second)
        for a, b in zip(first, second, strict=True):
            same(a, b)
    else:
        assert first == second


ARRAYS = {
    "bb": [np.arange(8).reshape(2, 4), np.zeros((0, 4), dtype=np.int64)],
    "labels": [np.array([140, 3]), np.array([], dtype=np.float64)],
    "more": (np.array([[1.5, 2.5]], dtype=np.float32), np.array([True]), "text", 7, None, 2.5),
    "columns": np.asfortranarray(np.arange(6, dtype=np.int32).reshape(2, 3)),
    "swapped": np.array([1, 2], dtype=">i4"),
}


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_arrays_come_back_whatever_the_protocol(tmp_path, protocol):
    same(load_arrays(stored(tmp_path, pickle.dumps(ARRAYS, protocol))), ARRAYS)


def test_a_pickle_of_an_older_numpy_comes_back(tmp_path):
    content = pickle.dumps(ARRAYS, 2).replace(b"numpy._core.multiarray", b"numpy.core.multiarray")
    assert b"numpy.core.multiarray" in content
    same(load_arrays(stored(tmp_path, content)), ARRAYS)


def test_numpy_scalars_come_back_as_numbers(tmp_path):
    content = pickle.dumps([np.int64(7), np.float32(2.5)])
    assert load_arrays(stored(tmp_path, content)) == [7, 2.5]


class Calls:
    """Pickles to a call of anything."""

    def __init__(self, function, *arguments):
        self.call = (function, arguments)

    def __reduce__(self):
        return self.call


@pytest.mark.parametrize("protocol", [0, 2, 4, 5])
def test_a_pickle_that_calls_something_is_refused_before_it_does(tmp_path, protocol):
    trace = tmp_path / "called"
    hostile = {"bb": [Calls(os.mkdir, str(trace))], "labels": []}
    path = stored(tmp_path, pickle.dumps(hostile, protocol))
    with pytest.raises(DatasetError, match=r"asks for (posix|nt)\.mkdir"):
        load_arrays(path)
    assert not trace.exists()


@pytest.mark.parametrize(
    "function", [eval, getattr, __import__, np.load, np.fromfile, np.memmap, pickle.loads]
)
def test_no_function_is_ever_handed_out(tmp_path, function):
    with pytest.raises(DatasetError, match="asks for"):
        load_arrays(stored(tmp_path, pickle.dumps(Calls(function, "x"))))


def test_numpy_s_array_type_cannot_be_called(tmp_path):
    # numpy.ndarray((10**13,)) would ask for 80 terabytes.
    with pytest.raises(DatasetError):
        load_arrays(stored(tmp_path, pickle.dumps(Calls(np.ndarray, (10**13,)))))


def test_an_array_of_objects_is_refused(tmp_path):
    content = pickle.dumps(np.array([object, len], dtype=object))
    with pytest.raises(DatasetError, match="array of 'O8'"):
        load_arrays(stored(tmp_path, content))


def test_an_array_that_claims_more_than_its_bytes_is_refused(tmp_path):
    content = pickle.dumps(np.arange(4), 4)
    assert content.count(b"K\x04\x85") == 1  # the shape (4,)
    huge = content.replace(b"K\x04\x85", b"J\xff\xff\xff\x7f\x85")
    with pytest.raises(DatasetError):
        load_arrays(stored(tmp_path, huge))


@pytest.mark.parametrize("protocol", [0, 2, 4, 5])
def test_whatever_is_cut_off_is_refused(tmp_path, protocol):
    content = pickle.dumps({"bb": ARRAYS["bb"][:1], "labels": ARRAYS["labels"]}, protocol)
    for length in range(len(content)):
        with pytest.raises(DatasetError):
            load_arrays(stored(tmp_path, content[:length]))


def test_damaged_bytes_never_fail_in_another_way(tmp_path):
    chance = np.random.default_rng(7)
    content = bytearray(pickle.dumps(ARRAYS, 4))
    survived = 0
    for _ in range(200):
        damaged = bytearray(content)
        for place in chance.integers(0, len(damaged), 3):
            damaged[place] = chance.integers(0, 256)
        # It may still be whole, if the damage is in a number; but nothing else is ever raised.
        with suppress(DatasetError):
            load_arrays(stored(tmp_path, bytes(damaged)))
            survived += 1
    assert 0 < survived < 200


@pytest.mark.parametrize(
    "content",
    [
        b"\x80\x04]r" + struct.pack("<I", 2**32 - 1) + b".",  # LONG_BINPUT: a memo of 64 GB in C
        b"(lp4294967295\n.",  # PUT, the same as text
    ],
)
def test_a_huge_memo_index_costs_no_memory(tmp_path, content):
    assert load_arrays(stored(tmp_path, content)) == []


def test_our_own_functions_cannot_be_changed(tmp_path):
    # The stand-in for _codecs.encode, then BUILD with (None, {"__defaults__": ()}).
    content = b"c_codecs\nencode\n(N}X\x0c\x00\x00\x00__defaults__)stb."
    with pytest.raises(DatasetError, match="changes something that is no array"):
        load_arrays(stored(tmp_path, content))


def test_a_huge_array_of_bytes_is_not_made_room_for(tmp_path):
    content = b"\x80\x05\x96" + struct.pack("<Q", 2**44) + b"ab."  # BYTEARRAY8, 16 TB
    with pytest.raises(DatasetError):
        load_arrays(stored(tmp_path, content))


def test_a_list_that_holds_itself_is_refused(tmp_path):
    endless = []
    endless.append(endless)
    with pytest.raises(DatasetError):
        load_arrays(stored(tmp_path, pickle.dumps(endless)))


def test_lists_of_lists_of_the_same_list_are_refused_before_they_grow(tmp_path):
    value = []
    for _ in range(40):
        value = [value] * 10  # 10^40 values in a file of some hundred bytes
    with pytest.raises(DatasetError, match="more values"):
        load_arrays(stored(tmp_path, pickle.dumps(value)))


def test_what_lies_outside_is_not_fetched(tmp_path):
    with pytest.raises(DatasetError, match="outside of the file"):
        load_arrays(stored(tmp_path, b"Psomething\n."))


def test_a_value_that_is_neither_number_nor_container_is_refused(tmp_path):
    with pytest.raises(DatasetError, match="holds a bytes"):
        load_arrays(stored(tmp_path, pickle.dumps(b"raw", 4)))


def test_the_text_names_the_file(tmp_path):
    path = tmp_path / "nowhere.pkl"
    with pytest.raises(DatasetError, match=r"nowhere\.pkl: cannot be read: No such file"):
        load_arrays(path)


def test_a_file_beyond_the_limit_is_not_loaded(tmp_path, monkeypatch):
    monkeypatch.setattr(unpickling, "LARGEST_FILE", 10)
    with pytest.raises(DatasetError, match="is larger than"):
        load_arrays(stored(tmp_path, pickle.dumps(list(range(50)))))
