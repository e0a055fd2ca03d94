"""The shipped prototype's assumed values against what the nine rows say of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from rr_opt.files import read_problem
from rr_opt.paper.calibration.deviance import row_deviance
from rr_opt.paper.calibration.measured import Measured
from rr_opt.paper.calibration.models import one_way
from rr_opt.paper.calibration.unknowns import UNKNOWNS, shares

Array = NDArray[np.float64]

ASSUMED = ("a1", "a2", "b", "k")
"""What the shipped file assumes of the unknowns."""

JOINT_LEVEL = float(chi2.ppf(0.95, len(ASSUMED)))
"""9.49: by how much the deviance of all four together may rise, if four were many data."""


@dataclass(frozen=True)
class Shipped:
    """values by name, SI; rise of the deviance above the least, at the best amplitude (rad)."""

    values: dict[str, float]
    rise: float
    amplitude: float


def shipped_values() -> dict[str, float]:
    """a1, a2, b (m) and k (N s/m) of the shipped robot file."""
    robot = read_problem(None).robot
    one, two = robot.platform1, robot.platform2
    if (one.b, robot.k1) != (two.b, robot.k2):
        raise ValueError("the shipped robot's platforms differ in b or k; the calibration's do not")
    return {"a1": one.a, "a2": two.a, "b": one.b, "k": robot.k1}


def shipped(predict: Callable[[Array], Array], data: Measured, least: float) -> Shipped:
    """predict: the viscous model's signed speeds; least: its least deviance."""
    values = shipped_values()
    amplitude = UNKNOWNS["amplitude"].value(np.linspace(0, 1, 241))
    points = {name: np.full(len(amplitude), value) for name, value in values.items()}
    points["amplitude"] = amplitude
    speeds = one_way(predict(shares((*ASSUMED, "amplitude"), points)))
    deviance = row_deviance((speeds - data.speed) / data.error, "student").sum(axis=1)
    best = int(deviance.argmin())
    return Shipped(values, float(deviance[best] - least), float(amplitude[best]))
