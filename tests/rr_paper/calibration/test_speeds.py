"""The fast mean speeds are those of the integrator, row by row, on random robots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.ballast import Loads, with_inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse, Platform, Robot
from rr_opt.motion.steady_cycle import steady_cycle
from rr_paper.calibration.fit import measured
from rr_paper.calibration.models import MODELS, READINGS, Reading, values
from rr_paper.publication import ROWS
from rr_paper.signs import PRINTED
from rr_paper.signs import steady_cycle as by_equation3

TRIED = (0, 4, 8)


def robot_of(x: dict[str, float], row: int, reading: Reading) -> Robot:
    """Built from Table 1 and the point, and brought to the row's ratio by `ballast`."""
    h = 0.02
    bare = Robot(
        Platform(0.469, 0.00386, 0.186 + x["a1"], x["a1"], x["b"], x.get("k", 1e-4) * h**2),
        Platform(0.250, 0.00175, 0.0441 + x["a2"], x["a2"], x["b"], x.get("k", 1e-4) * h**2),
        h,
    )
    loads = Loads(0.066, 0.0441, reading.spread)
    built = with_inertia_ratio(bare, ROWS[row].ratio, reading.about, reading.by, loads)
    if "force" in x:
        dry = EffectUse("coulomb_friction", {"force1": x["force"], "force2": x["force"]})
        built = replace(built, physics=(dry,))
    return built


def gait_of(x: dict[str, float], row: int) -> SineGait:
    printed = ROWS[row]
    shrunk = np.hypot(1, x.get("lag", 0.0) * 2 * np.pi / printed.period)
    return SineGait(float((printed.amplitude or x["amplitude"]) / shrunk), printed.period)


def points(name: str, count: int) -> tuple[np.ndarray, list[dict[str, float]]]:
    names = MODELS[name].unknowns
    shares = np.random.default_rng(8).uniform(0.1, 0.9, (count, len(names)))
    at = values(names, shares)
    return shares, [{key: float(of[i]) for key, of in at.items()} for i in range(count)]


@pytest.mark.parametrize("reading", READINGS, ids=lambda reading: reading.words)
@pytest.mark.parametrize("name", ["viscous", "lag"])
def test_viscous(name: str, reading: Reading):
    shares, robots = points(name, 3)
    speeds = MODELS[name](shares, reading)
    for i, x in enumerate(robots):
        for row in TRIED:
            cycle = steady_cycle(robot_of(x, row, reading), gait_of(x, row), steps=256)
            assert speeds[i, row] == pytest.approx(cycle.speed, rel=1e-5, abs=1e-9)


def test_dry():
    error = measured("mean").error
    shares, robots = points("viscous+dry", 3)
    speeds = MODELS["viscous+dry"](shares, READINGS[0])
    for i, x in enumerate(robots):
        for row in TRIED:
            cycle = steady_cycle(robot_of(x, row, READINGS[0]), gait_of(x, row), steps=2048)
            # Coarse on purpose: within a fifth of the row's standard error.
            assert speeds[i, row] == pytest.approx(cycle.speed, abs=0.2 * error[row])


def test_printed():
    shares, robots = points("printed", 3)
    speeds = MODELS["printed"](shares, READINGS[0])
    for i, x in enumerate(robots):
        for row in TRIED:
            robot, gait = robot_of(x, row, READINGS[0]), gait_of(x, row)
            cycle = by_equation3(robot, gait.amplitude, gait.period, PRINTED)
            assert speeds[i, row] == pytest.approx(cycle.speed[0], rel=1e-5, abs=1e-9)
