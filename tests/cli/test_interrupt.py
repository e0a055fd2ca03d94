"""Ctrl-C exits 130 at once, without a traceback and without a half-written file."""

import os
import signal
import subprocess
import sys
import time

PROGRAM = """
import sys, threading
from rr_opt.cli import steps
from rr_opt.cli.main import main
told = steps.Steps.__call__
def tell(self, text):
    print(text, file=sys.stderr, flush=True)
    told(self, text)
steps.Steps.__call__ = tell
main()
"""


def test_interrupted_run_exits_130(tmp_path):
    out = tmp_path / "res"
    command = [sys.executable, "-c", PROGRAM, "maximize-speed", "--out", str(out)]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as running:
        assert running.stderr is not None
        for line in running.stderr:
            if "start 1" in line:
                break
        time.sleep(0.05)
        os.kill(running.pid, signal.SIGINT)
        stdout, stderr = running.communicate(timeout=30)
    assert running.returncode == 130, stderr
    assert "Traceback" not in stderr
    assert not stdout
    assert list(out.iterdir()) == []
