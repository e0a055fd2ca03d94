"""The derivatives carried along a run are those of the prediction, by parameters and by the start.

Held against differences of whole predictions: for smooth steps, for fine steps of a stiff system,
and for the robot. With steps half as long they are four times as close.
"""

import casadi as ca
import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.dynamics import values_of
from rr_opt.motion.floor_motion import floor_motion
from rr_opt.sysid.paths import DrivePath
from rr_opt.sysid.sensitivities import slopes
from rr_opt.sysid.shooting import System, predict
from tests.robots import BENCHMARK

GAIT = SineGait(0.6, 1.0, 0.1)


def pendulum() -> System:
    """Angle and rate under gravity, friction and a drive, of which the angle's sine is seen."""
    x, drive, p = ca.SX.sym("x", 2), ca.SX.sym("drive", 2), ca.SX.sym("p", 2)
    fall = -p[0] * ca.sin(x[0]) - p[1] * x[1] + drive[0] * ca.cos(drive[1])
    rates = ca.Function("rates", [x, drive, p], [ca.vertcat(x[1], fall)])
    return System(
        rates, ca.Function("seen", [x, drive, p], [ca.vertcat(ca.sin(x[0]), x[1] + p[0])])
    )


def stiff() -> System:
    """A state that drifts with one that settles at once to where the drive and p say."""
    x, drive, p = ca.SX.sym("x", 2), ca.SX.sym("drive", 3), ca.SX.sym("p", 2)
    rates = ca.vertcat(x[1] - p[1] * x[0], 300 * (p[0] * ca.sin(drive[0]) - x[1]))
    return System(
        ca.Function("rates", [x, drive, p], [rates]), ca.Function("seen", [x, drive, p], [x]), 1
    )


def racer() -> System:
    motion = floor_motion()
    return System(motion.rates, motion.observed)


def path(rows: int, each: int) -> DrivePath:
    """The gait at 100 samples a second, `each` steps between two."""
    h = np.full(100 * each, 0.01 / each)
    edges = np.append(0.0, np.cumsum(h))

    def at(t: np.ndarray) -> np.ndarray:
        return np.array([GAIT.angle(t), GAIT.rate(t), GAIT.acceleration(t)])[:rows]

    nodes = np.stack([at(edges[:-1]), at(edges[:-1] + h / 2), at(edges[1:])], axis=1)
    return DrivePath(h, nodes, at(edges)[:, ::each], each)


CASES = {
    "smooth": (pendulum(), path(2, 1), [0.4, -0.2], [9.0, 0.3], 2e-3),
    "fine": (pendulum(), path(2, 4), [0.4, -0.2], [9.0, 0.3], 1e-4),
    "stiff": (stiff(), path(3, 4), [0.4, 0.1], [0.5, 0.7], 2e-2),
    "racer": (racer(), path(2, 1), [0.1, 0.2, 0.3, 0.05], None, 2e-3),
}


@pytest.mark.parametrize("name", CASES)
def test_against_differences(name):
    system, drive, start, p, close = CASES[name]
    start = np.array(start)
    p = values_of(BENCHMARK, floor_motion().parameters) if p is None else np.array(p)
    scale = np.maximum(np.abs(p), 1e-3)
    made = predict(system, drive, start, p)
    found = slopes(system, drive, made, p, np.diag(scale), None)

    def moved(by_start: np.ndarray, by_p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        up, down = (
            predict(system, drive, start + s * by_start, p + s * by_p) for s in (1e-5, -1e-5)
        )
        last = (up.states[:, -1] - down.states[:, -1]) / 2e-5
        return (up.seen - down.seen) / 2e-5, last

    ends = []
    for k in range(start.size):
        expected, end = moved(np.eye(start.size)[k], 0 * p)
        ends.append(end)
        np.testing.assert_allclose(
            found.by_start[:, :, k], expected, atol=close * np.abs(expected).max()
        )
    for k in range(p.size):
        expected, end = moved(0 * start, np.diag(scale)[k])
        ends.append(end)
        size = np.abs(expected).max(axis=0)
        off = np.abs(found.by_parameter[:, :, k] - expected).max(axis=0)
        assert np.all(off <= close * np.maximum(size, 1e-3 * size.max()) + 1e-9)
    last = np.column_stack(ends)
    size = np.maximum(np.abs(last).max(axis=0), 0.1 * np.abs(last).max())
    assert np.all(np.abs(found.end - last) <= close * size + 1e-9)


@pytest.mark.parametrize("name", ["smooth", "racer"])
def test_second_order(name):
    system, _, start, p, _ = CASES[name]
    start = np.array(start)
    p = values_of(BENCHMARK, floor_motion().parameters) if p is None else np.array(p)
    errors = []
    for each in (1, 2, 4):
        drive = path(2, each)
        made = predict(system, drive, start, p)
        found = slopes(system, drive, made, p, np.eye(p.size), None).by_start[:, :, -1]
        by = 1e-5 * np.eye(start.size)[-1]
        up, down = (predict(system, drive, start + s * by, p).seen for s in (1, -1))
        errors.append(np.abs(found - (up - down) / 2e-5).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(2.0, abs=0.1)
