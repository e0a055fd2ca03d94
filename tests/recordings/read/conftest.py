"""What the tests of the readers share: files written from text or bytes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.written import Write, writer


@pytest.fixture
def write(tmp_path: Path) -> Write:
    return writer(tmp_path, "run.csv")
