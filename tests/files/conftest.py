"""What the tests of the file layer share: a robot as text, and files written from text."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.written import Write, writer

ROBOT = """\
platform1: {m: 0.469, I: 0.00386, c: 0.206, a: 0.020, b: 0.050, kappa: 2.0e-5}
platform2: {m: 0.250, I: 0.00175, c: 0.0641, a: 0.020, b: 0.050, kappa: 2.0e-5}
h: 0.020
"""


@pytest.fixture
def robot_text() -> str:
    return ROBOT


@pytest.fixture
def write(tmp_path: Path) -> Write:
    return writer(tmp_path, "file.yaml")
