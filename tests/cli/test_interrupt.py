"""Ctrl-C at any moment exits 130, without a traceback and without a half-written file."""

import os
import signal
import subprocess
import sys
import time

import pytest

from rr_opt.interrupt import MESSAGE

ENTRY = "from rr_opt.cli.entry import main; main()"
PROGRAM = f"""
import sys
from rr_opt.cli import steps
reported = steps.StepDisplay.__call__
def tell(self, text):
    print(text, file=sys.stderr, flush=True)
    reported(self, text)
steps.StepDisplay.__call__ = tell
{ENTRY}
"""
LOADING = f"""
import sys
class Tell:
    def find_spec(self, name, path, target=None):
        if name == MODULE:
            print("loading", file=sys.stderr, flush=True)
sys.meta_path.insert(0, Tell())
{ENTRY}
"""
FINALIZING = f"""
import os, signal, sys
class Interrupting:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
class Drop:
    def find_spec(self, name, path, target=None):
        if name == "numpy":
            Interrupting()
sys.meta_path.insert(0, Drop())
{ENTRY}
"""
WRITING = f"""
import pathlib, sys, time
whole = pathlib.Path.write_bytes
def slowly(path, content):
    whole(path, content[: len(content) // 2])
    print("half of it is written", file=sys.stderr, flush=True)
    time.sleep(10)
    whole(path, content)
pathlib.Path.write_bytes = slowly
{ENTRY}
"""


def interrupted(program, arguments, folder, *, after, delay, number=signal.SIGINT):
    """Exit code, stdout and stderr of a run that gets a signal some time after it says a word."""
    command = [sys.executable, "-c", program, *arguments]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder
    ) as running:
        assert running.stderr is not None
        for line in running.stderr:
            if after in line:
                break
        time.sleep(delay)
        os.kill(running.pid, number)
        stdout, stderr = running.communicate(timeout=30)
    return running.returncode, stdout, stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_run_exits_130(tmp_path, number):
    code, stdout, stderr = interrupted(
        PROGRAM,
        ["maximize-speed", "--out", "below/res"],
        tmp_path,
        after="start 1",
        delay=0.05,
        number=number,
    )
    assert code == 130, stderr
    assert stderr.count("Interrupted.") == 1
    assert "Traceback" not in stderr
    assert not stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("module", ["typer", "numpy", "casadi", "scipy", "pydantic"])
def test_interrupted_while_it_loads(tmp_path, module):
    program = f"MODULE = {module!r}\n{LOADING}"
    for delay in (0.0, 0.02):
        code, stdout, stderr = interrupted(
            program, ["maximize-speed"], tmp_path, after="loading", delay=delay
        )
        assert code == 130, stderr
        assert "Traceback" not in stderr
        assert not stdout
    assert list(tmp_path.iterdir()) == []


def test_interrupted_in_a_finalizer(tmp_path):
    """Python cannot raise it there: it is remembered, and said once."""
    command = [sys.executable, "-c", FINALIZING, "maximize-speed"]
    ended = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert ended.returncode == 130, ended.stderr
    assert ended.stderr == f"{MESSAGE}\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("verb", ["simulate", "export"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_while_it_writes(tmp_path, verb, number):
    code, _, stderr = interrupted(
        WRITING, [verb], tmp_path, after="half of it", delay=0.1, number=number
    )
    assert code == 130, stderr
    assert list(tmp_path.iterdir()) == []


STUDY = "problem:\n  gait: {period: 1 s}\nvary:\n  limits.rate: [10 rpm, 20 rpm, 30 rpm]\n"


@pytest.mark.parametrize("delay", [0.05, 0.15, 0.3])
def test_ctrl_c_while_the_processes_of_a_study_start(tmp_path, delay):
    """A terminal sends it to all of them, and they are not ready for it yet."""
    (tmp_path / "study.yaml").write_text(STUDY)
    command = [sys.executable, "-c", PROGRAM, "study", "study.yaml", "--workers", "2"]
    with subprocess.Popen(
        command, stderr=subprocess.PIPE, text=True, cwd=tmp_path, start_new_session=True
    ) as running:
        assert running.stderr is not None
        for line in running.stderr:
            if "case 1 of 3" in line:
                break
        time.sleep(delay)
        os.killpg(running.pid, signal.SIGINT)
        _, stderr = running.communicate(timeout=60)
    assert running.returncode == 130, stderr
    assert "Traceback" not in stderr
    assert "rows are kept" in stderr
