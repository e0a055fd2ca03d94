"""Where nothing is hidden, nothing is found: 20 pendulums by lot."""

import pytest

from rr_opt.sysid.diagnose import diagnose
from tests.sysid.pendulum.made import recorded


@pytest.mark.parametrize("seed", range(20))
def test_null(seed):
    found = diagnose(recorded(seed, runs=2))
    assert found.verdict == "consistent"
    assert not found.findings
