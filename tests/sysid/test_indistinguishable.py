"""Names that the recordings cannot tell apart are named together, and those they can are not."""

import math

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.sysid.candidate import Chosen
from rr_opt.sysid.indistinguishable import _Pass, alike, groups, margin
from tests.sysid.made_up import base_of, explained, search_of, with_effect

LATE = Chosen("clock_offset")
RUNNING = ((SineGait(0.5, 1.2), "running"), (SineGait(0.6, 1.2, 0.2), "running"))


def _late_clock(offset: float, **about):
    model = with_effect({"clock_offset.offset": offset}, ("clock_offset",), **about)
    base = base_of(model)
    best = explained(model, base, LATE)
    return model, base, best


def test_a_late_servo_and_a_late_clock_are_one_thing_where_no_run_starts_from_rest():
    model, base, best = _late_clock(-0.004, gaits=RUNNING)
    found = groups(search_of(model, base, best), best)
    assert [group[0] for group in found] == ["clock_offset"]
    assert "servo_lag" in found[0]


def test_runs_from_rest_and_of_many_periods_tell_them_apart():
    model, base, best = _late_clock(-0.06)
    assert groups(search_of(model, base, best), best) == ()


@pytest.fixture(scope="module")
def coulomb():
    values = {"coulomb_friction.force1": 0.006, "coulomb_friction.force2": 0.006}
    model = with_effect(values, ("coulomb_friction",))
    base = base_of(model)
    return model, base, explained(model, base, Chosen("coulomb_friction"))


def test_friction_that_is_plain_to_see_is_in_no_group(coulomb):
    model, base, best = coulomb
    search = search_of(model, base, best)
    assert groups(search, best) == ()
    assert all(0 <= one.left <= 1 for one in alike(search, best) if not math.isnan(one.left))


def test_what_was_fitted_as_well_is_in_the_group_whatever_the_linearised_pass_says(coulomb):
    model, base, best = coulomb
    drag = explained(model, base, Chosen("quadratic_drag"))
    search = search_of(model, base, best, drag)
    fitted = {one.other: one for one in alike(search, best)}[("quadratic_drag",)]
    assert fitted.separation <= drag.score - best.score
    assert (drag.score - best.score < margin(best.whole)) == any(
        "quadratic_drag" in group for group in groups(search, best)
    )


def test_of_a_signature_its_double_leaves_little_and_a_stranger_nearly_all():
    model, base, best = _late_clock(-0.004, gaits=RUNNING)
    left = {one.other: one.left for one in alike(search_of(model, base, best), best)}
    assert left[("servo_lag",)] < 0.1
    assert left[("floor_tilt",)] > 0.9


def test_what_the_runs_hardly_see_may_be_below_zero_by_rounding():
    seen = np.diag([1e12, 1e12, 1.0])
    seen[0, 1] = seen[1, 0] = 1e12 * (1 + 1e-12)
    far = np.full(3, 10.0)
    pass_ = _Pass((), seen, np.array([0.0, 0.0, 2.0]), -far, far)
    assert np.linalg.eigvalsh(seen)[0] < 0
    assert pass_.left([0, 1], [2]) == pytest.approx(4.0)
    assert _Pass((), seen, np.array([0.0, 2.0, 0.0]), -far, far).left([0], [1]) < 1e-3 * 4e12
