"""What is not as the experiment file says is refused with a reason; a faulty robot is not."""

import re

import numpy as np
import pytest
from typer.testing import CliRunner

from rr_opt.cli.main import app
from rr_opt.files.issue import has_errors
from rr_opt.outcome import InputError
from rr_opt.recordings.experiment import read_experiment, usable
from tests.sysid.bad_data.folder import GAITS, written

DEGREES = 180 / np.pi


def refusal(folder):
    with pytest.raises(InputError) as caught:
        usable(read_experiment(folder))
    return str(caught.value)


@pytest.mark.parametrize(
    ("factors", "said"),
    [
        ((1, 1000, 1, 1, 1), "millimetres"),
        ((1, 20, 20, 1, 1), "millimetres or centimetres?"),
        ((1, 100, 100, 1, 1), "millimetres or centimetres"),
        ((1, 15, 15, 1, 1), "millimetres or centimetres?"),
        ((1, 0.02, 0.02, 1, 1), "times too large"),
        ((1, 1, 1, DEGREES, 1), "is psi in degrees?"),
        ((1, 1, 1, 1, DEGREES), "degrees"),
        ((1, 1, 1, -1, 1), "psi has the other sign"),
        ((1, 1, 1, 1, -1), "phi has the other sign"),
        ((1, 1, -1, -1, -1), "phi is half a period off its command in every recording"),
    ],
)
def test_another_unit_or_sign(tmp_path, factors, said):
    told = refusal(written(tmp_path, lambda table: table * factors)).splitlines()
    assert told
    assert all(said in line for line in told)


def test_a_small_angle_in_degrees(tmp_path):
    gaits = [(0.005, 1.0, 0.0)]
    spoil = lambda table: table * [1, 1, 1, 1, 0.01 * DEGREES]  # noqa: E731
    assert "is one of them in degrees" in refusal(
        written(tmp_path, spoil, uses=("fit",), gaits=gaits)
    )


@pytest.mark.parametrize("factor", [0.5, 2.0, 1.2])
def test_another_period(tmp_path, factor):
    amplitude, period, offset = GAITS[0]
    gaits = [(amplitude, factor * period, offset), *GAITS[1:]]
    told = refusal(written(tmp_path, gaits=gaits))
    assert "run0.csv: phi repeats every 1" in told
    assert f"the gait every {factor * period:.3g} s" in told
    assert "run1" not in told


def test_times_of_a_calendar(tmp_path):
    told = refusal(written(tmp_path, lambda table: np.add(table, [1.7e9, 0, 0, 0, 0])))
    assert "The times begin at 1700000000" in told


def test_noise_that_drowns_the_motion(tmp_path):
    folder = written(tmp_path)
    file = folder / "experiment.yaml"
    assert "angle: 0.003" in file.read_text()
    file.write_text(file.read_text().replace("angle: 0.003", "angle: 0.2"))
    assert "Correct `noise.angle`" in refusal(folder)


def test_what_is_refused_is_no_clean_bill_of_lint(tmp_path):
    from rr_opt.api.files import lint

    assert not has_errors(lint(written(tmp_path / "right")))
    assert has_errors(lint(written(tmp_path / "mm", lambda table: table * [1, 1e3, 1e3, 1, 1])))


def test_too_short_or_too_still(tmp_path):
    short = refusal(written(tmp_path / "short", lambda table: table[:150]))
    assert "too short" in short
    assert "nothing can be learnt" in short

    def still(table):
        table[:, 1:4] = table[0, 1:4] + 0.001 * np.random.default_rng(0).normal(
            size=(len(table), 3)
        )
        return table

    assert "The robot does not move" in refusal(written(tmp_path / "still", still))


def test_another_amplitude_is_told_and_not_refused(tmp_path):
    amplitude, period, offset = GAITS[1]
    gaits = [GAITS[0], (1.5 * amplitude, period, offset), GAITS[2]]
    trial, left_out = usable(read_experiment(written(tmp_path, gaits=gaits)))
    assert len(trial.runs) == 3
    assert left_out == ()
    said = [[text for text in run.recording.doubts if "commanded" in text] for run in trial.runs]
    assert [len(texts) for texts in said] == [0, 1, 0]
    assert said[1][0].startswith("phi moves 0.666")


@pytest.mark.parametrize(
    ("stated", "key", "said"),
    [
        ("position: 1", "noise.position", "Smaller effects will go undetected."),
        ("position: 1.0e-6", "noise.position", "counts as a mismatch."),
        ("angle: 0.05", "noise.angle", "Smaller effects will go undetected."),
    ],
)
def test_noise_that_is_not_what_the_recordings_have(tmp_path, stated, key, said):
    folder = written(tmp_path)
    assert not any(run.recording.doubts for run in read_experiment(folder).runs)
    path = folder / "experiment.yaml"
    name = stated.split(":")[0]
    path.write_text(re.sub(rf"{name}: [^,}}]+", stated, path.read_text()))
    for run in read_experiment(folder).runs:
        told = [one for one in run.recording.doubts if one.kind == "noise"]
        assert told
        assert all(said in one and f"Correct `{key}`" in one for one in told)
    linted = CliRunner().invoke(app, ["lint", str(folder)])
    assert "warning: The noise of " in linted.stdout
