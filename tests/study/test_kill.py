"""Killed at any moment, the same command goes on: no finished row is done again, none is lost."""

import csv
import json
import os
import signal
import subprocess
import sys
import time

STUDY = """
problem:
  gait: {amplitude: [0.1, 1.0], period: 1 s, offset: 0.0}
  limits: {angle: 2.6, torque: 1.37}
vary:
  limits.rate: {from: 10 rpm, to: 60 rpm, count: 31}
"""
COMMAND = [
    *(sys.executable, "-c", "from rr_opt.cli.entry import main; main()"),
    *("study", "study.yaml", "--out", "res", "--workers", "1", "--no-figures"),
]


def lines(path):
    return path.read_text().splitlines() if path.exists() else []


def start(folder):
    return subprocess.Popen(
        COMMAND, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def until(running, journal, count):
    """Wait until the journal has that many lines."""
    end = time.monotonic() + 60
    while len(lines(journal)) < count:
        assert running.poll() is None, running.communicate()
        assert time.monotonic() < end
        time.sleep(0.005)


def test_killed_and_interrupted_and_finished(tmp_path):
    (tmp_path / "study.yaml").write_text(STUDY)
    journal = tmp_path / "res" / "journal.jsonl"
    with start(tmp_path) as running:
        until(running, journal, 6)
        os.kill(running.pid, signal.SIGKILL)
        running.wait()
    before = lines(journal)
    assert not (tmp_path / "res" / "study.csv").exists()
    with start(tmp_path) as running:
        until(running, journal, len(before) + 4)
        os.kill(running.pid, signal.SIGINT)
        stdout, stderr = running.communicate(timeout=30)
    assert running.returncode == 130, stderr
    assert not stdout
    assert "Traceback" not in stderr, stderr
    assert "rows are kept" in stderr
    between = lines(journal)
    with start(tmp_path) as running:
        stdout, stderr = running.communicate(timeout=60)
    assert running.returncode == 0, stderr
    after = lines(journal)
    whole = (
        before if len(before) <= len(between) and between[: len(before)] == before else before[:-1]
    )
    assert between[: len(whole)] == whole
    assert after[: len(between)] == between
    cases = [json.loads(line)["case"] for line in after[1:]]
    assert sorted(cases) == list(range(31))
    with (tmp_path / "res" / "study.csv").open() as file:
        table = list(csv.DictReader(file))
    assert [int(row["case"]) for row in table] == list(range(31))
    assert {row["status"] for row in table} == {"optimal"}
