"""The hand-assembled Jacobian and Hessian of the program are the derivatives of its rows."""

import numpy as np
import pytest

from rr_opt.design.multiple_shooting import shooting
from rr_opt.design.shapes import FourierShape, FreeShape
from rr_opt.motion.dynamics import derive
from tests.robots import BENCHMARK, DRY

N = 8
LOADS = 0.066, 0.05, 0.03


@pytest.fixture(params=["inertia", "loads", "dry", "free"])
def program(request):
    robot = DRY if request.param in {"dry", "free"} else BENCHMARK
    by = "loads" if request.param == "loads" else "inertia"
    dynamics = derive(tuple(use.name for use in robot.physics))
    ballast = [0.0, 3.0] if by == "loads" else [5e-4, 2e-3]
    phases = np.array([0.0, 0.11, 0.25, 0.4, 0.5, 0.66, 0.75, 0.9])
    shape = FreeShape() if request.param == "free" else FourierShape(3)
    checks = shape.given(np.array([0.03]))
    looks = 0 if request.param in {"inertia", "loads"} else 2
    places = np.linspace(0.2, 0.7, N * (looks + 1))
    p = [*dynamics.values(robot), *LOADS, *ballast, *checks, -1.0, *phases, *places]
    program = shooting(dynamics.effects, by, shape, N, looks, substeps=2)
    layout, rng = program.layout, np.random.default_rng(1)
    values = {name: 0.1 * k - 0.2 for k, name in enumerate(layout.decisions + layout.means, 1)}
    values |= {"period": 1.3, "Vx": 0.2, "Vy": 0.05, "Ex": 0.9, "Ey": 0.1}
    values |= {name: rng.normal(0, 0.2, N) for name in layout.local}
    return program.solver, layout.stacked(values), np.array(p)


def central(function, x, step=1e-6):
    """Central differences of a vector function, one column per coordinate."""
    columns = [
        (function(x + step * e) - function(x - step * e)) / (2 * step) for e in np.eye(len(x))
    ]
    return np.array(columns).T


def rows(solver, x, p):
    return np.array(solver.get_function("nlp_g")(x, p)).ravel()


def test_jacobian(program):
    solver, x, p = program
    given = np.array(solver.get_function("nlp_jac_g")(x, p)[1].full())
    np.testing.assert_allclose(given, central(lambda x: rows(solver, x, p), x), atol=2e-6)


def test_hessian(program):
    solver, x, p = program
    lam = np.random.default_rng(2).normal(size=len(rows(solver, x, p)))
    upper = solver.get_function("nlp_hess_l")(x, p, 0.7, lam).full()
    given = np.triu(upper) + np.triu(upper, 1).T

    def gradient(x):
        _, slope = solver.get_function("nlp_grad_f")(x, p)
        return 0.7 * slope.full().ravel() + lam @ solver.get_function("nlp_jac_g")(x, p)[1].full()

    np.testing.assert_allclose(given, central(gradient, x), atol=2e-5)
