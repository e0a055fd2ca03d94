"""The fit recovers a known robot, p is Student's, and a rebuilt robot has its ratio."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from rr_opt.model.gait import SineGait
from rr_opt.motion.steady_cycle import steady_cycle
from rr_paper import consistency
from rr_paper.consistency import Hypothesis, predicted
from rr_paper.prototype import ABOUT_P, DEFINITIONS, prototype
from rr_paper.publication import ROWS
from rr_paper.signs import CORRECTED
from tests.mechanics.cases import REPEATABLE, numbers

TRUTH = {"a1": 0.01, "a2": -0.005, "b": 0.05, "k": 0.12}
ROBOTS = st.builds(
    prototype, numbers(-0.03, 0.03), numbers(-0.03, 0.03), numbers(0.02, 0.08), numbers(0.01, 1.0)
)


def name(definition):
    return definition.name


def test_a_known_robot_is_recovered(monkeypatch):
    speeds = -predicted(prototype(**TRUTH), ABOUT_P, 1.1)
    rows = tuple(replace(row, mean=float(v)) for row, v in zip(ROWS, speeds, strict=True))
    monkeypatch.setattr(consistency, "ROWS", rows)
    found = consistency.fit(ABOUT_P, "mean", fixed={"b": 0.05})
    assert found.chi2 < 1e-4
    assert found.values["k"] == pytest.approx(TRUTH["k"], rel=0.1)
    assert found.values["amplitude"] == pytest.approx(1.1, rel=0.1)
    assert found.free == 4


def test_p_of_one_square():
    one = consistency.RowFit({}, (), 4.303**2, len(ROWS) - 1)
    p = Hypothesis("ratio", "", ABOUT_P, CORRECTED, "mean", one).p
    assert p == pytest.approx(2 * stats.t.sf(4.303, 2), abs=2e-3)


@pytest.mark.parametrize("definition", DEFINITIONS, ids=name)
def test_the_nine_speeds_are_those_of_the_integrator(definition):
    robot, amplitude = prototype(0.01, -0.01, 0.05, 0.12), 1.2
    if definition.name.endswith("66 g"):
        robot = prototype(0.0, 0.0, 0.05, 0.12)
    expected = [
        steady_cycle(
            definition.build(robot, row.ratio), SineGait(row.amplitude or amplitude, row.period)
        ).speed
        for row in ROWS
    ]
    np.testing.assert_allclose(predicted(robot, definition, amplitude), expected, rtol=1e-6)


def test_no_speed_beyond_the_singular_posture():
    robot = prototype(0.03, -0.03, 0.05, 0.12)
    found = predicted(robot, ABOUT_P, robot.singular_angle + 0.01)
    assert np.isnan(found[:3]).all()
    assert np.isfinite(found[3:]).all()


@pytest.mark.parametrize("definition", DEFINITIONS, ids=name)
def test_a_rebuilt_robot_has_the_ratio(definition):
    @REPEATABLE
    @given(ROBOTS, numbers(0.14, 0.3))
    def rebuilt(robot, ratio):
        assert definition.ratio(definition.build(robot, ratio)) == pytest.approx(ratio, rel=1e-9)

    rebuilt()
