"""record writes an experiment folder, and seals what it hides."""

import hashlib
import json

import pytest

RUNS = ("--gait", "30 deg, 1.2 s, 0, rest, holdout", "--gait", "0.6, 1 s, 10 deg")


@pytest.fixture
def recorded(run):
    return run("record", *RUNS, "--seconds", "2", "--noise", "1 mm, 3 mrad", "--out", "rec")


def test_the_folder_can_be_used(recorded, run, tmp_path):
    assert recorded.exit_code == 0, recorded.stderr
    assert sorted(path.name for path in (tmp_path / "rec").iterdir()) == [
        "experiment.yaml",
        "run01.csv",
        "run02.csv",
    ]
    assert run("lint", "rec").exit_code == 0


def test_an_effect_changes_the_motion_and_nothing_else(run, recorded, tmp_path):
    use = "coulomb_friction:force1=2 mN,force2=0.002"
    told = run(
        *("record", *RUNS, "--seconds", "2", "--noise", "1 mm, 3 mrad"),
        *("--effect", use, "--out", "dry", "--seal", "answer.json"),
    )
    assert told.exit_code == 0, told.stderr
    plain, dry = (
        (tmp_path / name / "run02.csv").read_text().splitlines()[-1].split(",")
        for name in ("rec", "dry")
    )
    assert plain[0] == dry[0]
    assert plain[1] != dry[1]
    assert plain[4] == dry[4]
    answer = json.loads((tmp_path / "answer.json").read_text())
    assert answer["effects"][0]["parameters"]["force1"]["value"] == 2e-3


def test_either_engine_records_the_same_run(run, tmp_path):
    ends = []
    for engine in ("mujoco", "planar"):
        words = ("--seconds", "2", "--noise", "1 um, 1 urad", "--out", engine, "--engine", engine)
        assert run("record", *RUNS, *words).exit_code == 0
        last = (tmp_path / engine / "run02.csv").read_text().splitlines()[-1]
        ends.append([float(cell) for cell in last.split(",")])
    assert ends[0] == pytest.approx(ends[1], abs=1e-3)
    assert ends[0] != ends[1]


def test_a_hidden_case_is_sealed(run, tmp_path):
    told = run(
        *("record", *RUNS, "--hide", "parameters", "--seconds", "1", "--out", "case"),
        *("--seal", "answer.json"),
    )
    assert told.exit_code == 0, told.stderr
    digest = hashlib.sha256((tmp_path / "answer.json").read_bytes()).hexdigest()
    assert digest in told.stdout
    assert (tmp_path / "case" / "answer.sha256").read_text().split() == [digest, "answer.json"]
    answer = json.loads((tmp_path / "answer.json").read_text())
    assert answer["verdict"] == "parameters"
    for name in (each["name"] for each in answer["effects"]):
        assert name not in told.stdout.replace(digest, "")


def test_json_stands_alone(run):
    told = run(*("record", "--gait", "0.5, 1 s", "--seconds", "1", "--out", "rec", "--json"))
    assert json.loads(told.stdout) == {"folder": "rec", "files": ["run01.csv", "experiment.yaml"]}


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("--gait", "30 deg"), "Expected amplitude, period"),
        (("--gait", "30 deg, 1.2 kg"), "--period"),
        (("--effect", "gremlins"), "cannot hide"),
        (("--effect", "servo_lag"), "lacks its parameter tau"),
        (("--effect", "servo_lag:tau=3 kg"), "--effect servo_lag, tau"),
        (("--effect", "servo_lag:width=3"), "Expected tau"),
        (("--noise", "1 mm"), "--noise"),
        (("--noise", "1 mm, 3 kg"), "Expected a number"),
        (("--hide", "null"), "--seal"),
        (("--hide", "gremlins", "--seal", "a.json"), "no kind of case"),
        (("--gait", "1,1", "--hide", "null", "--seal", "rec/a.json", "--out", "rec"), "apart"),
        (("--torque", "--format", "c3d"), "--format csv"),
    ],
)
def test_wrong_input(run, arguments, expected):
    told = run("record", "--seconds", "1", *arguments)
    assert told.exit_code == 2
    assert expected in told.stderr
    assert "Traceback" not in told.stderr
