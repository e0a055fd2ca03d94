"""A result that is not optimal is driven with a warning, and one that is without."""

import json

import pytest

from rr_opt.files.problem_file import read_problem
from rr_opt.files.record import gait_record, robot_record
from rr_opt.model.gait import SineGait


@pytest.fixture
def drive(run, tmp_path):
    """Drives a result of this status and message by a verb."""

    def command(verb, status, message):
        gait, robot = gait_record(SineGait(0.15, 1.2)), robot_record(read_problem(None).robot)
        record = {"status": status, "message": message, "input_sha256": "0" * 64}
        (tmp_path / "result.json").write_text(json.dumps({**record, "gait": gait, "robot": robot}))
        done = run(verb, "result.json", "--json")
        assert done.exit_code == 0, done.stderr
        reported = [line for line in done.stderr.splitlines(keepends=True) if "warning" in line]
        return json.loads(done.stdout)["status"], "".join(reported)

    return command


@pytest.mark.parametrize("verb", ["simulate", "export"])
def test_status_and_message(drive, verb):
    assert drive(verb, "optimal", "All is well.") == ("optimal", "")
    assert drive(verb, "not_converged", "The replay has another speed.") == (
        "not_converged",
        "warning: result.json: The status of this result is 'not_converged' and not 'optimal'. The "
        "replay has another speed. Its gait is driven anyway.\n",
    )
    assert drive(verb, ["odd"], None) == (
        "['odd']",
        "warning: result.json: The status of this result is ['odd'] and not 'optimal'. Its gait is "
        "driven anyway.\n",
    )


@pytest.mark.parametrize("row", [{"name": "rate"}, {"name": ["rate"], "limit": 1.0}, 3,
                                 {"name": "rate", "limit": "fast"}, {"name": "way", "limit": 1.0},
                                 {"name": "rate", "limit": float("nan")}])  # fmt: skip
def test_a_limit_that_is_none_is_refused(run, tmp_path, row):
    gait, robot = gait_record(SineGait(0.15, 1.2)), robot_record(read_problem(None).robot)
    record = {"status": "optimal", "input_sha256": "0" * 64, "limits": [row]}
    (tmp_path / "result.json").write_text(json.dumps({**record, "gait": gait, "robot": robot}))
    done = run("simulate", "result.json")
    assert done.exit_code == 2
    assert "result.json: limits: Read an entry that is not a limit." in done.stderr
