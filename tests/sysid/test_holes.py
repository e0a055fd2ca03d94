"""A recording with a hole is cut into parts that each have a step to simulate."""

import numpy as np
import pytest

from rr_opt.sysid.model import Data, segments


@pytest.mark.parametrize("until", [50, 99])
def test_no_part_lies_in_a_hole(until):
    t = np.linspace(0.0, 1.0, 100)
    t[until:] += 3.0
    y = np.zeros((100, 1))
    parts = segments({0: Data("run", t, y, np.ones_like(y), False)}, 0.125)
    assert all(one.first < one.last for one in parts)
    assert [one.until for one in parts[:-1]] == [one.first for one in parts[1:]]
    assert (parts[0].first, parts[-1].until) == (0, 100)
