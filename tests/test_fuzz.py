"""Spoiled files end every verb in time, with the right exit code and a message: 600 of them.

`make fuzz` tries others each time; see `tests/robustness/fuzz.py`.
"""

import subprocess
import sys
from pathlib import Path

import pytest

INPUTS, PARTS = 600, 2


@pytest.mark.parametrize("part", range(PARTS))
def test_spoiled_files(part):
    each = INPUTS // PARTS
    numbers = ("--inputs", str(each), "--first", str(part * each), "--seed", "1", "--share", "0.01")
    done = subprocess.run(
        (sys.executable, "-m", "tests.robustness.fuzz", *numbers),
        cwd=Path(__file__).parents[1], capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr[-2000:]
