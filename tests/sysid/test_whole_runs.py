"""How a model predicts whole runs, and on which of them guesses are tried."""

from dataclasses import replace

import pytest

from rr_opt.model.gait import SineGait
from rr_opt.sysid.candidates import trial_problem
from rr_opt.sysid.estimation import fitted, whole_runs
from rr_opt.sysid.settings import SETTINGS
from tests.sysid.made_up import base_of, with_effect

FAST = (
    (SineGait(0.95, 0.8, 0.27), "rest"),
    (SineGait(1.0, 1.0), "running"),
    (SineGait(0.9, 0.9, -0.2), "running"),
)


def test_a_fit_of_segments_leads_to_one_of_whole_runs():
    """Wheels that slide have many minima over whole runs: straight from the segments with much
    process noise, 13 sigma are left."""
    effects = ("lateral_slip",)
    model = with_effect({"lateral_slip.mu": 0.3}, effects, gaits=FAST, seconds=30.0)
    plain = base_of(model).fit
    values = {**plain.values, "lateral_slip.creep_compliance": 0.0, "lateral_slip.mu": 0.24}
    states = {one: model.initial_state(one, effects, values) for one in plain.problem.segments}
    bent = fitted(replace(plain.problem, effects=effects, values=values), values, states)
    assert bent.problem.q > SETTINGS.least_process_noise
    assert whole_runs(bent).excess < 4.0


@pytest.mark.parametrize(("tilt", "count"), [(0.0, 4), (0.004, SETTINGS.trial_runs)])
def test_guesses_are_tried_on_all_runs_where_each_is_explained(tilt, count):
    hidden = {"floor_tilt.tilt_x": tilt, "floor_tilt.tilt_y": 0.0}
    fit = base_of(with_effect(hidden, ("floor_tilt",))).fit
    assert len(trial_problem(fit.problem, fit).by_run) == count
