"""The model says it is linear exactly when vdot is affine in v."""

import pytest
from hypothesis import find, given

from rr_opt.motion.dynamics import derive, steady_effects
from tests.mechanics.cases import FIRST_FOUND, REPEATABLE, cases, motion

CHOICES = [(), *((name,) for name in sorted(steady_effects()))]


def bend(case) -> float:
    """Second difference of vdot over v, relative to the values."""
    robot, state = case
    values = [motion(robot, state._replace(v=state.v + step)).vdot for step in (-0.2, 0.0, 0.2)]
    return abs(values[0] - 2 * values[1] + values[2]) / (sum(map(abs, values)) + 1e-6)


@pytest.mark.parametrize("effects", CHOICES, ids="+".join)
def test_flag_tells(effects):
    if not derive(effects).linear:
        find(cases(effects), lambda case: bend(case) > 1e-3, settings=FIRST_FOUND)
        return

    @REPEATABLE
    @given(cases(effects))
    def straight(case):
        assert bend(case) < 1e-10

    straight()
