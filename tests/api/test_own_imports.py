"""A function of the library loads what it needs, and not what its neighbours need."""

import subprocess
import sys

import pytest

NOT_NEEDED = {
    "optimise": ("rr_opt.routing", "rr_opt.design.study", "rr_opt.results.turn"),
    "drive": ("rr_opt.routing", "rr_opt.design.study", "rr_opt.results.turn"),
    "study": ("rr_opt.routing", "rr_opt.results.turn"),
}


@pytest.mark.parametrize("module", NOT_NEEDED)
def test_neighbours_are_not_loaded(module):
    program = f"import sys, rr_opt.api.{module}; print(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    loaded = done.stdout.split()
    assert f"rr_opt.api.{module}" in loaded
    assert [name for name in loaded if name.startswith(NOT_NEEDED[module])] == []
