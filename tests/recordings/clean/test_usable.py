"""What cannot be as the experiment says is refused by name; a copy and what tells nothing is left
out."""

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run
from rr_opt.outcome import InputError
from rr_opt.recordings.usable import checked, usable
from tests.recordings.clean.world import GAIT, motion

NOISE = Noise(1e-3, 3e-3)


def recording(name="run.csv", seed=0, turned=0.0):
    """The simulated motion, its frame turned, with noise."""
    rng = np.random.default_rng(seed)
    moved = motion(20.0, GAIT, "running")
    place = (moved.x + 1j * moved.y) * np.exp(1j * turned)
    values = dict(
        zip(CHANNELS, (place.real, place.imag, moved.psi + turned, moved.phi), strict=True)
    )
    n = len(moved.t)
    return Recording(
        name,
        moved.t,
        {one: y + NOISE.of(one) * rng.normal(size=n) for one, y in values.items()},
        {one: np.full(n, NOISE.of(one)) for one in CHANNELS},
        {one: np.zeros(n, np.uint8) for one in CHANNELS},
    )


def experiment(*runs):
    return Experiment(read_problem(None).robot, NOISE, {}, runs)


def changed(given, change):
    values = dict(given.values)
    change(values)
    return replace(given, values=MappingProxyType(values))


def swap(values):
    values["x"], values["y"] = values["y"], values["x"]


def mirror(values):
    values["y"] = -values["y"]


def turn(values):
    values["psi"] = values["psi"] + np.pi


def quarter(values):
    values["psi"] = values["psi"] - np.pi / 2


@pytest.mark.parametrize("turned", [0.0, 1.3, 2.6, -2.0])
def test_a_frame_that_is_right_is_taken(turned):
    assert checked(experiment(Run(recording(turned=turned), GAIT))).wrong == ()


@pytest.mark.parametrize(
    ("change", "turned", "named"),
    [
        (swap, 0.0, "x and y exchanged"),
        (swap, 1.3, "x and y exchanged"),
        (mirror, 0.0, "y mirrored"),
        (turn, 0.7, "psi turned by 180 deg"),
        (quarter, 0.7, "psi turned by 90 deg"),
    ],
)
def test_a_frame_that_is_wrong_is_told_by_name(change, turned, named):
    wrong = changed(recording(turned=turned), change)
    (text,) = checked(experiment(Run(wrong, GAIT))).wrong
    assert text.startswith("run.csv: Place and heading do not go together")
    assert named in text


def test_a_copy_is_no_evidence():
    one = recording("one.csv")
    copy = replace(one, name="two.csv", t=one.t + 1e-3)
    other = recording("three.csv", seed=1)
    kept, left_out = usable(
        experiment(Run(copy, GAIT, "holdout"), Run(one, GAIT), Run(other, GAIT, "holdout"))
    )
    assert [run.name for run in kept.runs] == ["one.csv", "three.csv"]
    assert "two.csv: Read the same motion as one.csv" in left_out[0]


def test_where_nothing_is_left_to_fit_it_says_why():
    still = changed(recording(), lambda values: values.update(phi=0 * values["phi"]))
    with pytest.raises(InputError, match=r"run.csv: The servo does not move[^$]*No recording"):
        usable(experiment(Run(still, GAIT)))


def test_a_gait_that_was_not_driven_is_told_soon():
    another = replace(GAIT, period=0.77)
    (text,) = checked(experiment(Run(recording(), another))).wrong
    assert "phi repeats every 1 s, and the gait every 0.77 s" in text
