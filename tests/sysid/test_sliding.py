"""Wheels that slide: how a run begins, and from where to look for their grip."""

import numpy as np
import pytest

from rr_opt.machines.racer.proposals import of_slip
from rr_opt.machines.racer.simulation import side_speeds
from rr_opt.sysid.candidate import nominal, parameters, windows
from rr_opt.sysid.model import Piece
from tests.sysid.made_up import GAITS, ROBOT, with_effect

SLIDES = {"lateral_slip.mu": 0.012}


def axle_places(x, y, psi, phi):
    """Where the axles' centres are, from the joint's place; the second trails by c2."""
    one = np.array([x + ROBOT.platform1.c * np.cos(psi), y + ROBOT.platform1.c * np.sin(psi)])
    behind = psi + phi
    two = np.array([x - ROBOT.platform2.c * np.cos(behind), y - ROBOT.platform2.c * np.sin(behind)])
    return one, two


def test_side_speeds_are_those_of_the_axles_places():
    gait, t = GAITS[1][0], 5.0 + np.arange(40) / 100
    dt = t - t[0]
    x, y, psi = 0.2 + 0.1 * dt - 0.2 * dt**2, 0.05 * dt, 1.0 - 0.7 * dt + 0.3 * dt**2
    seen = side_speeds(ROBOT, gait, t, np.column_stack([x, y, psi, gait.angle(t)]))
    step = 1e-5
    before, after = (
        axle_places(0.2 + 0.1 * d, 0.05 * d, 1.0 - 0.7 * d, gait.angle(np.array([t[0] + d]))[0])
        for d in (-step, step)
    )
    for k, heading in enumerate((1.0, 1.0 + gait.angle(t[:1])[0])):
        velocity = (after[k] - before[k]) / (2 * step)
        across = velocity @ [-np.sin(heading), np.cos(heading)]
        assert seen[k] == pytest.approx(across, abs=1e-6)


@pytest.fixture(scope="module")
def sliding():
    return with_effect(SLIDES, ("lateral_slip",))


def test_a_piece_may_begin_while_the_wheels_slide(sliding):
    piece = Piece(1, 40, 240)
    start = sliding.start(piece)
    response = sliding.respond(piece, SLIDES, ("lateral_slip",), start, ())
    _, by_start = response.slopes
    step = 1e-4
    for k in (4, 5):
        moved = [
            sliding.respond(piece, SLIDES, ("lateral_slip",), start + way * np.eye(6)[k]).predicted
            for way in (-step, step)
        ]
        change = (moved[1] - moved[0]) / (2 * step)
        assert np.abs(by_start[:, :, k] - change).max() < 0.1 * np.abs(change).max()
        assert np.abs(change).max() > 0.01


def test_a_grip_is_found_behind_parameters_bent_to_imitate_it(sliding):
    bent = parameters(sliding, nominal(sliding, windows(sliding, range(len(sliding.runs)))))
    forms = sliding.catalogue["lateral_slip"].forms
    (best,) = of_slip(sliding, "lateral_slip", len(forms) - 1, bent)
    assert best.values["lateral_slip.mu"] == pytest.approx(SLIDES["lateral_slip.mu"], rel=0.3)
    assert best.gain > 0.5 * (bent.cost - bent.count)
    # What is left of that form once it is found is not looked for by itself.
    assert of_slip(sliding, "lateral_slip", 1, bent) == []
