"""Dry friction with a true sign, hidden in SciPy's data, is named, and its interval covers it."""

import pytest

from rr_opt.sysid.diagnose import diagnose
from tests.sysid.pendulum.made import recorded


@pytest.mark.parametrize(("seed", "dry"), [(0, 0.05), (1, 0.01)])
def test_named_and_covered(seed, dry):
    found = diagnose(recorded(seed, dry=dry))
    assert found.verdict == "missing_physics"
    assert [one.name for one in found.findings] == ["coulomb_friction"]
    torque = found.findings[0].parameters["torque"]
    assert torque.low <= dry <= torque.high
    assert torque.high - torque.low < 0.1 * dry
    assert found.after < 1.2 < found.before
