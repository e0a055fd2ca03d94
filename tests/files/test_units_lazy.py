"""pint is loaded for rare units alone; the table of common ones agrees with it."""

from __future__ import annotations

import subprocess
import sys

import pint
import pytest

from rr_opt import units

PROGRAM = """
import sys
from rr_opt.units import to_si
assert to_si("1e-5", "m") == 1e-5
assert to_si("14 kgf*cm", "N m") == 14 * 0.0980665
assert "pint" not in sys.modules and "casadi" not in sys.modules
assert to_si("1 inch", "m") == 0.0254
assert "pint" in sys.modules
"""


def test_pint_is_loaded_late():
    subprocess.run([sys.executable, "-c", PROGRAM], check=True)


@pytest.mark.parametrize("name", units._COMMON)
def test_the_table_agrees_with_pint(name: str):
    factor, base = units._COMMON[name]
    one = pint.get_application_registry()(f"1 {name}").to_base_units()
    assert one.magnitude == factor
    assert f"{one.units:~C}" == base.replace(" ", "*").replace("^", "**")
