"""An interrupt while work is handed to a process waits until that work is known."""

import os
import signal
import time

import pytest

from rr_opt.batch.pools import LocalPool
from rr_opt.interrupt import held_back


def wait_for_it(seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        time.sleep(0.01)


def test_interrupted_while_work_is_handed_over(monkeypatch):
    pool = LocalPool(1)
    hand_over = pool._executor.submit
    handed = []

    def interrupted(*work):
        handed.append(hand_over(*work))
        os.kill(os.getpid(), signal.SIGINT)
        wait_for_it(0.1)
        return handed[-1]

    monkeypatch.setattr(pool._executor, "submit", interrupted)
    try:
        with pytest.raises(KeyboardInterrupt):
            pool.submit(abs, -1)
        assert set(handed) <= pool._given
        assert handed[0].result(timeout=30) == 1
    finally:
        pool.close()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_stopped_while_the_handlers_are_replaced(monkeypatch):
    """SIGTERM comes when SIGINT has its other handler and SIGTERM has not."""
    replace = signal.signal

    def stop(number, frame):
        raise SystemExit

    def interrupted(number, handler):
        replace(number, handler)
        monkeypatch.undo()
        signal.raise_signal(signal.SIGTERM)

    before = signal.signal(signal.SIGTERM, stop)
    monkeypatch.setattr(signal, "signal", interrupted)
    try:
        with pytest.raises(SystemExit), held_back(signal.SIGINT, signal.SIGTERM):
            pytest.fail("it went on")
        assert signal.getsignal(signal.SIGTERM) is stop
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGTERM, before)
        signal.signal(signal.SIGINT, signal.default_int_handler)
