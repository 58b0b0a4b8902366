from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.errors import AnchoringError
from aapa.names import NameRegister


def named(register, type_, *, unique=False, anchored=()):
    return register.with_new(type_, unique=unique, anchored=anchored)


def test_types_are_numbered_each_on_its_own():
    register = NameRegister()
    names = []
    for type_ in ["cone", "ball", "cone"]:
        name, register = named(register, type_)
        names.append(name)
    assert names == ["cone-1", "ball-1", "cone-2"]


def test_the_first_of_a_unique_type_is_named_by_it():
    first, register = named(NameRegister(), "case", unique=True)
    taken = [first]
    second, register = named(register, "case", unique=True, anchored=taken)
    third, _ = named(register, "case", unique=True, anchored=[*taken, second])
    assert (first, second, third) == ("case", "case-2", "case-3")


def test_the_one_object_of_a_unique_type_is_the_same_when_it_is_found_again():
    first, register = named(NameRegister(), "case", unique=True)
    assert named(register, "case", unique=True, anchored=[]) == (first, register)


def test_a_register_is_not_changed_by_naming():
    register = NameRegister()
    named(register, "cone")
    assert register == NameRegister()


def test_names_of_bodies_are_passed_over():
    register = NameRegister().with_bodies(frozenset({"cone-1", "case"}))
    assert named(register, "cone")[0] == "cone-2"
    assert named(register, "case", unique=True)[0] == "case-1"


def test_a_body_may_come_and_go_under_its_name():
    register = NameRegister().with_bodies(frozenset({"hand"}))
    assert register.with_bodies(frozenset()) == register
    assert register.with_bodies(frozenset({"hand"})) == register


@pytest.mark.parametrize(("type_", "unique", "name"), [("cone", False, "cone-1"), ("a", True, "a")])
def test_a_body_cannot_take_the_name_of_an_object(type_, unique, name):
    _, register = named(NameRegister(), type_, unique=unique)
    with pytest.raises(AnchoringError, match=f"'{name}' already stands for an anchored object"):
        register.with_bodies(frozenset({name}))


def test_a_body_may_look_like_a_name_that_is_not_given():
    _, register = named(NameRegister(), "hand")
    for name in ["hand", "hand-2", "hand-01", "hand-0", "hand-x", "-1"]:
        assert name in register.with_bodies(frozenset({name}))
        assert name not in register


types = st.sampled_from(["cone", "cone-1", "cone-1-1", "case", "case-2"])
asks = st.tuples(types, st.booleans(), st.none() | st.sampled_from(["cone-2", "case", "hand"]))


@given(st.lists(asks, max_size=30))
def test_no_name_is_given_while_an_anchor_has_it(sequence):
    register = NameRegister()
    given_names: list[str] = []
    bodies: set[str] = set()
    for type_, unique, body in sequence:
        if body is not None and body not in register:
            register = register.with_bodies(frozenset({body}))
            bodies.add(body)
        name, register = named(register, type_, unique=unique, anchored=given_names)
        assert name in register
        given_names.append(name)
    assert len(set(given_names)) == len(given_names)
    assert not bodies & set(given_names)
