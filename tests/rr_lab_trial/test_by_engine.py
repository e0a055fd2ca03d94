"""Each engine's counts are those of its own cases, and together they are all."""

import pytest

from rr_lab.trial.statistics import COUNTS, by_engine
from tests.rr_lab_trial.made_up import case, said, truth

DRAG = "quadratic_drag"
VALUES = {DRAG: {"coefficient_total": 0.5}}
RIGHT = said("missing_physics", DRAG, intervals={DRAG: {"coefficient_total": (0.4, 0.6)}})
OFF = said("missing_physics", DRAG, intervals={DRAG: {"coefficient_total": (0.6, 0.7)}})
CASES = (
    case(truth("null"), said("consistent"), "001"),
    case(truth("null", engine="planar"), said("parameters", "m1"), "002"),
    case(truth("single", DRAG, values=VALUES), RIGHT, "003"),
    case(truth("single", DRAG, values=VALUES, engine="planar"), OFF, "004"),
    case(truth("single", DRAG, values=VALUES, engine="planar"), None, "005"),
)


def counted(engine, name):
    found = by_engine(CASES)[engine][name]
    return found.count, found.total


def test_counts_by_hand():
    assert counted("mujoco", "single") == (1, 1)
    assert counted("planar", "single") == (1, 2)
    assert counted("mujoco", "false_claims") == (0, 1)
    assert counted("planar", "false_claims") == (1, 1)
    assert counted("mujoco", "coverage") == (1, 1)
    assert counted("planar", "coverage") == (0, 1)


@pytest.mark.parametrize("count", COUNTS, ids=lambda count: count.name)
def test_they_add_up(count):
    parts = [counted(engine, count.name) for engine in by_engine(CASES)]
    whole = count.rate(CASES)
    assert tuple(map(sum, zip(*parts, strict=True))) == (whole.count, whole.total)


def test_an_engine_that_drove_nothing_is_left_out():
    assert list(by_engine(CASES[:1])) == ["mujoco"]
