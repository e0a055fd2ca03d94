"""The quadratures give what two simulations a little apart differ by, starts re-fitted."""

import numpy as np
import pytest

from rr_opt.array import Array
from rr_opt.machines.racer.stages.gram import values_of
from rr_opt.machines.racer.stages.reference import SHAPES, Reference, linearised, path, reference
from rr_opt.machines.racer.stages.respond import path_of, start_of
from rr_opt.sysid.candidate import whole
from tests.sysid.stages.world import recorded

STEPS = {
    "quadratic_drag.coefficient_total": 1e-3,
    "left_right_drag.asymmetry1": 1e-3,
    "axle_misalignment.toe1": 1e-5,
    "axle_misalignment.toe2": 1e-5,
    "floor_tilt.tilt_x": 1e-6,
    "com_offset.d1": 1e-5,
}
START = np.array([0.1, -0.2, 0.3, 0.2])


def without_start(ref: Reference, moved: Array) -> Array:
    free = start_of(ref, slice(0, ref.t.size), held=False)[:, :3].reshape(-1, 4)
    column = moved.reshape(-1)
    return column - free @ np.linalg.lstsq(free, column, rcond=None)[0]


@pytest.mark.parametrize("name", STEPS)
def test_a_push_moves_the_robot_as_in_a_simulation(name):
    model = recorded({}, seed=0)
    piece = whole(model, [0])[0]
    still = model.respond(piece, {}, SHAPES, START).predicted
    ref = reference(path(model, 0, still, follow=False), values_of(model.nominal))
    pushes = ref.by_p[:, :, [linearised()[0].parameters.index(name)]]
    moved = path_of(ref, pushes, piece.span, held=False)[:, :3, 0]
    ends = [
        model.respond(piece, {name: sign * STEPS[name]}, SHAPES, START).predicted[:, :3]
        for sign in (1, -1)
    ]
    slope = (ends[0] - ends[1]) / (2 * STEPS[name])
    expected = without_start(ref, slope)
    # The path has some of the noise of the data.
    off = np.linalg.norm(without_start(ref, moved) - expected)
    assert off < 0.01 * np.linalg.norm(expected)
