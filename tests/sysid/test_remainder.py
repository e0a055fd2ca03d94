"""What is left of a fit points to where it enters and to what it depends on."""

from dataclasses import replace

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.unknown_input import unknown_terms
from rr_opt.sysid.remainder import dependences
from tests.sysid.made_up import base_of, with_effect

COULOMB = {"coulomb_friction.force1": 0.005, "coulomb_friction.force2": 0.003}
TILT = {"floor_tilt.tilt_x": 0.004, "floor_tilt.tilt_y": 0.002}


def left(values, effects):
    """Beside a fit of a robot whose wheels' friction is known, lest that imitates anything."""
    made = with_effect(values, effects).experiment
    known = {name: one for name, one in made.uncertainty.items() if "kappa" not in name}
    model = RollerRacer(replace(made, uncertainty=known))
    fit = base_of(model).fit
    return dependences(fit, *unknown_terms(model, fit))


@pytest.mark.parametrize(
    ("values", "effect", "channel", "variable"),
    [(COULOMB, "coulomb_friction", "rolling", "speed"), (TILT, "floor_tilt", "rolling", "heading")],
)
def test_it_points_there(values, effect, channel, variable):
    first = left(values, (effect,))[0]
    assert (first.channel, first.variable) == (channel, variable)
    assert first.p_value < 1e-6
    assert first.share > 0.1


def test_nothing_is_left_of_a_right_model():
    assert all(one.p_value > 1e-6 for one in left({}, ()))
    assert max(one.gain - one.degrees for one in left({}, ())) < 20
