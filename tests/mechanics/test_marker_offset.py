"""A tracked point beside the joint is seen turning about it: dx ahead of P, dy to its left."""

import numpy as np
import pytest
from hypothesis import given

from tests.mechanics.cases import REPEATABLE, numbers
from tests.mechanics.floor import what_is_seen

shifts = numbers(-0.05, 0.05)


@REPEATABLE
@given(numbers(-3.0, 3.0), numbers(-7.0, 7.0), shifts, shifts)
def test_seen_beside(x, psi, dx, dy):
    seen = what_is_seen(("marker_offset",), np.array([x, 1.0, psi]), 0.3, {"dx": dx, "dy": dy})
    place = x + 1j + (dx + 1j * dy) * np.exp(1j * psi)
    assert seen == pytest.approx([place.real, place.imag, psi, 0.3], abs=1e-12)
