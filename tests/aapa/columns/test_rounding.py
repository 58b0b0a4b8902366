from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from aapa.columns.rounding import rounded_each


@given(st.lists(st.floats(-2, 2) | st.sampled_from([0.1 + 0.2, 0.30000000050000002])))
def test_it_rounds_as_python_does(values):
    assert rounded_each(np.array(values, dtype=np.float64)).tolist() == [
        round(value, 9) for value in values
    ]
