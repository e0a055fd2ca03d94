"""Rows of a machine's recording: what is dropped of them, and what does not matter."""

import json

import numpy as np
import pytest

from rr_opt.files.machine_file import read_machine_plan
from rr_opt.machines.registry import machine_named
from rr_opt.recordings.machine_run import machine_experiment

T = np.arange(400) / 100
ROWS = [f"{t:.2f},{np.sin(3 * t):.4f},{np.cos(2 * t):.4f}" for t in T]
TEXT = """machine: pendulum
parameters: {J: 0.05, ml: 0.1, b: 0.02}
recordings: [{file: run.csv}]
"""


def read(folder, rows, head="t,q,u"):
    return read_text(folder, "\n".join([head, *rows, ""]))


def read_text(folder, text):
    (folder / "run.csv").write_text(text)
    (folder / "experiment.yaml").write_text(TEXT)
    plan = read_machine_plan(folder, machine_named("pendulum"))
    experiment, issues = machine_experiment(plan)
    assert not [one for one in issues if one.level == "error"], issues
    return experiment.runs[0]


@pytest.mark.parametrize("time", ["", "1e9", "99", "0.5", "nan"])
def test_a_row_with_a_wrong_time_is_the_only_one_lost(tmp_path, time):
    rows = ROWS.copy()
    rows[200] = time + rows[200][4:]
    run = read(tmp_path, rows)
    np.testing.assert_allclose(run.t, np.delete(T, 200))
    assert any("are missing: 1." in one for one in run.doubts)


def test_of_two_recordings_in_one_file_one_is_read(tmp_path):
    run = read(tmp_path, ROWS[:300] + ROWS[:300])
    np.testing.assert_allclose(run.t, T[:300])


def test_columns_that_are_not_read_may_hold_text(tmp_path):
    run = read(tmp_path, [f"{row},ok" for row in ROWS], "t,q,u,state")
    np.testing.assert_allclose(run.t, T)
    keys = ("t", "q", "u")
    entries = [dict(zip(keys, map(float, row.split(",")), strict=True)) for row in ROWS]
    text = json.dumps({"entries": [{**entry, "state": "ok"} for entry in entries]})
    np.testing.assert_allclose(read_text(tmp_path, text).t, T)
