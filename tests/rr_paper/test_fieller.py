"""The interval of a ratio contains the true one at least as often as its level says."""

import math

import numpy as np
import pytest
from scipy import stats

from rr_paper.statements import fieller


@pytest.mark.parametrize("spread", [0.05, 0.3])
def test_coverage(spread):
    rng = np.random.default_rng(4)
    t = stats.t.ppf(0.975, 2)
    runs = np.array([4.0, 1.0])[:, None] * (1 + spread * rng.standard_normal((2000, 2, 3)))
    means, widths = runs.mean(axis=2), t * runs.std(axis=2, ddof=1) / math.sqrt(3)
    ends = [fieller((m[0], h[0]), (m[1], h[1])) for m, h in zip(means, widths, strict=True)]
    held = np.mean([low <= 4.0 <= high for low, high in ends])
    assert 0.94 <= held <= 0.995


def test_no_upper_end_where_the_denominator_may_be_nothing():
    low, high = fieller((1.0, 0.1), (0.1, 0.2))
    assert math.isinf(high)
    assert (1.0 - low * 0.1) ** 2 == pytest.approx(0.1**2 + (low * 0.2) ** 2)
