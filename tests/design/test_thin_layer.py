"""Circles that a robot hardly turns on: the gaits that do are a thin, bent layer of the box, and a
climb comes to it from gaits a hundred times as fast and goes along it in a few steps."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.random.problems import draw, turning
from benchmarks.turn.problems import round_
from rr_opt.design.decisions import decisions, settings_of
from rr_opt.design.sines import WAYS, climbed
from rr_opt.design.terrain import Terrain
from rr_opt.sqp import FEASIBLE

SEED = "acc0d7813779831d"


@pytest.mark.parametrize(
    ("number", "radius", "start", "speed"),
    [
        (15_000, -0.402803, (1.137, 0.805, -0.759), 3.3688e-5),
        (35_000, -0.286084, (0.901, 0.877, 0.734), 3.5778e-4),
        (45_000, 0.120670, (0.797, 0.706, 0.828), 2.5062e-4),
        (64_000, 0.239919, (0.305, 0.949, 0.000), 1.2175e-4),
    ],
)
def test_few_steps(number: int, radius: float, start: tuple[float, ...], speed: float) -> None:
    posed = replace(turning(draw(SEED, number)), turn=round_(radius))
    box = decisions(posed)
    (setting,) = settings_of(posed, box)
    terrain = Terrain(setting, box, WAYS[posed.direction])
    ascent, _ = climbed(terrain, np.array([*start, 0.0]))
    assert ascent.converged
    assert ascent.violation <= FEASIBLE
    assert ascent.value == pytest.approx(speed, rel=1e-3)
    assert ascent.iterations < 40


# Amplitude, rad, period, s, offset, rad, and share of the ballast: on the tightest circle, at the
# speed below which a robot stands, with V at right angles to the heading.
TIGHTEST = np.array([0.26699561807, 1.31561913103, -0.07621937633, 0.46814106236])


def _tightest() -> Terrain:
    posed = replace(turning(draw(SEED, 50_001)), turn=round_(-0.038259))
    box = decisions(posed)
    return Terrain(settings_of(posed, box)[0], box, WAYS[posed.direction])


def test_a_start_that_is_hardly_on_the_wrong_side_is_not_turned_round():
    ascent, _ = climbed(_tightest(), TIGHTEST.round(8), 192)
    assert ascent.violation <= FEASIBLE


def test_a_step_along_a_bent_layer_is_shortened_along_it():
    ascent, _ = climbed(_tightest(), TIGHTEST, 768)
    assert ascent.violation <= FEASIBLE
    assert ascent.value > 1.004e-6
