"""The sample has the quantiles that integration on a grid gives, on a problem of two unknowns."""

from __future__ import annotations

import numpy as np
import pytest

from rr_paper.calibration.fit import library
from rr_paper.calibration.models import Measured, row_deviance
from rr_paper.calibration.posterior import sample
from rr_paper.calibration.profile import LEVEL, profiles

SPREAD = np.linspace(0.3, 1.3, 9)
DATA = Measured(0.4 * SPREAD + 0.2, 0.25 * np.ones(9))


def predict(points: np.ndarray) -> np.ndarray:
    """A bent valley inside the box: the product of both is known better than each."""
    return (points[:, :1] + 0.2) * (points[:, 1:] + 0.2) * SPREAD + 0.2 * points[:, 1:]


def on_a_grid() -> tuple[np.ndarray, np.ndarray]:
    """Places along an unknown (M,), and the deviance everywhere (M, M)."""
    at = (np.arange(400) + 0.5) / 400
    one, other = np.meshgrid(at, at, indexing="ij")
    speeds = predict(np.column_stack([one.ravel(), other.ravel()]))
    deviance = row_deviance((speeds - DATA.speed) / DATA.error, "student").sum(axis=1)
    return at, deviance.reshape(400, 400)


def test_quantiles():
    at, deviance = on_a_grid()
    known = library(predict, 2, 10, lambda: None)
    drawn = sample(predict, known, DATA, chains=60, sweeps=600, tick=lambda: None)
    for unknown, along in enumerate((1, 0)):
        mass = np.exp(-deviance / 2).sum(axis=along)
        below = np.cumsum(mass) / mass.sum()
        exact = [at[np.searchsorted(below, share)] for share in (0.025, 0.5, 0.975)]
        assert drawn.quantiles()[:, unknown] == pytest.approx(exact, abs=0.02)
    assert drawn.rhat < 1.1


def test_profiles():
    at, deviance = on_a_grid()
    known = library(predict, 2, 10, lambda: None)
    found = profiles(predict, DATA, known.points, known.deviance(DATA), unknowns=[0, 1],
                     values=41, starts=1, steps=20)  # fmt: skip
    for unknown, along in enumerate((1, 0)):
        least = deviance.min(axis=along)
        inside = at[least - deviance.min() <= LEVEL]
        assert found[unknown].low == pytest.approx(inside[0], abs=0.01)
        assert found[unknown].high == pytest.approx(inside[-1], abs=0.01)
