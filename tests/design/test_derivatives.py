"""The hand-assembled Jacobian and Hessian of the program are the derivatives of its rows."""

import numpy as np
import pytest

from rr_opt.design.interval import LIMITS
from rr_opt.design.multiple_shooting import shooting
from rr_opt.physics.dynamics import derive
from tests.robots import BENCHMARK, DRY

N = 8


@pytest.fixture(params=["inertia", "loads", "dry"])
def program(request):
    robot = DRY if request.param == "dry" else BENCHMARK
    by = "loads" if request.param == "loads" else "inertia"
    dynamics = derive(tuple(use.name for use in robot.physics))
    ballast = [0.0, 3.0] if by == "loads" else [5e-4, 2e-3]
    phases = np.array([0.0, 0.11, 0.25, 0.4, 0.5, 0.66, 0.75, 0.9])
    p = np.concatenate([dynamics.values(robot), [0.066, 0.05, 0.03], ballast, [-1.0], phases])
    rng = np.random.default_rng(1)
    x = np.concatenate(
        [[0.7, 1.3, 0.2, 0.4, 0.1], [0.2, 0.05, 0.9, 0.1], rng.normal(0, 0.2, 2 * N)]
    )
    return shooting(dynamics.effects, by, N).solver, x, p


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
    count = 2 * N + 4 + len(LIMITS) + N
    lam = np.random.default_rng(2).normal(size=count)
    upper = solver.get_function("nlp_hess_l")(x, p, 0.7, lam).full()
    given = np.triu(upper) + np.triu(upper, 1).T

    def gradient(x):
        _, slope = solver.get_function("nlp_grad_f")(x, p)
        return 0.7 * slope.full().ravel() + lam @ solver.get_function("nlp_jac_g")(x, p)[1].full()

    np.testing.assert_allclose(given, central(gradient, x), atol=2e-5)
