"""What held-out recordings say counts only beyond what any model of the machine is off by."""

from dataclasses import replace

import pytest

from rr_opt.sysid.candidate import FLOOR, Chosen
from rr_opt.sysid.verdict import confidence, verdict_of
from tests.sysid.made_up import base_of, with_effect


@pytest.fixture(scope="module")
def base():
    return base_of(with_effect({}, ()))


@pytest.mark.parametrize(
    ("nominal", "held", "inexact", "verdict"),
    [
        (0.0, 0.0, 0.0, "consistent"),
        (0.5, 0.5, 0.0, "unexplained"),
        (0.5, 0.5, 0.6, "consistent"),
        (0.7, 0.7, 0.6, "unexplained"),
        # Bent parameters predict worse than those that were believed.
        (0.2, 1.3, 0.0, "consistent"),
    ],
)
def test_without_effects(base, nominal, held, inexact, verdict):
    flags = {"moved": False, "rough": False, "systematic": False}
    assert verdict_of(base, base, nominal, (held, held), inexact, **flags) == verdict


@pytest.mark.parametrize(
    ("held", "inexact", "verdict"),
    [
        (0.45, 2.0, "missing_physics"),
        (0.45, 0.0, "unexplained"),
        # What was fitted is at the noise: it is not the machine that no model has exactly.
        (1.8, 2.0, "unexplained"),
    ],
)
def test_with_effects(base, held, inexact, verdict):
    best = replace(base, chosen=(Chosen("floor_tilt"),))
    flags = {"moved": False, "rough": False, "systematic": False}
    assert verdict_of(best, base, 5.0, (4.0, held), inexact, **flags) == verdict


@pytest.mark.parametrize(
    ("without", "sure"), [(10 * FLOOR, 0.99), (2 * FLOOR, 0.75), (FLOOR / 2, 1.0)]
)
def test_a_name_is_no_surer_than_what_it_was_seen_to_explain(base, without, sure):
    best = replace(base, chosen=(Chosen("floor_tilt"),))
    assert confidence(best, [], without) == pytest.approx(sure)
