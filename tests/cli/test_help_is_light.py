"""Help comes at once: it loads none of the heavy libraries."""

import subprocess
import sys

HEAVY = ("casadi", "numpy", "matplotlib", "scipy")

PROGRAM = f"""
import sys
from typer.testing import CliRunner
from rr_opt.cli.main import app
result = CliRunner().invoke(app, sys.argv[1:])
assert result.exit_code == 0, result.output
print(result.stdout)
loaded = [name for name in {HEAVY} if name in sys.modules]
assert not loaded, loaded
"""


def _fresh(*arguments):
    return subprocess.run(
        [sys.executable, "-c", PROGRAM, *arguments], capture_output=True, text=True, check=False
    )


def test_help_names_every_verb_and_loads_nothing_heavy():
    done = _fresh("--help")
    assert done.returncode == 0, done.stderr
    for verb in ("maximize-speed", "sweep", "simulate", "reproduce", "inspect", "diagnose"):
        assert verb in done.stdout
    assert [line for line in done.stdout.splitlines() if line.endswith("...")] == [
        "Usage: rr-opt [OPTIONS] COMMAND [ARGS]..."
    ]  # nothing is cut off


def test_help_of_a_verb_loads_nothing_heavy():
    done = _fresh("maximize-speed", "--help")
    assert done.returncode == 0, done.stderr
    assert "--no-figures" in done.stdout
