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
    reported = run(
        *("record", *RUNS, "--seconds", "2", "--noise", "1 mm, 3 mrad"),
        *("--effect", use, "--out", "dry", "--seal", "answer.json"),
    )
    assert reported.exit_code == 0, reported.stderr
    plain, dry = (
        (tmp_path / name / "run02.csv").read_text().splitlines()[-1].split(",")
        for name in ("rec", "dry")
    )
    assert plain[0] == dry[0]
    assert plain[1] != dry[1]
    assert plain[4] == dry[4]
    answer = json.loads((tmp_path / "answer.json").read_text())
    assert answer["effects"][0]["parameters"]["force1"]["value"] == 2e-3


def test_a_realisation_is_recorded_by_its_own_name(run, tmp_path):
    use = "servo_lag/second_order:tau=20 ms,zeta=0.7"
    words = ("--seconds", "1", "--effect", use, "--out", "rec", "--seal", "answer.json")
    told = run("record", *RUNS, *words, "--engine", "planar")
    assert told.exit_code == 0, told.stderr
    (effect,) = json.loads((tmp_path / "answer.json").read_text())["effects"]
    assert effect["realisation"] == "second_order"
    assert effect["plant"]["zeta"]["value"] == 0.7


def test_a_disturbance_spoils_the_recording_and_is_in_the_answer(run, recorded, tmp_path):
    words = ("--seconds", "2", "--noise", "1 mm, 3 mrad", "--out", "gaps", "--seal", "answer.json")
    assert run("record", *RUNS, *words, "--disturbance", "dropouts").exit_code == 0
    plain, spoilt = ((tmp_path / name / "run01.csv").read_text() for name in ("rec", "gaps"))
    assert ",,," not in plain
    assert ",,," in spoilt
    assert json.loads((tmp_path / "answer.json").read_text())["disturbance"] == "dropouts"


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
    reported = run(
        *("record", *RUNS, "--hide", "parameters", "--seconds", "1", "--out", "case"),
        *("--seal", "answer.json"),
    )
    assert reported.exit_code == 0, reported.stderr
    digest = hashlib.sha256((tmp_path / "answer.json").read_bytes()).hexdigest()
    assert digest in reported.stdout
    assert (tmp_path / "case" / "answer.sha256").read_text().split() == [digest, "answer.json"]
    answer = json.loads((tmp_path / "answer.json").read_text())
    assert answer["verdict"] == "parameters"
    for name in (each["name"] for each in answer["effects"]):
        assert name not in reported.stdout.replace(digest, "")


def test_json_stands_alone(run):
    reported = run(*("record", "--gait", "0.5, 1 s", "--seconds", "1", "--out", "rec", "--json"))
    assert json.loads(reported.stdout) == {
        "folder": "rec",
        "files": ["run01.csv", "experiment.yaml"],
    }


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("--gait", "30 deg"), "Expected an amplitude, a period"),
        (("--gait", "30 deg, 1.2 kg"), "--period"),
        (("--effect", "gremlins"), "cannot hide"),
        (("--disturbance", "rain"), "no disturbance 'rain'"),
        (("--disturbance", "outliers", "--format", "vicon"), "Expected --format csv"),
        (("--effect", "floor_patch:multiplier=2"), "is missing its parameter edge_x"),
        (("--effect", "servo_lag:tau=3 kg"), "--effect servo_lag, tau"),
        (("--effect", "servo_lag:width=3"), "Expected tau"),
        (("--noise", "1 mm"), "--noise"),
        (("--noise", "1 mm, 3 kg"), "Expected a number"),
        (("--hide", "null"), "--seal"),
        (("--hide", "gremlins", "--seal", "a.json"), "no kind of case"),
        (("--gait", "1,1", "--hide", "null", "--seal", "rec/a.json", "--out", "rec"), "outside it"),
        (("--torque", "--format", "c3d"), "--format csv"),
    ],
)
def test_wrong_input(run, arguments, expected):
    reported = run("record", "--seconds", "1", *arguments)
    assert reported.exit_code == 2
    assert expected in reported.stderr
    assert "Traceback" not in reported.stderr


def test_what_record_did_not_write_is_kept(run, recorded, tmp_path):
    file = tmp_path / "rec" / "experiment.yaml"
    again = ("record", *RUNS, "--seconds", "2", "--noise", "1 mm, 3 mrad", "--out", "rec")
    assert run(*again).exit_code == 0
    assert run(*again).exit_code == 0
    written = file.read_text()
    for mine in (written.split("\n", 1)[1], written.replace("use", "use ", 1)):
        file.write_text(mine)
        reported = run(*again)
        assert reported.exit_code == 2
        assert "was not written by `rr-opt record`, or has been edited since" in reported.stderr
        assert file.read_text() == mine


@pytest.mark.parametrize(
    ("use", "said"),
    [
        ("coulomb_friction", "without one it does nothing"),
        ("coulomb_friction:force1=-2 mN", "at least 0"),
        ("servo_lag:tau=-20 ms", "at least 0"),
    ],
)
def test_an_effect_that_is_none(run, tmp_path, use, said):
    reported = run("record", *RUNS, "--seconds", "2", "--effect", use, "--out", "rec")
    assert reported.exit_code == 2
    assert said in reported.stderr
    assert not (tmp_path / "rec").exists()


def test_degrees_for_radians(run):
    reported = run("record", "--gait", "30, 1.2", "--seconds", "1", "--engine", "planar")
    assert reported.exit_code == 0
    assert "run01.csv reaches" in reported.stderr
    assert "write `30 deg`" in reported.stderr
    right = run("record", "--gait", "30 deg, 1.2", "--seconds", "1", "--engine", "planar")
    assert "warning" not in right.stderr
