"""What the tests of the command line share: small problems."""

from pathlib import Path

import pytest

QUICK = """
gait: {amplitude: [0.1, 1.0], period: 1 s, offset: 0.0}
limits: {angle: 2.6, rate: 30 rpm, torque: 1.37}
"""

IMPOSSIBLE = """
gait: {amplitude: [1.0, 2.0], period: [0.3, 0.5]}
limits: {rate: 1 rpm}
"""


@pytest.fixture
def quick(tmp_path) -> Path:
    path = tmp_path / "quick.yaml"
    path.write_text(QUICK)
    return path


@pytest.fixture
def impossible(tmp_path) -> Path:
    path = tmp_path / "impossible.yaml"
    path.write_text(IMPOSSIBLE)
    return path
