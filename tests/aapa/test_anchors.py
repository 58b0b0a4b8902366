"""An anchor made the quick way is an anchor."""

from __future__ import annotations

import copy
import dataclasses
import pickle

import pytest

from aapa.anchors import Anchor, AnchorDraft, AnchorRow, AnchorStatus, anchor_of, anchors_of

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
    assert list(AnchorRow.__slots__) == names


def row(reason):
    return (*FIELDS, *MORE[:3], reason, MORE[4])


def test_many_that_are_made_at_once_are_the_same_too():
    plain = Anchor(*FIELDS, *MORE)
    assert anchors_of([row(MORE[3])] * 3) == [plain] * 3
    assert {type(anchor) for anchor in anchors_of([row(MORE[3])])} == {Anchor}


@pytest.mark.parametrize(
    "ask",
    [
        lambda anchor: anchor.reason,
        lambda anchor: dataclasses.asdict(anchor)["reason"],
        lambda anchor: dataclasses.replace(anchor, name="other").reason,
        lambda anchor: pickle.loads(pickle.dumps(anchor)).reason,
        lambda anchor: copy.copy(anchor).reason,
        lambda anchor: repr(anchor).split("reason='")[1].split("'")[0],
    ],
)
def test_a_distance_is_put_into_words_however_it_is_asked_for(ask):
    words = "It is seen 12.3 px from its last place."
    assert ask(anchors_of([row(12.34567)])[0]) == words
    plain = Anchor(*row(words))
    (asked, unasked) = anchors_of([row(12.34567)] * 2)
    assert ask(asked) == asked.reason == words
    assert (unasked, hash(unasked)) == (plain, hash(plain))
    with pytest.raises(dataclasses.FrozenInstanceError):
        asked.reason = "another"
