"""A copy, and what tells nothing, is left out; what cannot be as it is said is refused."""

from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.experiment import CHANNELS, Experiment, Run
from rr_opt.outcome import InputError
from rr_opt.recordings.copies import copied, rows_of
from rr_opt.recordings.experiment import usable
from rr_opt.recordings.inspection import Circumstances, inspect
from tests.recordings.nuisances.spoilt import GAIT, NOISE, ROBOT, recording


def experiment(*given):
    """Of recordings and their uses, read as those of a folder are."""
    known = Circumstances(robot=ROBOT, gait=GAIT)
    runs = [Run(inspect(one, None, known).recording, GAIT, use) for one, use in given]
    return Experiment(ROBOT, NOISE, {}, tuple(runs))


def cut(one, rows):
    part = {name: y[rows] for name, y in one.values.items()}
    flags = {name: y[rows] for name, y in one.flags.items()}
    sigma = {name: y[rows] for name, y in one.sigma.items()}
    return replace(one, name="two.csv", t=one.t[rows], values=part, flags=flags, sigma=sigma)


def test_a_copy_is_no_evidence():
    one = recording("one.csv")
    rounded = replace(
        one, name="two.csv", values={name: np.round(y, 5) for name, y in one.values.items()}
    )
    later = replace(one, name="two.csv", t=one.t + 1e-3)
    for copy in (later, rounded, cut(one, slice(500, 1500)), cut(one, slice(None, None, 2))):
        other = recording("three.csv", seed=1)
        kept, left_out = usable(experiment((copy, "holdout"), (one, "fit"), (other, "holdout")))
        assert [run.name for run in kept.runs] == ["one.csv", "three.csv"]
        assert "two.csv: Read the same motion as one.csv" in left_out[0]


def test_a_good_recording_is_not_left_out_with_another_of_its_name():
    good, still = recording(), recording(change=lambda v: v.update(phi=0 * v["phi"]))
    kept, left_out = usable(experiment((still, "fit"), (good, "fit")))
    assert [np.ptp(run.recording.values["phi"]) > 0 for run in kept.runs] == [True]
    assert len(left_out) == 1


@pytest.mark.parametrize(("name", "value"), [("x", 9999), ("y", -9999), ("phi", 65.5)])
def test_a_single_wild_sample_is_no_other_unit(name, value):
    def spoil(v):
        v[name][700] = value

    kept, _ = usable(experiment((recording(change=spoil), "fit")))
    codes = {one.code for one in kept.runs[0].recording.doubts}
    assert codes - {"turns.angle"} == {"outlier.channel"}


def placed(one, shift, angle):
    """The same recording in another frame."""
    way = (one.values["x"] + 1j * one.values["y"]) * np.exp(1j * angle) + shift
    psi = one.values["psi"] + angle
    return replace(
        one, name="two.csv", values={**one.values, "x": way.real, "y": way.imag, "psi": psi}
    )


def test_a_copy_in_another_frame_is_no_evidence():
    one, other = recording("one.csv"), recording("three.csv", seed=1)
    cut_and_turned = placed(cut(one, slice(500, 1500)), 0.3j, 2.0)
    for copy in (placed(one, 1.0, 0.0), placed(one, 0.0, 0.5), cut_and_turned):
        kept, left_out = usable(experiment((copy, "holdout"), (one, "fit"), (other, "holdout")))
        assert [run.name for run in kept.runs] == ["one.csv", "three.csv"]
        assert "two.csv: Read the same motion as one.csv" in left_out[0]


def test_steady_runs_with_little_noise_are_no_copies():
    one, two = (
        replace(recording(f"{n}.csv", seed=n), sigma=dict.fromkeys(CHANNELS, np.full(2001, 0.1)))
        for n in range(2)
    )
    turned = replace(placed(two, 0.3, 1.0), name="two.csv")
    assert not copied(rows_of(turned), [("one.csv", rows_of(one))])


def test_where_nothing_is_left_to_fit_it_says_why():
    still = recording(change=lambda v: v.update(phi=0 * v["phi"]))
    with pytest.raises(InputError, match=r"run.csv: phi does not move[^$]*No recording"):
        usable(experiment((still, "fit")))


def test_what_is_wrong_in_one_is_refused_by_name():
    wrong = recording(change=lambda v: v.update(y=-v["y"]))
    with pytest.raises(InputError, match=r"run.csv: Position and angles[^$]*y is mirrored"):
        usable(experiment((wrong, "fit"), (recording("other.csv", seed=1), "fit")))


def test_a_sign_that_is_wrong_in_all_is_refused():
    def mirrored(v):
        v.update(y=-v["y"], psi=-v["psi"], phi=-v["phi"])

    one, two = (recording(f"{n}.csv", seed=n, change=mirrored) for n in range(2))
    usable(experiment((one, "fit")))
    with pytest.raises(InputError, match="half a period off its command in every recording"):
        usable(experiment((one, "fit"), (two, "fit")))
