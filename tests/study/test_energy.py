"""Net work per metre is what friction takes; gross work is the positive part of the power."""

import numpy as np
import pytest

from rr_opt.mechanics.kinematics import G
from rr_opt.model.gait import FreeGait, SineGait
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.steady_cycle import energy, reference_cycle, steady_cycle
from tests.robots import BENCHMARK, DRY

GAITS = {
    "straight": SineGait(0.6, 1.1),
    "turning": SineGait(0.4, 0.9, 0.3),
    "jumps": FreeGait(1.0, 0.0, 1.0, (-4.0, -4.0, 4.0, 4.0)),
}


@pytest.mark.parametrize("robot", [BENCHMARK, DRY], ids=["viscous", "dry"])
@pytest.mark.parametrize("gait", GAITS.values(), ids=GAITS)
def test_net_work_is_dissipation(robot, gait):
    steady = reference_cycle(robot, gait)
    model = dynamics_of(robot)
    values = np.tile(model.values(robot)[:, None], len(steady.t))
    rate = gait.rate(steady.t)
    lost = np.asarray(model.energy(steady.v[None], steady.phi[None], rate[None], values)[1]).ravel()
    per_metre = np.trapezoid(lost, steady.t) / (abs(steady.speed) * gait.period)
    found = energy(robot, steady_cycle(robot, gait))
    assert found.net == pytest.approx(per_metre, rel=2e-3 if gait.pieces > 1 else 1e-5)


@pytest.mark.parametrize("gait", [GAITS["straight"], GAITS["turning"]], ids=["straight", "turning"])
def test_gross_work_is_the_positive_power(gait):
    steady = reference_cycle(BENCHMARK, gait, samples=20_000)
    power = np.clip(steady.torque * gait.rate(steady.t), 0, None)
    per_metre = np.trapezoid(power, steady.t) / (abs(steady.speed) * gait.period)
    found = energy(BENCHMARK, steady_cycle(BENCHMARK, gait))
    assert found.gross == pytest.approx(per_metre, rel=1e-4)
    assert found.gross > found.net > 0
    weight = BENCHMARK.mass * G
    assert found.cost_of_transport == pytest.approx(per_metre / weight, rel=1e-4)
