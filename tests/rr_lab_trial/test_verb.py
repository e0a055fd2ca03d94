"""`rr-opt prove` refuses what it cannot do, in three sentences, and does one case again."""

import json
import sys
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from rr_lab import trial as one
from rr_lab.case import ENGINES
from rr_lab.trial import MADE
from rr_lab.trial.draws import KINDS, Basis
from rr_lab.trial.isolation import diagnose_apart
from rr_opt.cli.main import app
from tests.rr_lab_trial.test_trial import STUB, made_up


def stub(task):
    return diagnose_apart(replace(task, command=(sys.executable, STUB, "well")))


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--seed", "xyz"], "--seed: Read 'xyz'. Expected hexadecimal digits"),
        (["--seed", "1", "--kinds", "odd"], "--kinds: Read 'odd'. Expected one or more of null"),
        (["--seed", "1", "--scheduler", "nowhere"], "No dask scheduler answers at 'nowhere'"),
    ],
)
def test_wrong_input(words, told, tmp_path):
    done = CliRunner().invoke(app, ["prove", *words, "--out", str(tmp_path / "proof")])
    assert done.exit_code == 2
    assert told in done.stderr
    assert not (tmp_path / "proof").exists()


def test_planar_cases_need_no_mujoco(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    seen = []
    monkeypatch.setattr(one, "make", lambda draw: seen.append(draw) or made_up(draw))
    monkeypatch.setattr(one, "diagnose_apart", stub)
    words = ["prove", "--case", "2", "--out", str(tmp_path), "--seed", "5eed", "--kinds", "null"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 2
    assert "MuJoCo is not installed" in done.stderr
    done = CliRunner().invoke(app, [*words, "--engine", "planar"])
    assert done.exit_code == 0, done.output
    assert [draw.engine for draw in seen] == ["planar"]
    assert ["engine", "planar"] in [told.split() for told in done.stdout.splitlines()]


def test_one_case_again_tells_what_was_hidden_and_what_was_said(tmp_path, monkeypatch):
    monkeypatch.setattr(one, "make", made_up)
    monkeypatch.setattr(one, "diagnose_apart", stub)
    words = ["prove", "--case", "2", "--out", str(tmp_path), "--seed", "5eed", "--kinds", "null"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    for line in ("hidden  nothing", "diagnosis    consistent", "outcome  right"):
        assert line.split() in [told.split() for told in done.stdout.splitlines()]
    again = tmp_path / "again" / "002"
    found = {str(path.relative_to(again)) for path in again.rglob("*") if path.is_file()}
    assert found == {
        "answer.json", "recordings/experiment.yaml", "said/diagnosis.json", "said/report.html",
        "said/output.txt",
    }  # fmt: skip
    told = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)
    assert (told["case"], told["outcome"]) == ("002", "right")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ([], ("5eed", ("pair", "outside"), ("planar",))),
        (["--seed", "0x5EED"], ("5eed", ("pair", "outside"), ("planar",))),
        (["--kinds", "single"], ("5eed", ("single",), ("planar",))),
        (["--engine", "both"], ("5eed", ("pair", "outside"), ENGINES)),
        (["--seed", "1"], ("1", KINDS, ENGINES)),
    ],
    ids=["nothing", "seed", "kinds", "engine", "another seed"],
)
def test_one_case_again_is_that_of_the_trial_in_the_folder(words, expected, tmp_path, monkeypatch):
    """What the options leave out is as the trial was begun; with another seed it is another one."""
    begun = {"seed": "5eed", "kinds": ["pair", "outside"], "engines": ["planar"]}
    (tmp_path / MADE).write_text(json.dumps(begun) + "\n")
    seen = []
    monkeypatch.setattr(one, "make", lambda draw: seen.append(draw) or made_up(draw))
    monkeypatch.setattr(one, "diagnose_apart", stub)
    for number in range(1, 7):
        again = ["prove", "--case", str(number), "--out", str(tmp_path), *words]
        assert CliRunner().invoke(app, again).exit_code == 0
    assert seen == [Basis(expected[0], *expected[1:]).draw(number) for number in range(1, 7)]
