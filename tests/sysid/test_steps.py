"""A run is predicted as exactly with the steps it gets as with shorter ones."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer import drive as racer_steps
from rr_opt.machines.racer.drive import steps_of
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.simulation import driven
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait
from rr_opt.sysid.model import Request, segments
from rr_opt.sysid.shooting import predict
from tests.sysid.made_up import experiment, predicted, whole

VALUES = {
    "": {},
    "servo_rate_limit": {"servo_rate_limit.rate_limit": 2.0},
    "lateral_slip": {"lateral_slip.creep_compliance": 0.01, "lateral_slip.mu": 10.0},
}


@pytest.mark.parametrize("effect", VALUES)
@pytest.mark.parametrize("rate", [25.0, 50.0])
def test_as_at_200_a_second(effect, rate):
    paths = []
    for often in (rate, 200.0):
        model = RollerRacer(experiment(seconds=8.0, rate=often))
        effects = (effect,) if effect else ()
        start = np.array([0.0, 0.0, 0.3, 0.05, 0.0, 0.0])
        paths.append(predicted(model, 1, VALUES[effect], effects, start))
    fine = paths[1][:: int(200 / rate)]
    assert paths[0] == pytest.approx(fine, abs=5e-5)


@pytest.mark.parametrize("effect", ["servo_rate_limit", "coulomb_friction"])
def test_as_with_steps_of_half_a_millisecond(effect, monkeypatch):
    values = VALUES.get(effect) or {f"{effect}.force1": 2e-3, f"{effect}.force2": 1e-3}
    paths = []
    for longest in (None, 5e-4):
        if longest:
            monkeypatch.setattr(racer_steps, "_LONGEST", longest)
            monkeypatch.setattr(racer_steps, "_SHARP", longest)
        model = RollerRacer(experiment(seconds=20.0, rate=100.0))
        start = np.array([0.0, 0.0, 0.3, 0.05, 0.0, 0.0])
        paths.append(predicted(model, 1, values, (effect,), start))
    assert paths[0] == pytest.approx(paths[1], abs=1e-4)


@pytest.mark.parametrize("before", [0.5, 0.503])
@pytest.mark.parametrize(
    ("values", "most"),
    [({}, 1e-4), ({"servo_lag.tau": 0.03}, 5e-6), (VALUES["lateral_slip"], 1.5e-3)],
    ids=["", "servo_lag", "lateral_slip"],
)
def test_a_start_after_the_first_sample(values, most, before, monkeypatch):
    # dphi may jump as the command starts, at a sample or between two.
    effects = tuple({name.split(".")[0] for name in values})
    given = experiment(((SineGait(0.8, 1.0, 0.4), "rest"),), seconds=4.0, rate=100.0)
    (run,) = given.runs
    recording = replace(run.recording, t=run.recording.t - before)
    paths = []
    for longest in (None, 5e-5):
        if longest:
            monkeypatch.setattr(racer_steps, "_LONGEST", longest)
            monkeypatch.setattr(racer_steps, "_SHARP", longest)
            monkeypatch.setattr(racer_steps, "_STIFF", longest)
        model = RollerRacer(replace(given, runs=(replace(run, recording=recording),)))
        paths.append(predicted(model, 0, values, effects, np.zeros(6)))
    assert paths[0] == pytest.approx(paths[1], abs=most)


FAST = ((SineGait(0.95, 0.8, 0.27), "rest"), (SineGait(1.0, 1.0), "running"))


@pytest.mark.parametrize("run", [0, 1])
def test_wheels_that_hold_move_as_without_slip(run):
    model = RollerRacer(experiment(FAST, seconds=20.0, rate=100.0))
    held = {"lateral_slip.creep_compliance": 0.0, "lateral_slip.mu": 9.0}
    start = np.array([0.0, 0.0, 0.3, 0.4 * run, 0.0, 0.0])
    plain = model.converted(Request(whole(model, run), {}, start[:4]), ("lateral_slip",))
    with_slip = predicted(model, run, held, ("lateral_slip",), plain)
    assert with_slip == pytest.approx(predicted(model, run, {}, (), start), abs=5e-4)


def test_sliding_wheels_move_as_with_shorter_steps(monkeypatch):
    values = {"lateral_slip.mu": 0.05}
    paths = []
    for longest in (None, 5e-5):
        if longest:
            monkeypatch.setattr(racer_steps, "_SHARPEST", longest)
        model = RollerRacer(experiment(FAST, seconds=10.0, rate=100.0))
        paths.append(predicted(model, 0, values, ("lateral_slip",), np.zeros(6)))
    assert np.abs(paths[1] - predicted(model, 0, {}, (), np.zeros(6))).max() > 0.1
    assert paths[0] == pytest.approx(paths[1], abs=5e-4)


JUMPING = {"lateral_slip.mu": 1.0, "servo_rate_limit.rate_limit": 3.0}
SLIDING = ("lateral_slip", "servo_rate_limit")


def test_wheels_that_slide_as_the_rate_jumps_do_not_chatter():
    model = RollerRacer(experiment(FAST, seconds=10.0, rate=100.0))
    begin = np.array([0.0, 0.0, 0.3, 0.1, 0.0, 0.0])
    here, there = (predicted(model, 1, JUMPING, SLIDING, begin * (1 + by)) for by in (0.0, 1e-9))
    assert there == pytest.approx(here, abs=1e-7)


def test_a_jump_of_the_rate_moves_steadily_through_stiff_steps():
    model = RollerRacer(experiment(FAST, seconds=1.2, rate=100.0))
    runs, effects = model.simulator, SLIDING
    nodes = []
    for limit in np.linspace(3.0, 3.01, 101):
        given = runs.given({**JUMPING, "servo_rate_limit.rate_limit": limit})
        nodes.append(runs.drive_path(whole(model, 1), given, effects))
    rates = np.array([one.nodes[1, 1] for one in nodes])
    jump = np.abs(np.diff(rates[0])).max()
    across = np.abs(np.diff(rates, axis=0)).max()
    assert np.abs(rates[-1] - rates[0]).max() > 0.5 * jump
    assert across < 0.1 * jump
    bends = np.array([one.nodes[2, 1] * one.h for one in nodes])
    assert np.abs(np.diff(bends, axis=0)).max() < 0.1 * jump


def test_neutral_parameters_are_left_out_of_what_is_predicted():
    model, effects = RollerRacer(experiment(seconds=3.0)), ("lateral_slip",)
    plain, whole = driven(effects, frozenset({"lateral_slip.mu_ratio"}))[0], driven(effects)[0]
    assert plain.rates.n_instructions() < 0.8 * whole.rates.n_instructions()
    segment = segments({0: model.runs[0]})[0]
    values = {"lateral_slip.creep_compliance": 0.01, "lateral_slip.mu": 0.012}
    request = Request(segment, values, np.array([0.0, 0.0, 0.3, 0.05, 0.0, 0.0]))
    ((path, made, p, _),) = model.simulator.paths([request], effects)
    assert made.states == pytest.approx(predict(whole, path, request.state, p).states, abs=1e-12)
    rolling, sliding = (
        model.simulator.paths(
            [replace(request, values={**values, "lateral_slip.mu_ratio": e})], effects
        )
        for e in (0.0, 1.0)
    )
    assert np.abs(rolling[0][1].states - sliding[0][1].states).max() > 1e-4


def test_a_step_ends_where_the_rate_jumps():
    gait, limit = SineGait(0.6, 1.0, 0.1), 2.5
    drive = CATALOGUE["servo_rate_limit"].actuate(commanded(gait, False), {"rate_limit": limit})
    t, late = np.linspace(0.0, 5.0, 251), 0.0123
    steps = steps_of(drive, t, late)
    assert np.all(np.diff(steps.edges) > 0)
    np.testing.assert_array_equal(steps.edges[:: steps.each], t)
    jumps = drive.jumps_within(late, 5.0 + late)
    assert len(jumps) == pytest.approx(4 * 5, abs=2)
    for jump in jumps:
        assert np.abs(steps.edges + late - jump).min() < 1e-9
    # Between the jumps the rate is smooth.
    inside = steps.edges[:-1] + np.diff(steps.edges) * np.array([[0.01], [0.99]]) + late
    assert np.abs(np.diff(drive.at(inside.ravel())[1].reshape(2, -1), axis=0)).max() < 0.5
