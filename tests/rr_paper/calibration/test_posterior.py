"""Quantiles and profiles are those of integration on a grid, on a problem of two unknowns."""

from __future__ import annotations

import numpy as np
import pytest

from rr_paper.calibration.fit import Data, Effort, Estimator, estimator
from rr_paper.calibration.intervals import LEVEL, profiles, sample

SPREAD = np.linspace(0.3, 1.3, 9)
DATA = Data(0.4 * SPREAD + 0.2, 0.25 * np.ones(9))


def predict(points: np.ndarray) -> np.ndarray:
    """A bent valley inside the box: the product of both is known better than each."""
    return (points[:, :1] + 0.2) * (points[:, 1:] + 0.2) * SPREAD + 0.2 * points[:, 1:]


def on_a_grid() -> tuple[np.ndarray, np.ndarray]:
    """Places along an unknown (M,), and the deviance everywhere (M, M)."""
    at = (np.arange(400) + 0.5) / 400
    one, other = np.meshgrid(at, at, indexing="ij")
    speeds = predict(np.column_stack([one.ravel(), other.ravel()]))
    return at, DATA.deviance(speeds).reshape(400, 400)


def fitter() -> Estimator:
    work = Effort(log2_size=10, slices=0, values=41, starts=1, steps=20, sets=0)
    return estimator(predict, 2, work)


def test_quantiles():
    at, deviance = on_a_grid()
    drawn = sample(fitter(), DATA, chains=60, sweeps=600)
    for unknown, along in enumerate((1, 0)):
        mass = np.exp(-deviance / 2).sum(axis=along)
        below = np.cumsum(mass) / mass.sum()
        exact = [at[np.searchsorted(below, share)] for share in (0.025, 0.5, 0.975)]
        assert drawn.quantiles()[:, unknown] == pytest.approx(exact, abs=0.02)
    assert drawn.rhat < 1.1


def test_profiles():
    at, deviance = on_a_grid()
    found = profiles(fitter(), DATA, [0, 1])
    for unknown, along in enumerate((1, 0)):
        least = deviance.min(axis=along)
        inside = at[least - deviance.min() <= LEVEL]
        assert found[unknown].low == pytest.approx(inside[0], abs=0.01)
        assert found[unknown].high == pytest.approx(inside[-1], abs=0.01)
