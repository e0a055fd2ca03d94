"""A climb ends where nothing more is gained, as exactly as its function is known there."""

import numpy as np
import pytest

from rr_opt.sqp import Program, Seen, ascend


def _uphill(points: np.ndarray) -> Seen:
    """log(x) - x/3, of which rounding is large where x is small."""
    x = points[:, 0]
    nothing = np.zeros((0, len(x)))
    return Seen(np.log(x) - x / 3, nothing, nothing, (), 1e-2 if x[0] < 1 else 1e-15)


def test_rounding_is_that_of_where_the_climb_has_come():
    one = np.ones(1)
    program = Program(
        0.1 * one, 10 * one, one, np.zeros((0, 1)), np.zeros(0), look=_uphill, step=1e-4
    )
    ascent = ascend(program, 0.5 * one)
    assert ascent.converged
    assert ascent.x[0] == pytest.approx(3.0, rel=1e-5)
