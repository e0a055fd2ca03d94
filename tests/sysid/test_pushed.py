"""A push as a function of time moves the robot as the effect does that pushes so."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.machines.racer.drive import drive_path, grain, steps_of
from rr_opt.machines.racer.observed import Along, observed
from rr_opt.machines.racer.parameters import values_of
from rr_opt.machines.racer.simulation import driven
from rr_opt.machines.racer.unknown_input import _VARIABLES, _Moving, cut, linearised_inputs
from rr_opt.sysid.model import Request, Segment
from rr_opt.sysid.shooting import predict
from tests.sysid.made_up import with_effect

SEGMENT = Segment(1, 0, 300, 299)


def _pushes(name, along, nominal):
    """The effect's force, or angle, along the path, for one unit of its parameter."""
    out = np.zeros((7, along.t.size))
    if name == "coulomb_friction.force1":
        out[:2] = -np.tanh(along.u[:2] / 0.002)
    if name == "coulomb_friction.force2":
        out[2:4] = -np.tanh(along.u[2:] / 0.002)
    if name == "kappa1":
        out[:2] = -along.u[:2] / nominal["h"] ** 2
    if name == "servo_offset.offset":
        out[6] = 1.0
    return out


@pytest.mark.parametrize(
    "name", ["coulomb_friction.force1", "coulomb_friction.force2", "kappa1", "servo_offset.offset"]
)
def test_its_column_is_that_of_the_effect(name):
    model = with_effect({}, ())
    request = Request(SEGMENT, {}, model.initial_state(SEGMENT, (), {}))
    effects = ("coulomb_friction", "servo_offset")
    # Where the path is not what was recorded, the pushes are not those along it.
    data = model.runs[1]
    data.values[SEGMENT.span] = model.predicted(request, ())
    (along,) = observed(model, [request], ())
    pushes = _pushes(name, along, model.nominal)[None]
    # Recordings that are off by a noise, so that the residual is seen too.
    data.values[:] += 0.5 * data.sigma * np.sin(np.arange(data.values.size)).reshape(-1, 4)
    model.simulator._seen.clear()
    (linear,) = model.linearise([request], effects, (name,))
    (pushed,) = linearised_inputs(model, [request], (), (), [pushes])
    gram, end = pushed.gram, pushed.end
    size = np.sqrt(np.diag(linear.gram))
    assert np.abs(gram - linear.gram) / np.outer(size, size) == pytest.approx(0.0, abs=0.02)
    assert end[:, -1] == pytest.approx(
        linear.end[:, -1], abs=0.02 * np.abs(linear.end[:, -1]).max()
    )


@pytest.mark.parametrize(
    "values", [{}, {"lateral_slip.creep_compliance": 0.01, "lateral_slip.mu": 10.0}]
)
def test_a_bump_of_the_angle_moves_the_robot_as_the_servo_would(values):
    effects = ("lateral_slip",) if values else ()
    model = with_effect({}, (), rate=100.0, seconds=3.0)
    data, segment = model.runs[1], Segment(1, 0, 300, 299)
    start = model.initial_state(segment, effects, values)
    given = model.simulator.given(values)
    system, motion = driven(effects)
    t, size = data.t[:300], 1e-3
    drive = model.simulator.drives.of(1, given, effects)
    steps = steps_of(drive, t, 0.0, **grain(given, effects))
    p = values_of(given, motion.parameters)

    def bump(t):
        x = (t - 1.5) / 0.1
        return np.exp(-x * x / 2) * np.array([1 + 0 * x, -x / 0.1, (x * x - 1) / 0.1**2])

    def moved(by):
        servo = replace(drive, at=lambda t: drive.at(t) + by * bump(t))
        return predict(system, drive_path(servo, steps, 0.0), start, p).states[:, -1]

    expected = (moved(size) - moved(-size)) / (2 * size)
    pushes = np.zeros((1, 7, 300))
    pushes[0, 6] = bump(t)[0]
    request = Request(segment, values, start)
    (pushed,) = linearised_inputs(model, [request], effects, (), [pushes])
    assert pushed.end[:, -1] == pytest.approx(expected, abs=0.02 * np.abs(expected).max())


def test_where_nothing_is_wanted_it_is_the_plain_linearisation():
    model = with_effect({}, ())
    request = Request(SEGMENT, {}, model.initial_state(SEGMENT, (), {}))
    names = ("m1", "kappa2")
    (linear,) = model.linearise([request], (), names)
    (pushed,) = linearised_inputs(model, [request], (), names, [np.zeros((0, 7, 300))])
    gram, end = pushed.gram, pushed.end
    size = np.sqrt(np.diag(linear.gram))
    assert (gram - linear.gram) / np.outer(size, size) == pytest.approx(0.0, abs=1e-3)
    assert end == pytest.approx(linear.end, abs=1e-3 * np.abs(linear.end).max())


def test_the_inputs_of_pieces_are_those_of_the_whole_that_are_zero_elsewhere():
    model = with_effect({}, ())
    segments = [Segment(1, 0, 300, 299), Segment(1, 100, 250, 249)]
    requests = [Request(one, {}, model.initial_state(one, (), {})) for one in segments]
    along = observed(model, requests, ())
    whole, short = [], []
    for one in along:
        pushes = np.random.default_rng(0).normal(size=(2, 7, one.t.size))
        pushes[:, 4:] = 0.0  # Rates of change are those of an input that is not cut.
        edges = cut(one.t.size, 7)
        inside = np.zeros((7, one.t.size))
        for piece, (first, last) in zip(inside, itertools.pairwise(edges), strict=True):
            piece[first:last] = 1.0
        short.append(pushes)
        whole.append((inside[:, None, None] * pushes).reshape(-1, 7, one.t.size))
    names = ("m1", "kappa2")
    expected = linearised_inputs(model, requests, (), names, whole)
    cut_up = linearised_inputs(model, requests, (), names, short, 7)
    for one, other in zip(cut_up, expected, strict=True):
        size = np.sqrt(np.diag(other.gram))
        assert one.gram / np.outer(size, size) == pytest.approx(
            other.gram / np.outer(size, size), abs=1e-9
        )
        assert one.end == pytest.approx(other.end, abs=1e-9 * np.abs(other.end).max())


@pytest.mark.parametrize("name", ["time", "place"])
def test_a_variable_has_one_scale_along_a_run(name):
    model = with_effect({}, ())
    segments = [Segment(1, 0, 501, 500), Segment(1, 0, 250, 250), Segment(1, 250, 501, 500)]
    data, made = model.runs[1], []
    whole = np.vstack([data.t, data.values[:, :2].T])
    for one in segments:
        t, x, y, psi = (part[one.span] for part in (data.t, *data.values[:, :3].T))
        along = Along(t, x, y, psi, np.ones((4, t.size)), np.zeros((4, 2, t.size)))
        moving = _Moving(along, t, 1.0, whole)
        made.append([f(t, moving) for f in _VARIABLES[name].functions])
    for run, *parts in zip(*made, strict=True):
        for part, one in zip(parts, segments[1:], strict=True):
            np.testing.assert_allclose(part, run[one.span])
        assert np.ptp(run) == pytest.approx(1.0)
