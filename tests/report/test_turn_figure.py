"""The figure of a turn shows the circle that was asked for, and the path along the arc of it."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import rr_opt as rr
from rr_opt.results.figures.fastest import arc


def test_the_circle_and_the_arc(answer):
    turned = rr.turn(answer.problem, radius=0.5, heading="90 deg")
    ax = Figure().add_subplot()
    arc(ax, turned)
    lines = {line.get_label(): line.get_xydata() for line in ax.lines}
    circle, band, path = (lines[name] for name in ("circle", "turn", "path of P"))
    centre = (circle[0] + circle[180]) / 2
    assert np.hypot(*(circle - centre).T) == pytest.approx(0.5)
    # A quarter of it, counter-clockwise as the robot turns to the left.
    start, end = (np.arctan2(*(band[i] - centre)[::-1]) for i in (0, -1))
    assert (end - start) % (2 * np.pi) == pytest.approx(np.pi / 2)
    # P oscillates about it from end to end.
    assert np.abs(np.hypot(*(path - centre).T) - 0.5).max() < 0.05
    assert np.hypot(*(path[-1] - band[-1])) < 0.05
