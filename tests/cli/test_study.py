"""study writes a row a case, goes on where it was, and refuses rows of another study."""

import csv
import json

import pytest

SMALL = """
problem:
  gait: {amplitude: [0.1, 1.0], period: 1 s, offset: 0.0}
  limits: {angle: 2.6, torque: 1.37}
vary:
  limits.rate: [0.1 rpm, 10 rpm, 20 rpm, 25 rpm]
"""
# At 0.1 rpm no gait has the least amplitude.

TWO = """
problem: quick.yaml
vary:
  limits.rate: [20 rpm, 25 rpm]
  direction: [either, backward]
"""


@pytest.fixture
def study(run, tmp_path):
    """Runs `rr-opt study` on a text, with one process."""

    def command(text, *options):
        (tmp_path / "small.yaml").write_text(text)
        return run("study", "small.yaml", "--out", "res", "--workers", "1", *options)

    return command


def table(folder):
    with (folder / "res" / "study.csv").open() as file:
        return list(csv.DictReader(file))


def test_a_case_without_a_gait_is_a_row_with_a_sentence(study, tmp_path):
    done = study(SMALL)
    assert done.exit_code == 0, done.stderr
    assert "1 of 4 cases: no gait that respects all limits" in done.stderr
    first, *others = table(tmp_path)
    assert first["status"] == "infeasible"
    assert "limit" in first["message"]
    assert first["speed [m/s]"] == ""
    assert {row["status"] for row in others} == {"optimal"}
    rates = [float(row["limits.rate [rpm]"]) for row in (first, *others)]
    assert rates == pytest.approx([0.1, 10, 20, 25])
    page = (tmp_path / "res" / "report.html").read_text()
    assert first["message"].split(".")[0] in page.replace("&#x27;", "'")
    assert page.count("data:image/svg+xml") == 3


def test_again_is_from_the_journal_alone(study, tmp_path):
    study(SMALL, "--no-figures")
    before = (tmp_path / "res" / "journal.jsonl").read_bytes()
    text = (tmp_path / "res" / "study.csv").read_text()
    done = study(SMALL, "--no-figures")
    assert done.exit_code == 0
    assert "4 of 4 rows were solved in an earlier run" in done.stderr
    assert (tmp_path / "res" / "journal.jsonl").read_bytes() == before
    assert (tmp_path / "res" / "study.csv").read_text() == text


def test_a_file_that_changed_is_refused_until_restart(study, quick, tmp_path):
    assert study(TWO, "--no-figures").exit_code == 0
    old = table(tmp_path)
    quick.write_text(quick.read_text().replace("1 s", "1.1 s"))
    done = study(TWO, "--no-figures")
    assert done.exit_code == 2
    assert "--restart" in done.stderr
    assert "names changed" in done.stderr
    assert table(tmp_path) == old
    assert study(TWO, "--no-figures", "--restart").exit_code == 0
    assert float(table(tmp_path)[0]["period [s]"]) == pytest.approx(1.1)


def test_a_fastest_case_beyond_the_servo_is_told(study, quick):
    done = study(TWO.replace("25 rpm", "90 rpm"), "--no-figures")
    assert done.exit_code == 0
    assert "the fastest case exceeds its rate limit" in done.stderr
    assert "exceeds" not in study(TWO, "--no-figures", "--restart").stderr


def test_json_stands_alone_and_is_the_file(study, quick, tmp_path):
    done = study(TWO, "--json", "--no-figures")
    reported = json.loads(done.stdout)
    assert reported == json.loads((tmp_path / "res" / "study.json").read_text())
    assert reported["shape"] == [2, 2]
    assert [case["direction"] for case in reported["cases"]] == ["either", "backward"] * 2
    assert {case["drives"] for case in reported["cases"]} == {"backward"}
    assert reported["pareto"]["peak_torque"]


def test_netcdf_has_the_axes_of_the_study(study, quick, tmp_path):
    xarray = pytest.importorskip("xarray")
    assert study(TWO, "--netcdf", "--no-figures").exit_code == 0
    with xarray.open_dataset(tmp_path / "res" / "study.nc", engine="h5netcdf") as data:
        assert data["speed"].dims == ("limits.rate", "direction")
        assert data["speed"].attrs["units"] == "m/s"
        speeds = [float(row["speed [m/s]"]) for row in table(tmp_path)]
        assert data["speed"].values.ravel() == pytest.approx(speeds)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (SMALL.replace("[0.1 rpm, 10 rpm, 20 rpm, 25 rpm]", "[0.1 rpm, 0.2 rpm]"), 3),
        (SMALL.replace("limits.rate", "limits.rat"), 2),
        (SMALL.replace("10 rpm", "-10 rpm"), 2),
        ("gait: {period: 1 s}\n", 2),
        ("vary: {}\n", 2),
    ],
)
def test_exit_codes(study, text, code):
    done = study(text, "--no-figures")
    assert done.exit_code == code, done.output
    assert "Traceback" not in done.output
    assert done.stderr


def test_no_column_is_there_twice(study, quick, tmp_path):
    assert study(TWO + "  inertia_ratio: [0.2]\n", "--no-figures").exit_code == 0
    with (tmp_path / "res" / "study.csv").open() as file:
        names = next(csv.reader(file))
    assert len(names) == len(set(names))
    assert names[:4] == ["case", "limits.rate [rpm]", "direction", "inertia_ratio"]


def test_a_scheduler_that_is_none_is_wrong_input(run, quick, tmp_path):
    pytest.importorskip("distributed")
    (tmp_path / "small.yaml").write_text(TWO)
    done = run("study", "small.yaml", "--scheduler", "foo", "--no-figures")
    assert done.exit_code == 2
    assert "'foo'" in done.stderr
    assert "tcp://host:8786" in done.stderr
    assert done.stdout == ""
