"""The periodic solution of a linear recurrence, against all of its equations solved at once."""

import numpy as np
import pytest

from rr_opt.design.landscape import _periodic


@pytest.mark.parametrize("count", [1, 2, 3, 96, 97, 3072])
@pytest.mark.parametrize("columns", [0, 1, 5])
def test_it_solves_all_equations(count, columns):
    rng = np.random.default_rng(count)
    gain, shift = rng.uniform(-1.1, 1.1, (count, columns)), rng.normal(size=(count, columns))
    found = _periodic(gain, shift)
    assert found.shape == gain.shape
    np.testing.assert_allclose(np.roll(found, -1, axis=0), gain * found + shift, atol=1e-12)


def test_steep_decay_leaves_the_shift():
    shift = np.arange(20.0)[:, None]
    np.testing.assert_allclose(_periodic(np.zeros((20, 1)), shift), np.roll(shift, 1, axis=0))
