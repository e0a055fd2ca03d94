"""Every verb has -h and -q, and -o where it writes; progress is a line a stage, unless -q."""

import pytest
from typer.main import get_command

from rr_opt.cli.main import app
from rr_opt.cli.steps import StepDisplay

GROUP = get_command(app)
VERBS = GROUP.list_commands(None)
PRINT_ONLY = {"circle", "lint", "schema"}
GAIT = ("--amplitude", "0.5", "--period", "1")


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_has_the_short_options(run, verb):
    options = {name for one in GROUP.get_command(None, verb).params for name in one.opts}
    assert {"-q", "--quiet"} <= options
    assert ("-o" in options) == ("--out" in options) == (verb not in PRINT_ONLY)
    assert run(verb, "-h").stdout == run(verb, "--help").stdout


def test_a_stage_is_a_line_with_the_time(run):
    reported = run("circle", *GAIT, "--offset", "0.1").stderr
    assert [line.split("s  ")[1] for line in reported.splitlines()] == ["steady cycle"]


def test_of_many_equal_steps_each_quarter_is_reported(capsys):
    with StepDisplay() as steps:
        for number in range(1, 41):
            steps(f"case {number} of 40")
        steps("files")
    reported = [line.split("s  ")[1] for line in capsys.readouterr().err.splitlines()]
    assert reported == [*(f"case {n} of 40" for n in (1, 10, 20, 30, 40)), "files"]


def test_quiet_is_silent_but_for_errors(run):
    reported = run("simulate", "--seconds", "0.5", "--out", "res").stderr
    assert "warning: No amplitude and period given" in reported
    assert "simulate by CVODES" in reported
    done = run("simulate", "--seconds", "0.5", "--out", "res", "-q")
    assert (done.exit_code, done.stderr) == (0, "")
    assert run("simulate", "nowhere.yaml", "-q").stderr
    # Another run in the same process is not silent.
    assert run("circle", *GAIT).stderr
