"""A push as a function of time moves the robot as the effect does that pushes so."""

import numpy as np
import pytest

from rr_opt.machines.racer.observed import observed
from rr_opt.machines.racer.unknown_input import respond
from rr_opt.sysid.model import Piece
from tests.sysid.made_up import with_effect

PIECE = Piece(1, 0, 300)


def _pushes(name, along, nominal):
    """The effect's force, or angle, along the path, for one unit of its parameter."""
    out = np.zeros((7, along.t.size))
    if name == "coulomb_friction.force1":
        out[:2] = -np.tanh(along.u[:2] / 0.002)
    if name == "coulomb_friction.force2":
        out[2:4] = -np.tanh(along.u[2:] / 0.002)
    if name == "kappa1":
        out[:2] = -along.u[:2] / nominal["h"] ** 2
    if name == "servo_offset.offset":
        out[6] = 1.0
    return out


@pytest.mark.parametrize(
    "name", ["coulomb_friction.force1", "coulomb_friction.force2", "kappa1", "servo_offset.offset"]
)
def test_its_derivative_is_that_of_the_effect(name):
    model = with_effect({}, ())
    start = model.start(PIECE)
    effects = ("coulomb_friction", "servo_offset")
    by_effect = model.respond(PIECE, {}, effects, start, (name,)).by_value
    # Where the path is not what was recorded, the pushes are not those along it.
    at_rest = model.respond(PIECE, {}, (), start).predicted
    model.runs[1].values[PIECE.span] = at_rest
    along = observed(model, PIECE, {}, (), start)
    pushes = _pushes(name, along, model.nominal)[None]
    out = respond(model, PIECE, {}, (), start, (), pushes, np.zeros(1))
    assert by_effect is not None
    size = np.abs(by_effect[:, :3]).max(axis=0)
    off = np.abs(out.by_push - by_effect)[:, :3].max(axis=0)
    assert (off < 0.02 * size).all()


def test_what_is_pushed_goes_where_the_derivative_says():
    model = with_effect({}, ())
    start = model.start(PIECE)
    along = observed(model, PIECE, {}, (), start)
    pushes = np.zeros((2, 7, along.t.size))
    pushes[0, :2], pushes[1, 4] = 1.0, np.sin(along.t)
    for amounts in np.diag([1e-5, 1e-4]):
        there, back = (
            respond(model, PIECE, {}, (), start, (), pushes, way * amounts) for way in (1, -1)
        )
        moved = (there.predicted - back.predicted) / 2
        said = there.by_push @ amounts
        assert np.abs(moved - said).max() < 0.01 * np.abs(said).max()
