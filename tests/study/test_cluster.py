"""On a cluster one of whose workers is killed during the study, every row is there, once."""

import json
import os
import signal
import socket
import time

import pytest

from tests.cluster import SCHEDULER, WORKER, free_port

pytest.importorskip("distributed")

STUDY = """
problem:
  gait: {amplitude: [0.1, 1.0], period: 1 s, offset: 0.0}
  limits: {angle: 2.6, torque: 1.37}
vary:
  limits.rate: {from: 10 rpm, to: 60 rpm, count: 25}
"""


def test_a_killed_worker_costs_no_row(started, tmp_path):
    (tmp_path / "study.yaml").write_text(STUDY)
    address = f"tcp://127.0.0.1:{free_port()}"
    started(*SCHEDULER, address)
    first, _second = started(*WORKER, address), started(*WORKER, address)
    journal = tmp_path / "res" / "journal.jsonl"
    study = started(
        *("-c", "from rr_opt.cli.entry import main; main()", "study", "study.yaml", "--cold"),
        *("--out", "res", "--scheduler", address, "--no-figures"),
    )
    end = time.monotonic() + 90
    killed = False
    while study.poll() is None and time.monotonic() < end:
        if not killed and journal.exists() and len(journal.read_text().splitlines()) > 4:
            os.kill(first.pid, signal.SIGKILL)
            killed = True
        time.sleep(0.01)
    reported = "\n".join(path.read_text() for path in sorted(tmp_path.glob("log*")))
    assert killed, reported
    assert study.returncode == 0, reported
    rows = [json.loads(line) for line in journal.read_text().splitlines()[1:]]
    assert sorted(row["case"] for row in rows) == list(range(25))
    assert {row["status"] for row in rows} == {"optimal"}


@pytest.mark.parametrize(
    "address", ["", "foo", "tcp://127.0.0.1", "tcp://127.0.0.1:x", "tcp://127.0.0.1:99999"]
)
def test_no_scheduler_is_wrong_input_before_a_client_is_made(monkeypatch, address):
    from rr_opt.batch import pools
    from rr_opt.outcome import InputError

    monkeypatch.setattr(pools, "_client", lambda: pytest.fail)
    with pytest.raises(InputError, match="No dask scheduler answers"):
        pools.ClusterPool(address or f"tcp://127.0.0.1:{free_port()}")


def test_what_listens_and_says_nothing_is_no_scheduler(monkeypatch):
    from rr_opt.batch import pools
    from rr_opt.outcome import InputError

    monkeypatch.setattr(pools, "_client", lambda: pytest.fail)
    monkeypatch.setattr(pools, "_PATIENCE", 0.2)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        with pytest.raises(InputError, match="No dask scheduler answers"):
            pools.ClusterPool(f"tcp://127.0.0.1:{silent.getsockname()[1]}")
