"""The pendulum's motion is SciPy's, and its linearisation is that of its differences."""

import numpy as np
import pytest

from rr_opt.machines.pendulum.effects import EXTRAS
from rr_opt.machines.pendulum.pendulum import Pendulum, Swing
from rr_opt.sysid.model import Request, Segment
from tests.sysid.pendulum.made import ML, B, J, swing, torque_of

START = np.array([0.4, -0.5])
T = np.arange(0.0, 4.0, 0.01)
WHOLE = Segment(0, 0, T.size, T.size - 1)


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
    made = model.predicted(Request(WHOLE, values, START), effects)[:, 0]
    assert np.abs(made - swing(torque, T, start=START, **hidden)).max() < 5e-4


@pytest.mark.parametrize("effect", [name for name in EXTRAS if "friction" not in name])
def test_linearisation(effect):
    _, model = driven(4)
    name = EXTRAS[effect].quantity
    given = model.nominal | {name: 0.3 * model.catalogue[effect].forms[0].quantities[0].scale}
    wanted = (name, "J", "ml", "b")
    (found,) = model.linearise([Request(WHOLE, given, START)], (effect,), wanted)
    moves = [({}, 1e-5 * unit, 1e-5) for unit in np.eye(2)]
    moves += [({own: 1e-4 * given[own]}, np.zeros(2), 1e-4 * given[own]) for own in wanted]
    columns, ends = [], []
    for change, start, step in moves:
        up, down = model.simulate(
            [
                Request(
                    WHOLE,
                    {**given, **{own: given[own] + way * by for own, by in change.items()}},
                    START + way * start,
                )
                for way in (1, -1)
            ],
            (effect,),
        )
        columns.append((up.residuals - down.residuals).ravel() / (2 * step))
        ends.append((up.end - down.end) / (2 * step))
    (here,) = model.simulate([Request(WHOLE, given, START)], (effect,))
    J_ = np.column_stack([*columns, here.residuals.ravel()])
    size = np.linalg.norm(J_, axis=0)
    assert np.abs(found.gram - J_.T @ J_) / np.outer(size, size) == pytest.approx(0.0, abs=0.03)
    end = np.column_stack(ends)
    assert found.end == pytest.approx(end, abs=0.02 * np.abs(end).max())
