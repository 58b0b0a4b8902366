from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite import Action, Belief, TraceError
from icarus_lite.trace.ground_text import parse_action, parse_belief

NAMES = st.from_regex(r"[a-z][a-z0-9-]{0,8}", fullmatch=True)
VALUES = st.one_of(
    NAMES,
    st.text(max_size=12),
    st.integers(),
    st.floats(allow_nan=False, allow_infinity=False),
)


@given(NAMES, st.lists(VALUES, max_size=5))
def test_what_is_written_is_read_back_whatever_the_values(name: str, args: list[object]) -> None:
    belief = Belief(name, tuple(args))
    again = parse_belief(str(belief))
    assert again == belief
    assert [type(each) for each in again.args] == [type(each) for each in args]
    action = Action(name, tuple(args))
    assert parse_action(str(action)) == action


@pytest.mark.parametrize("text", ["", "()", "on a b", "(on a", "(3 a)", '(on "a)', "(on (f a))"])
def test_other_text_is_refused(text: str) -> None:
    with pytest.raises(TraceError, match=r"text of a belief|cannot be read from"):
        parse_belief(text)
