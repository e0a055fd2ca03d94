"""Without a layout the markers show the joint and both angles, but for the angles' zeros."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.outcome import InputError
from rr_opt.recordings.markers.layout import Layout, guessed_layout
from rr_opt.recordings.markers.pose import fit_markers
from tests.recordings.clean.world import LAYOUT, markers, motion

SIGMA = 5e-4


def test_the_joint_is_found_within_what_is_told():
    off = []
    for seed in range(4):
        data = markers(motion(), SIGMA, seed)
        guess = guessed_layout(data.labels, data.positions[..., :2])
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
    assert "zeros of psi and phi, cannot be known" in found.doubts[0]


def test_a_marker_on_the_floor_is_on_neither_platform():
    moved = motion()
    data = markers(moved, SIGMA, 1)
    floor = np.broadcast_to([0.3, 0.4, 0.0], (len(moved.t), 1, 3))
    more = replace(
        data,
        labels=("floor", *data.labels),
        positions=np.concatenate([floor, data.positions], axis=1),
    )
    guess = guessed_layout(more.labels, more.positions[..., :2])
    assert guess.unused == ("floor",)
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
    assert "from where the layout has it" in found.doubts[0]
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
    guess = guessed_layout(data.labels, data.positions[..., :2])
    assert set(guess.layout.platform1) == set(first)
    assert set(guess.layout.platform2) == set(second)
