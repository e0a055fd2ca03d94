"""Effects that the reduced model has too move both plants alike."""

import pytest

from rr_lab.case import record
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG, fitted, with_physics

GAIT = SineGait(0.7, 1.2, 0.15)
USES = (
    ("coulomb_friction", {"force1": 1.5e-3, "force2": 0.5e-3}, {}),
    ("quadratic_drag", {"coefficient_total": 0.4}, {}),
    ("wheel_inertia", {"J": 4e-5}, {}),
    ("dragged_cable", {"force": 8e-3}, {"force2": 8e-3}),
    (
        "stribeck_friction",
        {"force": 3e-3, "speed": 0.2},
        {"force1": 3e-3, "force2": 3e-3, "sliding": 1 / 3, "speed": 0.2},
    ),
)
"""Name, values for the laboratory, and those for the reduced model where these are others."""


@pytest.mark.parametrize(("name", "hidden", "modelled"), USES, ids=lambda each: str(each)[:20])
def test_same_motion(name, hidden, modelled):
    seen = record(LONG, GAIT, 4.8, "running", [EffectUse(name, hidden)])
    without = fitted(LONG, GAIT, seen).rms
    robot = with_physics(LONG, EffectUse(name, modelled or hidden))
    within = fitted(robot, GAIT, seen).rms
    assert without > 1.0
    # Both have an onset of their own of a cable's friction.
    assert within < (0.02 if name == "dragged_cable" else 0.01) * without
