"""`lint` and `schema` print their result on stdout and exit with 0, or 2 if the input is wrong."""

from __future__ import annotations

import json

from typer.testing import CliRunner

from rr_opt.cli.main import app
from rr_opt.files.source import SHIPPED


def run(*arguments: object):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_good_files():
    result = run("lint", SHIPPED, SHIPPED / "problem.yaml")
    assert result.exit_code == 0
    assert result.stdout == f"{SHIPPED}: OK\n{SHIPPED / 'problem.yaml'}: OK\n"


def test_a_warning_is_printed_and_exits_with_0():
    result = run("lint", SHIPPED / "robot.yaml")
    assert result.exit_code == 0
    assert ": servo.angle_limit: warning: The servo's range, 2.6 rad" in result.stdout


def test_errors_of_all_files(write):
    one, two = write("a: 1\n", "one.yaml"), write("b: 1\n", "two.yaml")
    result = run("lint", one, two, SHIPPED)
    assert result.exit_code == 2
    assert f"{one}:1: a: Read the key 'a'." in result.stdout
    assert f"{two}:1: b: Read the key 'b'." in result.stdout


def test_json(write):
    path = write("a: 1\n")
    result = run("lint", "--json", path, SHIPPED)
    assert result.exit_code == 2
    told = json.loads(result.stdout)
    assert told["ok"] is False
    (issue,) = told["issues"]
    assert issue["message"].startswith("Read the key 'a'.")
    del issue["message"]
    assert issue == {"level": "error", "path": "a", "line": 1, "file": str(path)}


def test_a_result_is_no_input(write):
    text = json.dumps({"status": "optimal", "input_sha256": "0", "numbers": [0.0] * 20_000})
    path = write(text, "result.json")
    result = run("lint", path)
    assert result.exit_code == 2
    assert result.stdout == (
        f"{path}: Read a result, which rr-opt has written. Expected an input file: a problem or a "
        "robot. Results are read by `rr-opt simulate` and `rr-opt export`.\n"
    )


def test_a_result_is_no_robot(write):
    write('{"status": "optimal", "input_sha256": "0"}', "result.json")
    path = write("robot: result.json\n")
    result = run("lint", path)
    assert result.exit_code == 2
    assert result.stdout == (
        f"{path}:1: robot: Read 'result.json', a result. Expected a robot file. "
        "Write what the result has under `robot` to a file, and name that.\n"
    )


def test_a_file_that_is_not_there():
    result = run("lint", "nowhere.yaml")
    assert result.exit_code == 2
    assert result.stdout == "nowhere.yaml: There is no such file. Check its name and folder.\n"


def test_schema():
    result = run("schema", "robot")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["title"] == "rr-opt robot file"


def test_schema_of_another_kind():
    result = run("schema", "robbot")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "Did you mean `robot`?" in result.stderr
