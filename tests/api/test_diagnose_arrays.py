"""An experiment made of arrays is diagnosed like the folder that holds the same numbers."""

import numpy as np
import pytest

import rr_opt as rr
from tests.cli.test_diagnose import GAITS, columns, write
from tests.robots import BENCHMARK

USES = ("fit", "holdout", "fit")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write(tmp_path_factory.mktemp("trial"), [columns(k, 6) for k in range(3)], USES)


def of_arrays(folder, **changes):
    runs = []
    for k, use in enumerate(USES):
        table = np.loadtxt(f"{folder}/run{k}.csv", delimiter=",", skiprows=1)
        arrays = dict(zip(("x", "y", "psi", "phi"), table.T[1:], strict=True))
        made = rr.Recording.of(table[:, 0], **arrays, name=f"run{k}.csv")
        runs.append(rr.Run(made, rr.SineGait(*GAITS[k]), use))
    return rr.Experiment.of(BENCHMARK, runs, rr.Noise("1 mm", "3 mrad"), name="arrays", **changes)


def test_the_same_numbers_the_same_answer(folder, tmp_path):
    read, made = (rr.diagnose(one) for one in (folder, of_arrays(folder)))
    assert (read.verdict, made.verdict) == ("consistent", "consistent")
    one, other = read.record(), made.record()
    assert [one["summary"], one["effects"]] == [other["summary"], other["effects"]]
    left = (reported["fit"]["heldout_rms_after"] for reported in (one, other))
    assert next(left) == pytest.approx(next(left))
    assert made.sha256 not in ("", read.sha256)
    assert made.loss is None
    found = {file.name for file in made.save(tmp_path, figures=False)}
    assert found == {"diagnosis.json", "robot-corrected.yaml"}
    # The corrected robot goes into the next question.
    problem = rr.shipped().with_robot(made.corrected_robot)
    assert problem.robot.name.endswith("corrected")


def test_arrays_that_do_not_fit_together():
    t = np.arange(3) / 50
    with pytest.raises(rr.InputError, match=r"phi \(2,\)"):
        rr.Recording.of(t, x=t, y=t, psi=t, phi=t[:2])
    with pytest.raises(rr.InputError, match="times that rise"):
        rr.Recording.of(t[::-1], x=t, y=t, psi=t, phi=t)


def test_an_uncertainty_of_nothing_known(folder):
    with pytest.raises(rr.InputError, match="kapa"):
        of_arrays(folder, uncertainty={"kapa": 0.1})
    assert of_arrays(folder, uncertainty={"m1": 0.1}).uncertainty["m1"].sigma == 0.1
