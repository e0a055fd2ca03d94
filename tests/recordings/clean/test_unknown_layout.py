"""Without a layout the markers show the joint, and the wheels the axes of both platforms."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.model.experiment import Layout
from rr_opt.model.gait import SineGait
from rr_opt.outcome import InputError
from rr_opt.recordings.markers.calibration import calibration
from rr_opt.recordings.markers.pose import fit_markers
from tests.recordings.clean.world import GAIT, LAYOUT, markers, motion

SIGMA = 5e-4


def test_the_joint_is_found_within_what_is_told():
    off = []
    for seed in range(4):
        data = markers(motion(), SIGMA, seed)
        guess = calibration([data])
        assert set(guess.layout.platform1) == set(LAYOUT.platform1)
        for mine, true in (
            (guess.layout.platform1, LAYOUT.platform1),
            (guess.layout.platform2, LAYOUT.platform2),
        ):
            # Distances from P do not know of axes.
            error = [np.hypot(*mine[name]) - np.hypot(*true[name]) for name in true]
            off.append(np.max(np.abs(error)) / guess.joint)
    assert max(off) < 5
    assert guess.joint < 1e-4


def test_p_is_that_of_the_known_layout_and_the_angles_differ_by_constants():
    data = markers(motion(), SIGMA, 1)
    known = fit_markers(data, LAYOUT).recording
    found = fit_markers(data, None)
    for name in ("x", "y"):
        assert np.abs(found.recording.values[name] - known.values[name]).max() < 5e-4
    for name in ("psi", "phi"):
        apart = found.recording.values[name] - known.values[name]
        assert apart.std() < 0.4 * np.median(known.sigma[name])
    assert "Which platform is platform 1 cannot be determined" in found.doubts[0]


def turns(layout):
    """By how much each platform's axes are off, rad."""
    for mine, true in ((layout.platform1, LAYOUT.platform1), (layout.platform2, LAYOUT.platform2)):
        yield np.angle(sum(complex(*mine[name]) * np.conj(complex(*true[name])) for name in true))


@pytest.mark.parametrize("noise", [0.0, SIGMA, 3e-3])
def test_the_wheels_show_the_axes_and_where_the_axles_are(noise):
    off = []
    for seed in range(4):
        found = calibration([markers(motion(), noise, seed)])
        assert found.axles is not None
        for turn, axle, c in zip(turns(found.layout), found.axles, (0.186, 0.0441), strict=True):
            off += [turn / (axle.sigma + 1e-5), (axle.distance - c) / (axle.error + 2e-6)]
            assert axle.sigma < noise + 1e-5
    assert np.sqrt(np.mean(np.square(off))) < 1.5
    assert np.abs(off).max() < 4


def exchanged(data):
    """With the markers of platform 2 in the first columns."""
    order = [*range(4, 8), *range(4)]
    labels = tuple(data.labels[i] for i in order)
    return replace(data, labels=labels, positions=data.positions[:, order])


def test_the_distances_of_the_axles_tell_the_platforms_apart():
    robot = read_problem(None).robot
    for data in (markers(motion(), SIGMA, 1), exchanged(markers(motion(), SIGMA, 1))):
        found = calibration([data], robot)
        assert found.ordered
        assert set(found.layout.platform1) == set(LAYOUT.platform1)
        assert max(map(abs, turns(found.layout))) < 3e-3
    alike = replace(robot, platform1=replace(robot.platform1, c=robot.platform2.c))
    assert not calibration([exchanged(data)], alike).ordered
    # With such a robot phi's sign does.
    for made in (data, exchanged(data)):
        found = calibration([made], alike, [GAIT])
        assert found.ordered
        assert set(found.layout.platform1) == set(LAYOUT.platform1)


def test_a_robot_that_is_held_shows_no_axes():
    still = replace(motion(), x=np.zeros(3001), y=np.zeros(3001), psi=np.zeros(3001))
    found = fit_markers(markers(still, SIGMA, 1), None)
    assert "drives too little" in found.doubts[0]
    t = motion().t
    pushed = replace(motion(), x=0.5 * np.sin(0.9 * t), y=0.3 * np.sin(0.5 * t + 1))
    assert calibration([markers(pushed, SIGMA, 1)]).axles is None


def test_a_marker_on_the_floor_is_on_neither_platform():
    moved = motion()
    data = markers(moved, SIGMA, 1)
    floor = np.broadcast_to([0.3, 0.4, 0.0], (len(moved.t), 1, 3))
    more = replace(
        data,
        labels=("floor", *data.labels),
        positions=np.concatenate([floor, data.positions], axis=1),
    )
    guess = calibration([more])
    assert set(guess.layout.platform1) == set(LAYOUT.platform1)
    assert set(guess.layout.platform2) == set(LAYOUT.platform2)


def test_a_servo_that_does_not_move_is_refused():
    still = motion(5.0, SineGait(0.0, 1.0, 0.1))
    with pytest.raises(InputError, match="--layout"):
        fit_markers(markers(still, SIGMA, 1), None)


def test_a_layout_that_is_off_by_millimetres_is_put_right_but_for_its_axes():
    rng = np.random.default_rng(0)

    def shifted(places):
        return {
            name: tuple(np.add(place, rng.normal(0, 2e-3, 2))) for name, place in places.items()
        }

    wrong = Layout(shifted(LAYOUT.platform1), shifted(LAYOUT.platform2))
    data = markers(motion(), SIGMA, 1)
    found = fit_markers(data, wrong)
    assert abs(found.noise / SIGMA - 1) < 0.03
    assert "from its place in the layout" in found.doubts[0]
    known = fit_markers(data, LAYOUT).recording
    for name in ("psi", "phi"):
        apart = found.recording.values[name] - known.values[name]
        assert apart.std() < 0.4 * np.median(known.sigma[name])
        assert abs(apart.mean()) < 0.04


@pytest.mark.parametrize("seed", range(3))
def test_a_millimetre_of_noise_does_not_hide_two_small_platforms(seed):
    first = {"RR1": (0.028, 0.011), "RR2": (0.084, -0.018), "RR3": (0.167, 0.020)}
    second = {"RF1": (-0.007, 0.011), "RF2": (-0.020, -0.018), "RF3": (-0.040, 0.020)}
    layout = Layout(first, second)
    data = markers(motion(gait=SineGait(0.3, 1.2)), 1e-3, seed, layout)
    guess = calibration([data])
    assert set(guess.layout.platform1) == set(first)
    assert set(guess.layout.platform2) == set(second)
