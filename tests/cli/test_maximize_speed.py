"""maximize-speed leaves what its users and their scripts rely on."""

import json
import re

import pytest

KEYS = {
    *("status", "message", "gait", "inertia_ratio", "speed", "cycle", "limits", "check"),
    *("solver", "version", "input_sha256"),
}


def strict(text):
    def refuse(word):
        raise AssertionError(f"{word} is not JSON")

    return json.loads(text, parse_constant=refuse)


@pytest.fixture
def solved(run, quick):
    return run("maximize-speed", str(quick), "--out", "res", "--no-figures", "--json")


def test_result_has_the_promised_keys(solved, tmp_path):
    result = strict((tmp_path / "res" / "result.json").read_text())
    assert result.keys() >= KEYS
    assert result["status"] == "optimal"
    assert result["gait"].keys() >= {"shape", "amplitude", "period", "offset"}
    assert result["cycle"].keys() == {"dx", "dy", "dpsi", "radius"}
    assert result["check"].keys() >= {"sweep_points", "sweep_best", "gap", "replay_error"}
    assert result["solver"].keys() >= {"starts", "iterations", "distinct_optima"}
    assert [limit["name"] for limit in result["limits"]] == [
        *("angle", "rate", "torque", "singularity", "grip")
    ]
    for limit in result["limits"]:
        assert limit.keys() >= {"name", "value", "limit", "active", "shadow_price"}
    for optimum in result["solver"]["distinct_optima"]:
        assert optimum.keys() == {"speed", "gait", "inertia_ratio"}
    assert re.fullmatch("[0-9a-f]{64}", result["input_sha256"])


def test_json_stands_alone_on_stdout(solved, tmp_path):
    assert solved.exit_code == 0, solved.stderr
    assert strict(solved.stdout) == strict((tmp_path / "res" / "result.json").read_text())


def test_a_straight_gait_has_no_radius(solved):
    assert strict(solved.stdout)["cycle"]["radius"] is None


def test_active_limit_carries_its_price_and_others_none(solved):
    limits = {limit["name"]: limit for limit in strict(solved.stdout)["limits"]}
    assert limits["rate"]["active"]
    assert limits["rate"]["shadow_price"] > 0
    assert not limits["torque"]["active"]
    assert limits["torque"]["shadow_price"] == 0


def test_no_temporary_file_is_left(solved, tmp_path):
    names = {path.name for path in (tmp_path / "res").iterdir()}
    assert names == {"result.json", "trajectory.csv"}


def test_summary_tells_gait_limits_and_checks(run, quick):
    text = run("maximize-speed", str(quick), "--no-figures").stdout
    for words in ("amplitude", "deg", "Hz", "mm/s", "rpm", "Replay", "Sweep", "out/quick"):
        assert words in text


def test_infeasible_problem_exits_3_and_says_why_everywhere(run, impossible, tmp_path):
    done = run("maximize-speed", str(impossible), "--out", "res", "--json")
    assert done.exit_code == 3
    result = strict(done.stdout)
    assert result.keys() >= KEYS
    assert result["status"] == "infeasible"
    assert result["gait"] is None
    assert "rate" in result["message"]
    assert result["message"] in done.stderr
    page = (tmp_path / "res" / "report.html").read_text()
    assert "No gait respects all limits" in page


def test_an_earlier_figure_does_not_survive_a_run_without(run, impossible, tmp_path):
    (tmp_path / "res").mkdir()
    (tmp_path / "res" / "path.svg").write_text("old")
    run("maximize-speed", str(impossible), "--out", "res")
    assert not (tmp_path / "res" / "path.svg").exists()
