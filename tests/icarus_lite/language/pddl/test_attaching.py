"""Whether bonds can form a circle, against the plain definition."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.language.pddl.attaching import may_circle

PAIRS = st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), max_size=8)


@given(PAIRS)
def test_a_circle_is_a_way_back_to_oneself(pairs: list[tuple[int, int]]) -> None:
    reach = set(pairs)
    while True:
        more = {(a, d) for a, b in reach for c, d in pairs if b == c} - reach
        if not more:
            break
        reach |= more
    assert may_circle(pairs) == any(a == b for a, b in reach)
