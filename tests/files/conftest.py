"""What the tests of the file layer share: a robot as text, and files written from text."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

ROBOT = """\
platform1: {m: 0.469, I: 0.00386, c: 0.206, a: 0.020, b: 0.050, kappa: 2.0e-5}
platform2: {m: 0.250, I: 0.00175, c: 0.0641, a: 0.020, b: 0.050, kappa: 2.0e-5}
h: 0.020
"""

Write = Callable[..., Path]


@pytest.fixture
def robot_text() -> str:
    return ROBOT


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a text or bytes to a file of a folder that the test owns."""

    def to_file(content: str | bytes, name: str = "file.yaml") -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return to_file
