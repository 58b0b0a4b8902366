from __future__ import annotations

from icarus_lite import Belief
from icarus_lite.inference import FactStore
from icarus_lite.inference.views import View


def fact(predicate: str, *args: str | float, **attributes: str | float) -> Belief:
    return Belief(predicate, args, attributes)


EDGES = [fact("edge", 1, 2), fact("edge", 1, 3), fact("edge", 2, 2), fact("edge", 1)]
FROM = View("edge", 2, (), (0,), (1,), ())


def values(store: FactStore, view: View, key: object) -> list[tuple]:
    return [entry[0] for entry in store.index(view).get(key, ())]


def test_an_index_finds_facts_by_what_is_known_in_the_order_of_belief() -> None:
    assert values(FactStore(EDGES), FROM, 1) == [(2,), (3,)]


def test_an_index_is_kept_up_to_date() -> None:
    store = FactStore(EDGES[:1])
    assert values(store, FROM, 1) == [(2,)]
    assert store.add(fact("edge", 1, 9))
    assert not store.add(fact("edge", 1, 9))
    assert values(store, FROM, 1) == [(2,), (9,)]


def test_a_variable_repeated_inside_a_pattern_must_agree() -> None:
    loops = View("edge", 2, (), (), (0,), ((0, 1),))
    assert values(FactStore(EDGES), loops, ()) == [(2,)]


def test_attributes_are_keys_and_values_and_must_be_there() -> None:
    boxes = View("object", 1, ("type", "x"), (1,), (0, 2), ())
    store = FactStore(
        [
            fact("object", "a", type="box", x=1),
            fact("object", "b", type="box"),
            fact("object", "c", x=2, type="rod"),
        ]
    )
    assert values(store, boxes, "box") == [("a", 1)]
    assert values(store, boxes, "rod") == [("c", 2)]


def test_numbers_tell_old_facts_from_new_ones() -> None:
    store = FactStore(EDGES)
    before = store.count
    store.add(fact("edge", 1, 9))
    assert [number for _, _, number in store.index(FROM)[1]] == [0, 1, before]


def test_views_that_look_alike_share_an_index() -> None:
    store = FactStore(EDGES)
    same = View("edge", 2, (), (0,), (1,), ())
    assert same == FROM
    assert store.index(same) is store.index(FROM)
    assert store.index(View("edge", 2, (), (1,), (0,), ())) is not store.index(FROM)


def test_a_fact_that_is_there_keeps_its_attributes() -> None:
    store = FactStore([fact("gap", "a", size=1)])
    assert not store.add(fact("gap", "a", size=2))
    assert [dict(each.attributes) for each in store] == [{"size": 1}]
