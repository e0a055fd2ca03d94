"""The step for axles that slip is of second order, and damps what settles at once."""

import casadi as ca
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_opt.sysid.paths import DrivePath
from rr_opt.sysid.shooting import System, predict


def system(fast: float, bend: float) -> System:
    """A slow state driven by one that follows sin(drive) at the rate `fast`, 1/s, and by itself."""
    x, drive, p = ca.SX.sym("x", 2), ca.SX.sym("drive", 3), ca.SX.sym("p", 1)
    goal = ca.sin(drive[0]) + 0.3 * x[0]
    rates = ca.vertcat(x[1] - p * x[0] ** 2, fast * (goal - x[1] - bend * x[1] ** 3))
    return System(
        ca.Function("rates", [x, drive, p], [rates]), ca.Function("seen", [x, drive, p], [x]), 1
    )


def end(fast: float, steps: int, bend: float = 0.0, start=(0.2, 0.1)) -> np.ndarray:
    """Where the state is after a second in so many steps."""
    h = np.full(steps, 1 / steps)
    edges = np.linspace(0.0, 1.0, steps + 1)

    def at(t: np.ndarray) -> np.ndarray:
        return np.array([3 * t, 0 * t + 3, 0 * t])

    nodes = np.stack([at(edges[:-1]), at(edges[:-1] + h / 2), at(edges[1:])], axis=1)
    made = predict(
        system(fast, bend), DrivePath(h, nodes, at(edges), 1), np.array(start), np.array([0.5])
    )
    return made.states[:, -1]


def exact(fast: float, bend: float = 0.0) -> np.ndarray:
    """The same by an implicit method of order 5 at tight tolerance."""

    def slope(t: float, x: np.ndarray) -> list[float]:
        goal = np.sin(3 * t) + 0.3 * x[0]
        return [x[1] - 0.5 * x[0] ** 2, fast * (goal - x[1] - bend * x[1] ** 3)]

    accurate = {"rtol": 1e-10, "atol": 1e-12}
    return solve_ivp(slope, (0.0, 1.0), [0.2, 0.1], "Radau", **accurate).y[:, -1]


def test_order():
    goal = exact(20.0, 0.2)
    errors = [np.abs(end(20.0, steps, 0.2) - goal).max() for steps in (100, 200, 400, 800)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(2.0, abs=0.15)


def test_settles_at_once():
    # The step is a thousand times as long as the fast state needs.
    away, near = end(1e5, 100, start=(0.2, 5.0)), end(1e5, 100)
    np.testing.assert_allclose(away, near, atol=5e-2)
    # The jump of the first instant is spread over a step or two.
    np.testing.assert_allclose(near, exact(1e5), atol=3e-2)
