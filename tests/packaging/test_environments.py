"""From a bare clone, every environment is made before it is used."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("target", ["run", "test", "docs", "bench"])
def test_an_environment_is_made_before_it_is_used(target, tmp_path):
    for name in ("Makefile", "pyproject.toml", "requirements.lock"):
        shutil.copy(ROOT / name, tmp_path)
    dry_run = subprocess.check_output(["make", "-n", target], cwd=tmp_path, text=True)
    made = set()
    for line in dry_run.splitlines():
        for used in re.findall(r"(\.venv\S*)/bin/", line):
            assert used in made, line
        made |= set(re.findall(r"venv --clear (\.venv\S*)$", line.strip(" ;\\")))
    assert made
