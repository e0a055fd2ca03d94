"""Gaps, outliers, disordered rows and a wrong start do not turn a good robot into a bad one."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from rr_opt.cli.main import app
from tests.sysid.bad_data.folder import SIGMA, written


def gaps(table):
    """5 % missing in bursts of 0.2 s, and nothing at all in the first 0.15 s."""
    rng = np.random.default_rng(2)
    for at in rng.integers(20, len(table) - 20, size=len(table) // 400):
        table[at : at + 20, 1:] = np.nan
    table[:15, 1:] = np.nan
    return table


def outliers(table):
    """5 % of the values of every channel off by ten of its sigmas."""
    rng = np.random.default_rng(3)
    for column, sigma in enumerate(SIGMA, 1):
        off = rng.random(len(table)) < 0.05
        table[off, column] += 10 * sigma * rng.choice([-1, 1], off.sum())
    return table


def disordered(table):
    """Two rows exchanged, and twenty shuffled."""
    order = np.arange(len(table))
    order[[100, 101]] = order[[101, 100]]
    order[200:220] = np.random.default_rng(4).permutation(order[200:220])
    return table[order]


@pytest.mark.parametrize(
    ("spoil", "start"),
    [
        (gaps, "running"),
        (outliers, "running"),
        (disordered, "running"),
        (lambda table: table, "rest"),
    ],
    ids=["gaps", "outliers", "disordered", "wrong-start"],
)
def test_consistent(tmp_path, spoil, start):
    folder = written(tmp_path / "trial", spoil, start=start)
    done = CliRunner().invoke(
        app, ["diagnose", str(folder), "--no-page", "--json", "--out", str(tmp_path / "out")]
    )
    assert done.exit_code == 0, done.stderr
    told = json.loads(done.stdout)
    assert told["verdict"] == "consistent", told["summary"]
    assert 0.9 < told["fit"]["heldout_rms_after"] < 1.2
