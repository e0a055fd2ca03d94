"""Drag that grows with the square of the speed is called that, and not Coulomb friction."""

from rr_opt.sysid.diagnose import diagnose
from tests.sysid.pendulum.made import recorded


def test_named():
    found = diagnose(recorded(0, drag=0.005))
    assert [one.name for one in found.findings] == ["quadratic_drag"]
