"""pint is loaded when a unit is written, and not before."""

from __future__ import annotations

import subprocess
import sys

PROGRAM = """
import sys
from rr_opt.units import to_si
assert to_si("1e-5", "m") == 1e-5
assert "pint" not in sys.modules and "casadi" not in sys.modules
assert to_si("1 mm", "m") == 1e-3
assert "pint" in sys.modules
"""


def test_pint_is_loaded_late():
    subprocess.run([sys.executable, "-c", PROGRAM], check=True)
