"""Effects that the reduced model has too move both plants alike."""

import pytest

from rr_lab.case import record
from rr_opt.model.gait import SineGait
from rr_opt.model.robot import EffectUse
from tests.rr_lab.reduced import LONG, fitted, with_physics

GAIT = SineGait(0.7, 1.2, 0.15)
USES = (
    EffectUse("coulomb_friction", {"force1": 1.5e-3, "force2": 0.5e-3}),
    EffectUse("quadratic_drag", {"coefficient_total": 0.4}),
    EffectUse("wheel_inertia", {"J": 4e-5}),
)


@pytest.mark.parametrize("use", USES, ids=lambda use: use.name)
def test_same_motion(use):
    seen = record(LONG, GAIT, 4.8, "running", [use])
    without = fitted(LONG, GAIT, seen).rms
    within = fitted(with_physics(LONG, use), GAIT, seen).rms
    assert without > 1.0
    assert within < 0.01 * without
