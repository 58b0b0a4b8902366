"""An anchor made the quick way is an anchor."""

from __future__ import annotations

import copy
import dataclasses
import pickle

import pytest

from aapa.anchors import Anchor, AnchorDraft, AnchorStatus, anchor_of

FIELDS = ("cone-1", "cone", (1.0, 2.0, 3.0, 4.0), AnchorStatus.OCCLUDED, "case", 0.5)
MORE = ((0.1, 0.2, 0.3), (0.01, 0.02), 7, "It stands behind.", -2)


def test_it_is_the_same_as_one_made_the_ordinary_way():
    quick, plain = anchor_of(*FIELDS, *MORE), Anchor(*FIELDS, *MORE)
    assert type(quick) is Anchor
    assert (quick, hash(quick), repr(quick)) == (plain, hash(plain), repr(plain))
    assert pickle.loads(pickle.dumps(quick)) == copy.deepcopy(quick) == plain
    assert dataclasses.replace(quick, streak=3) == dataclasses.replace(plain, streak=3)


def test_it_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        anchor_of(*FIELDS, *MORE).confidence = 1.0
    with pytest.raises((AttributeError, TypeError)):
        anchor_of(*FIELDS, *MORE).colour = "red"


def test_the_draft_has_the_fields_of_an_anchor():
    names = [field.name for field in dataclasses.fields(Anchor)]
    assert [field.name for field in dataclasses.fields(AnchorDraft)] == names
