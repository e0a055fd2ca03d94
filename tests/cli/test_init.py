"""init writes files that lint finds nothing in, that the verbs take, and that it never loses."""

import json
import re

import pytest

KINDS = ("robot", "problem", "study", "experiment")


@pytest.mark.parametrize("kind", KINDS)
def test_lint_finds_nothing(run, tmp_path, kind):
    done = run("init", kind)
    assert done.exit_code == 0, done.stderr
    files = done.stdout.split()
    assert all((tmp_path / file).is_file() for file in files)
    place = "experiment" if kind == "experiment" else files[0]
    assert run("lint", place).stdout == f"{place}: OK\n"


def test_a_problem_is_what_comes_without_a_word(run, tmp_path):
    assert run("init").stdout == "problem.yaml\n"
    assert run("sweep", "problem.yaml", "--points", "20", "--json").exit_code == 0


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_commented_out_is_right_too(run, tmp_path, kind):
    for each in KINDS:
        run("init", each)
    place = tmp_path / ("experiment/experiment.yaml" if kind == "experiment" else f"{kind}.yaml")
    text = place.read_text()
    opened = re.sub(r"^# (?=( *- | *\w+: |\w+:$))", "", text, flags=re.MULTILINE)
    place.write_text(opened)
    done = run("lint", str(place))
    assert done.exit_code == 0, done.stdout
    assert (opened != text) == (kind != "experiment")


def test_nothing_is_written_over(run, tmp_path):
    mine = tmp_path / "mine.yaml"
    mine.write_text("direction: forward\n")
    done = run("init", "problem", "-o", "mine.yaml")
    assert done.exit_code == 2
    assert "--force" in done.stderr
    assert mine.read_text() == "direction: forward\n"
    assert run("init", "problem", "-o", "mine.yaml", "--force").exit_code == 0
    assert "amplitude" in mine.read_text()
    (tmp_path / "experiment").mkdir()
    (tmp_path / "experiment" / "run2.csv").write_text("mine")
    assert run("init", "experiment").exit_code == 2
    assert [path.name for path in (tmp_path / "experiment").iterdir()] == ["run2.csv"]


def test_there_is_nothing_wrong_with_the_recordings(run):
    run("init", "experiment")
    done = run("inspect", "experiment", "--no-figures", "--json")
    reported = json.loads(done.stdout)
    assert [one["doubts"] for one in reported["recordings"]] == [[]] * 3


def test_a_kind_that_does_not_exist_is_answered_with_those_that_do(run):
    done = run("init", "nonsense")
    assert done.exit_code == 2
    assert "Invalid value for 'kind': 'nonsense' is not one of 'robot', 'problem'" in done.stderr
