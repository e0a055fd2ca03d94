"""A robot that hardly leaves its place leaves no room for an edge, and the search goes on."""

import numpy as np

from rr_opt.diagnose.explain import nominal, parameters, windows
from rr_opt.diagnose.floor_map import cells_of, likely
from rr_opt.diagnose.racer_proposals import of_patch
from rr_opt.robot.gait import SineGait
from tests.diagnose.made_up import with_effect


def test_one_cell_has_circles_and_no_edge():
    cells = cells_of([np.zeros((5, 2))])
    circles, edges = likely(cells, np.array([-1.0]), np.eye(1))
    assert circles
    assert not edges


def test_nothing_breaks():
    model = with_effect(
        {"servo_offset.offset": 0.1},
        ("servo_offset",),
        gaits=((SineGait(0.05, 1.0), "rest"),),
        seconds=4.0,
    )
    fit = parameters(model, nominal(model, windows(model, [0])))
    assert fit.cost > 2 * fit.count
    circles, edges = of_patch(model, fit)
    assert circles
    assert not edges
