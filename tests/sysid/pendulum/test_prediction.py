"""The pendulum's motion is SciPy's, and its derivatives are those of its differences."""

import numpy as np
import pytest

from rr_opt.machines.pendulum.effects import EXTRAS
from rr_opt.machines.pendulum.pendulum import Pendulum, Swing
from rr_opt.sysid.model import Piece
from tests.sysid.pendulum.made import ML, B, J, swing, torque_of

START = np.array([0.4, -0.5])
T = np.arange(0.0, 4.0, 0.01)
WHOLE = Piece(0, 0, T.size)


def driven(seed):
    torque = torque_of(np.random.default_rng(seed))
    swings = [Swing("one", T, swing(torque, T, start=START), torque(T), 1e-3)]
    return torque, Pendulum(swings, {"J": J, "ml": ML, "b": B}, {})


@pytest.mark.parametrize(
    ("hidden", "name"),
    [
        ({}, None),
        ({"dry": 0.03}, "coulomb_friction.torque"),
        ({"drag": 0.01}, "quadratic_drag.coefficient"),
        ({"offset": 0.05}, "torque_offset.torque"),
    ],
)
def test_motion(hidden, name):
    torque, model = driven(3)
    values = {name: next(iter(hidden.values()))} if name else {}
    effects = (name.split(".")[0],) if name else ()
    made = model.respond(WHOLE, values, effects, START).predicted[:, 0]
    assert np.abs(made - swing(torque, T, start=START, **hidden)).max() < 5e-4


@pytest.mark.parametrize("effect", [name for name in EXTRAS if "friction" not in name])
def test_derivatives(effect):
    _, model = driven(4)
    name = EXTRAS[effect].quantity
    values = {name: 0.3 * model.catalogue[effect].forms[0].quantities[0].scale}
    out = model.respond(WHOLE, values, (effect,), START, (name, "J", "ml", "b"))
    by_value, by_start = out.slopes
    given = {**model.nominal, **values}
    for k, own in enumerate((name, "J", "ml", "b")):
        step = 1e-4 * given[own]
        ends = [
            model.respond(WHOLE, {**given, own: given[own] + s}, (effect,), START).predicted
            for s in (step, -step)
        ]
        slope = (ends[0] - ends[1]) / (2 * step)
        assert by_value[:, :, k] == pytest.approx(slope, abs=0.02 * np.abs(slope).max())
    for k in range(2):
        step = 1e-5 * np.eye(2)[k]
        ends = [model.respond(WHOLE, values, (effect,), START + s).predicted for s in (step, -step)]
        slope = (ends[0] - ends[1]) / 2e-5
        assert by_start[:, :, k] == pytest.approx(slope, abs=0.02 * np.abs(slope).max())
