"""A trial on a dask cluster ends as one on this machine does, though a worker dies in it."""

import json
import os
import signal
import time

import pytest

from tests.cluster import SCHEDULER, WORKER, free_port

pytest.importorskip("distributed")

TRIAL = ("prove", "--seed", "5eed", "--kinds", "null", "--engine", "planar", "--cases", "2")


def test_a_trial_outlives_a_worker(started, tmp_path):
    address = f"tcp://127.0.0.1:{free_port()}"
    started(*SCHEDULER, address)
    first, _second = started(*WORKER, address), started(*WORKER, address)
    program = ("-c", "from rr_opt.cli.entry import main; main()")
    trial = started(*program, *TRIAL, "--out", "proof", "--scheduler", address)
    journal, end, killed = tmp_path / "proof" / "made.jsonl", time.monotonic() + 240, False
    while trial.poll() is None and time.monotonic() < end:
        if not killed and journal.exists() and len(journal.read_text().splitlines()) > 1:
            os.kill(first.pid, signal.SIGKILL)
            killed = True
        time.sleep(0.01)
    told = "\n".join(path.read_text() for path in sorted(tmp_path.glob("log*")))
    assert killed, told
    assert trial.returncode == 0, told
    rows = [json.loads(line) for line in journal.read_text().splitlines()[1:]]
    assert sorted(row["case"] for row in rows) == [1, 2]
    assert not any(row["failed"] for row in rows)
    proof = json.loads((tmp_path / "proof" / "proof.json").read_text())
    assert (proof["cases"], proof["misses"]) == (2, []), told
