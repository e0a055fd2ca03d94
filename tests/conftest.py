"""A runner of the command line."""

import pytest
from typer.testing import CliRunner

from rr_opt.cli.main import app


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Runs `rr-opt` in an empty folder; the result has exit_code, stdout and stderr."""
    monkeypatch.chdir(tmp_path)

    def command(*arguments: str):
        return CliRunner().invoke(app, list(arguments))

    return command
