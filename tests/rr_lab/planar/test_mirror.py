"""The mirrored gait with what is hidden mirrored makes the mirrored path."""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from tests.rr_lab.planar.driven import channels, driven
from tests.rr_lab.reduced import LONG

GAIT, MIRRORED = SineGait(0.6, 1.0, 0.2), SineGait(-0.6, 1.0, -0.2)
FLIPPED = np.array([[1.0], [-1.0], [-1.0], [-1.0]])
ODD = (
    ("com_offset", {"d1": 8e-3, "d2": -5e-3}),
    ("left_right_drag", {"asymmetry1": 0.6, "asymmetry2": 0.3}),
    ("axle_misalignment", {"toe1": 0.02, "toe2": -0.03}),
    ("servo_offset", {"offset": 0.02}),
)
EVEN = (
    ("coulomb_friction", {"force1": 5e-3, "force2": 8e-3}),
    ("lateral_slip", {"mu": 0.02}),
    ("servo_backlash", {"width": 0.02}),
    ("loose_pin", {"clearance": 2e-3}),
    ("compliant_platform", {"give": 0.3}),
    ("shifting_load", {"mass": 0.1, "stiffness": 5.0}),
)


@pytest.mark.parametrize("use", [None, *ODD, *EVEN], ids=lambda use: use[0] if use else "nothing")
def test_mirror_image(use):
    sign = -1 if use in ODD else 1
    turned = [(use[0], {key: sign * value for key, value in use[1].items()})] if use else []
    one = channels(driven(LONG, GAIT, 2.0, "rest", *([use] if use else [])))
    other = channels(driven(LONG, MIRRORED, 2.0, "rest", *turned))
    np.testing.assert_allclose(other, FLIPPED * one, atol=1e-8)
    if use:
        plain = channels(driven(LONG, GAIT, 2.0, "rest"))
        assert np.abs(one - plain).max() > 5e-5
