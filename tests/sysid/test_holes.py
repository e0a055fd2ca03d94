"""A recording with a hole is cut into parts that each have a step to simulate, and is stepped
through the hole as elsewhere."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer.model import _travelled
from rr_opt.machines.racer.observed import observed
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.sysid.model import Data, Request, Segment, segments
from tests.sysid.made_up import experiment, predicted, with_effect


@pytest.mark.parametrize("until", [50, 99])
def test_no_part_lies_in_a_hole(until):
    t = np.linspace(0.0, 1.0, 100)
    t[until:] += 3.0
    y = np.zeros((100, 1))
    parts = segments({0: Data("run", t, y, np.ones_like(y), False)}, 0.125)
    assert all(one.first < one.last for one in parts)
    assert [one.until for one in parts[:-1]] == [one.first for one in parts[1:]]
    assert (parts[0].first, parts[-1].until) == (0, 100)


@pytest.mark.parametrize("effects", [(), ("lateral_slip",)])
def test_where_rows_are_missing_the_steps_are_as_short(effects):
    given = experiment(seconds=6.0, rate=100.0)
    kept = np.r_[:101, 200:301, 302:601]
    empty = RollerRacer(given)
    run = given.runs[1]
    recording = replace(
        run.recording,
        t=run.recording.t[kept],
        **{
            part: {name: column[kept] for name, column in getattr(run.recording, part).items()}
            for part in ("values", "sigma", "flags")
        },
    )
    runs = (given.runs[0], replace(run, recording=recording))
    lacking = RollerRacer(replace(given, runs=runs))
    start = np.array([0.0, 0.0, 0.3, 0.05, 0.0, 0.0])
    made, expected = (predicted(model, 1, {}, effects, start) for model in (lacking, empty))
    data = lacking.runs[1]
    np.testing.assert_allclose(data.t, empty.runs[1].t, atol=1e-9)
    np.testing.assert_array_equal(np.flatnonzero(np.isfinite(data.values[:, 0])), kept)
    assert made == pytest.approx(expected, abs=1e-6)


def test_late_rows_are_no_missing_ones():
    given = experiment(seconds=3.0, rate=100.0)
    (run, *_) = given.runs
    late = run.recording.t + 0.003 * np.random.default_rng(0).uniform(-1, 1, len(run.recording))
    late[100] += 0.006
    recording = replace(run.recording, t=late)
    model = RollerRacer(replace(given, runs=(replace(run, recording=recording),)))
    np.testing.assert_array_equal(model.runs[0].t, late)


@pytest.mark.parametrize("lost", [[0], [2], [0, 1, 2]])
def test_a_part_without_data_begins_at_the_nearest(lost):
    model = with_effect({}, ())
    part = Segment(1, 200, 400, 400)
    data = model.runs[1]
    data.values[190:410, lost] = np.nan
    start = model.initial_state(part, (), {})
    np.testing.assert_array_equal(start[lost], data.values[189, lost])
    (seen,) = observed(model, [Request(part, {}, start)], ())
    assert np.isfinite([seen.x, seen.y, seen.psi]).all()
    assert np.isfinite(seen.u).all()


@pytest.mark.parametrize("first", [0, 1])
def test_the_usual_speed_where_every_other_place_is_missing(first):
    model = with_effect({}, ())
    run, *others = model.experiment.runs
    values = {name: column.copy() for name, column in run.recording.values.items()}
    for name in ("x", "y", "psi"):
        values[name][first::2] = np.nan
    recording = replace(run.recording, values=values)
    sparse = replace(model.experiment, runs=(replace(run, recording=recording), *others))
    assert RollerRacer(sparse).setting.speed == pytest.approx(model.setting.speed, rel=0.2)


def test_a_run_is_travelled_to_its_end():
    model = with_effect({}, (), seconds=0.9)
    way = _travelled(model.runs[1])
    whole = np.hypot(*(model.runs[1].values[-1, :2] - model.runs[1].values[0, :2]))
    assert way[-1] > 0.9 * whole
