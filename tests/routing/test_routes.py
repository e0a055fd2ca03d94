"""A study of routes drives each as `route` does, tells which cannot be driven, and resumes."""

import json
import os
import subprocess
import sys

import pytest
from typer.testing import CliRunner

import rr_opt as rr
from rr_opt.api import route
from rr_opt.batch import ONE_THREAD
from rr_opt.cli.main import app

PIECES = {"ahead": "straight: 60 cm", "tight": "arc: {radius: 10 cm, angle: 1}"}


@pytest.fixture
def file(tmp_path):
    for name, piece in PIECES.items():
        text = f"problem: {{inertia_ratio: 0.3}}\nroute: [{{{piece}}}]\n"
        (tmp_path / f"{name}.yaml").write_text(text)
    file = tmp_path / "study.yaml"
    file.write_text("routes: [ahead.yaml, tight.yaml]\n")
    return file


def test_rows_are_those_of_the_routes(file, tmp_path, monkeypatch):
    driven = rr.routes(file, folder=tmp_path / "out", workers=1)
    ahead, tight = driven.rows
    # With as many threads as a study's processes have: others round sums otherwise.
    code = "import json, sys, rr_opt; print(json.dumps(rr_opt.route(sys.argv[1]).record()))"
    printed = subprocess.run(
        (sys.executable, "-c", code, str(tmp_path / "ahead.yaml")),
        env=os.environ | ONE_THREAD,
        capture_output=True,
        text=True,
        check=True,
    )
    alone = json.loads(printed.stdout)
    assert ahead.keys() == alone.keys() | {"cpu_seconds"}
    assert ahead["seconds"] == pytest.approx(alone["seconds"])
    assert tight["status"] == "infeasible"
    assert "piece 1" in driven.warnings[0]

    driven.save(tmp_path / "out", figures=False)
    assert json.loads((tmp_path / "out/ahead.json").read_text())["seconds"] == ahead["seconds"]
    assert not (tmp_path / "out/tight.json").exists()
    assert (tmp_path / "out/study.csv").read_text().splitlines()[2].startswith("tight,infeasible,")

    journal = tmp_path / "out/journal.jsonl"
    lines = journal.read_text().splitlines(keepends=True)
    kept = next(line for line in lines[1:] if json.loads(line)["case"] == 0)
    journal.write_text(lines[0] + kept)
    sent = []
    monkeypatch.setattr(route, "run", lambda _pool, _, cases: iter(sent.append(list(cases)) or []))
    with pytest.raises(KeyError):
        rr.routes(file, folder=tmp_path / "out", workers=1)
    assert sent == [[1]]


def test_the_command(file, tmp_path):
    given = ["study", str(file), "--out", str(tmp_path / "out"), "--workers", "1", "--no-figures"]
    ended = CliRunner().invoke(app, given)
    assert ended.exit_code == 0
    assert "1 of 2 routes can be driven" in ended.stdout
    assert "warning: tight: The route cannot be driven" in ended.stderr


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("routes: []", "routes"),
        ("routes: [none.yaml]", "none.yaml"),
        ("routes: [ahead.yaml, ahead.yaml]", "Read ahead twice"),
        ("routes: [ahead.yaml]\nvary: {limits.rate: [1, 2]}", "Read `vary` as well as `routes`"),
    ],
)
def test_a_wrong_file(file, text, expected):
    file.write_text(text)
    assert any(expected in str(issue) for issue in rr.lint(file))
    with pytest.raises(rr.InputError, match=expected):
        rr.load_routes(file)


def test_no_route_writes_over_the_study(file):
    routes = file.with_name("routes.yaml")
    routes.write_text("routes: [study.yaml]")
    file.write_text(file.with_name("ahead.yaml").read_text())
    with pytest.raises(rr.InputError, match="Read a route named study"):
        rr.load_routes(routes)


def test_a_study_of_another_kind_is_refused(file):
    with pytest.raises(rr.InputError, match=r"rr\.routes"):
        rr.study(file)
