"""turn, circle and turn-chart say what they found, write it, and end as every verb ends."""

import csv
import json
import math

import pytest

PLAIN = """
robot:
  name: short
  platform1: {m: 0.469, I: 0.00386, c: 236 mm, a: 50 mm, b: 50 mm, k: 0.05 N*s/m}
  platform2: {m: 0.25, I: 0.00116, c: 150 mm, a: 20 mm, b: 50 mm, k: 0.05 N*s/m}
  h: 20 mm
  servo: {angle_limit: 2.6, rate_limit: 30 rpm, torque_limit: 1.5}
gait: {amplitude: [0.05, 1.5], period: [0.3 s, 3 s]}
"""


@pytest.fixture
def plain(tmp_path):
    path = tmp_path / "plain.yaml"
    path.write_text(PLAIN)
    return str(path)


def test_turn_and_back_again(run, plain):
    done = run("turn", plain, "--heading", "-90 deg", "--radius", "50 cm", "--no-figures", "--json")
    assert done.exit_code == 0, done.stderr
    reported = json.loads(done.stdout)
    arc = reported["turn"]["arc"]
    assert arc["heading"] == pytest.approx(-math.pi / 2)
    assert arc["radius"] == pytest.approx(0.5, rel=1e-6)
    assert arc["length"] == pytest.approx(0.25 * math.pi, rel=1e-6)
    assert arc["length"] == pytest.approx(arc["time"] * abs(reported["speed"]), rel=1e-6)
    assert arc["time"] == pytest.approx(arc["periods"] * reported["gait"]["period"])
    assert reported["turn"]["offset_opened"]
    again = run("circle", "out/plain-turn-heading--90deg-radius-0.5m/result.json", "--json")
    circle = json.loads(again.stdout)
    assert circle["radius"] == pytest.approx(0.5, rel=1e-6)
    assert circle["curvature"] < 0
    assert circle["time_for_full_turn"] == pytest.approx(4 * arc["time"], rel=1e-6)


def test_each_question_has_its_own_folder(run, plain, tmp_path):
    for options in (
        ("--radius", "50 cm"),
        ("--radius", "60 cm"),
        ("--heading", "90 deg", "--radius", "50 cm"),
        ("--heading", "90 deg", "--within", "20"),
    ):
        assert run("turn", plain, *options, "--no-figures").exit_code == 0
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {
        "plain-turn-radius-0.5m",
        "plain-turn-radius-0.6m",
        "plain-turn-heading-90deg-radius-0.5m",
        "plain-turn-heading-90deg-within-20s",
    }


def test_the_summary_tells_arc_checks_and_page(run, plain, tmp_path):
    done = run("turn", plain, "--radius", "1", "--out", "res")
    assert done.exit_code == 0, done.stderr
    for text in ("circle", "to the left", "it was freed", "50 periods by CVODES", "From rest"):
        assert text in done.stdout
    assert "Turn</h2>" in (tmp_path / "res" / "report.html").read_text()


def test_out_of_reach(run, plain):
    done = run("turn", plain, "--radius", "5 cm", "--no-figures")
    assert done.exit_code == 3
    assert "The closest feasible one is" in done.stderr


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ((), "Read none of"),
        (("--radius", "1 kg", "--heading", "2 s"), "--heading"),
        (("--radius", "1", "--cycles", "whole"), "without --heading"),
        (("--heading", "90 deg", "--within", "-1 s"), "--within"),
    ],
)
def test_wrong_input(run, options, said):
    done = run("turn", *options)
    assert done.exit_code == 2
    assert said in done.stderr
    assert done.stdout == ""


@pytest.mark.parametrize(
    "options", [("--amplitude", "0", "--period", "1"), ("--amplitude", "1.9", "--period", "1")]
)
def test_a_gait_without_a_circle(run, options):
    done = run("circle", "--quiet", *options)
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1


def test_circle_of_a_straight_gait(run):
    reported = json.loads(run("circle", "--json").stdout)
    assert reported["radius"] is None
    assert reported["centre"] is None
    assert abs(reported["curvature"]) < 1e-9


def test_chart(run, plain, tmp_path):
    done = run("turn-chart", plain, "--out", "res")
    assert done.exit_code == 0, done.stderr
    assert "tightest" in done.stdout
    with (tmp_path / "res" / "turn-chart.csv").open() as file:
        rows = list(csv.DictReader(file))
    by = {(row["amplitude [rad]"], row["period [s]"], row["offset [rad]"]): row for row in rows}
    mirrored = 0
    for (amplitude, period, offset), row in by.items():
        twin = by.get((amplitude, period, f"-{offset}"))
        if twin and row["speed [m/s]"] and offset != "0":
            assert twin["speed [m/s]"] == row["speed [m/s]"]
            assert float(twin["curvature [1/m]"]) == -float(row["curvature [1/m]"])
            mirrored += 1
    assert mirrored > 100


def test_another_question_does_not_lose_its_answer(run, plain, tmp_path):
    def turned(*arguments):
        return run("turn", plain, "--out", "res", "--no-figures", *arguments)

    file = tmp_path / "res" / "result.json"
    assert turned("--radius", "1.5 m").exit_code == 0
    first = file.read_bytes()
    for verb in (("turn", plain, "--radius", "2 m"), ("maximize-speed", plain)):
        done = run(*verb, "--out", "res", "--no-figures")
        assert done.exit_code == 2
        assert "the answer to another question: the turn radius-1.5m. Expected" in done.stderr
    assert file.read_bytes() == first
    assert turned("--radius", "150 cm").exit_code == 0
    assert turned("--radius", "2 m", "--force").exit_code == 0
    assert file.read_bytes() != first
