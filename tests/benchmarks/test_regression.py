"""A ratio that is more than 30 % worse than the committed one is shown, and ends with 1."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks import regression
from benchmarks.regression import Change, changes

ROOT = Path(__file__).parents[2]
BEFORE = {"fast": 10.0, "slow": 2.0}


@pytest.fixture
def repository(tmp_path):
    """A repository in which a benchmark's ratios are committed; and how to change them."""

    def git(*arguments):
        who = ("-c", "user.name=a", "-c", "user.email=a@b.c", "-c", "commit.gpgsign=false")
        subprocess.run(["git", *who, *arguments], cwd=tmp_path, check=True, capture_output=True)

    def write(ratios, name="made"):
        path = tmp_path / "results" / "bench" / f"{name}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps({"machine": "any", "ratios": ratios}), encoding="utf-8")
        return path

    git("init", "-q")
    for ratios in ({"fast": 1.0, "slow": 1.0}, BEFORE):
        write(ratios)
        git("add", ".")
        git("commit", "-q", "-m", "ratios")
    return tmp_path, write


def worse(root):
    return [one.label for one in changes(root) if one.worse]


@pytest.mark.parametrize(
    ("ratios", "expected"),
    [
        (BEFORE, []),
        ({"fast": 30.0, "slow": 2.0}, []),
        ({"fast": 7.1, "slow": 2.0}, []),
        ({"fast": 6.9, "slow": 2.0}, ["fast"]),
        ({"fast": 6.9, "slow": 0.1}, ["fast", "slow"]),
        ({"slow": 2.0}, ["fast"]),
        ({**BEFORE, "new": 0.01}, []),
    ],
    ids=["same", "better", "a little worse", "worse", "both", "gone", "new"],
)
def test_what_is_worse(repository, ratios, expected):
    root, write = repository
    write(ratios)
    assert worse(root) == expected


def test_a_file_that_is_gone_or_new(repository):
    root, write = repository
    write(BEFORE).unlink()
    write({"other": 1.0}, "another")
    assert changes(root) == [
        Change("another", "other", None, 1.0),
        Change("made", "fast", 10.0, None),
        Change("made", "slow", 2.0, None),
    ]
    assert worse(root) == ["fast", "slow"]


@pytest.mark.parametrize(("slow", "code"), [(2.0, 0), (1.0, 1)])
def test_how_the_command_ends(repository, monkeypatch, capsys, slow, code):
    root, write = repository
    write({"fast": 10.0, "slow": slow})
    monkeypatch.setattr(regression, "ROOT", root)
    if code:
        with pytest.raises(SystemExit) as end:
            regression.main([])
        assert end.value.code == code
    else:
        regression.main([])
    shown = capsys.readouterr().out
    assert "fast" in shown
    assert ("-50 %" in shown) == bool(code)
    assert ("1 of 2 ratios are worse" in shown) == bool(code)


def test_an_earlier_revision(repository):
    root, write = repository
    write({"fast": 6.9, "slow": 0.5})
    assert [one.label for one in changes(root, "HEAD~1") if one.worse] == ["slow"]


def test_where_nothing_was_committed(tmp_path):
    assert changes(tmp_path) == []


def test_it_runs_in_this_repository():
    run = subprocess.run(
        [sys.executable, "-m", "benchmarks.regression"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode in (0, 1), run.stderr
    assert run.stderr == ""
