"""A runner of the command line, and processes that end with their test."""

import signal
import subprocess
import sys

import pytest
from typer.testing import CliRunner

from rr_opt.cli.main import app

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # So a shell starts what it puts in the background, and the processes of tests inherit it.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Runs `rr-opt` in an empty folder; the result has exit_code, stdout and stderr."""
    monkeypatch.chdir(tmp_path)

    def command(*arguments: str):
        return CliRunner().invoke(app, list(arguments))

    return command


@pytest.fixture
def started(tmp_path):
    """Starts Python with arguments; what it prints goes to log0, log1, ... in the folder."""
    running = []

    def start(*arguments: str):
        with (tmp_path / f"log{len(running)}").open("w") as log:
            process = subprocess.Popen(
                [sys.executable, *arguments], cwd=tmp_path, stdout=log, stderr=log
            )
        running.append(process)
        return process

    yield start
    for process in running:
        process.kill()
        process.wait()
