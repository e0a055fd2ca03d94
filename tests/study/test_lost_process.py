"""A process that dies costs the case it died over alone, and each case is reported once."""

import os
import signal
import tempfile
from concurrent.futures import Future
from pathlib import Path

import pytest

from rr_opt.batch.pools import LocalPool
from rr_opt.batch.run import LOST, PoolLostError, run


def dies_over_three(number):
    """Crashes as a compiled library would."""
    if number == 3:
        os.kill(os.getpid(), signal.SIGSEGV)
    return number * number


@pytest.mark.parametrize("workers", [1, 2])
def test_the_rest_is_done(workers):
    pool = LocalPool(workers)
    try:
        reported = list(run(pool, dies_over_three, {number: number for number in range(8)}))
    finally:
        pool.close()
    assert sorted(key for key, _ in reported) == list(range(8))
    assert dict(reported) == {n: LOST if n == 3 else n * n for n in range(8)}


def dies_once(path):
    if not path.exists():
        path.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "done"


def test_a_case_is_tried_again(tmp_path):
    pool = LocalPool(1)
    try:
        assert dict(run(pool, dies_once, {0: tmp_path / "died"})) == {0: "done"}
    finally:
        pool.close()


def folder_of_its_own(_):
    return Path(tempfile.mkdtemp(prefix="left-"))


def test_what_a_process_leaves_behind_goes_with_the_pool():
    pool = LocalPool(1)
    try:
        left = pool.submit(folder_of_its_own, None).result()
        assert left.is_dir()
    finally:
        pool.close()
    assert not left.exists()


class Gone(LocalPool):
    """A pool that takes back what it was given, as one does whose scheduler is gone."""

    def __init__(self):
        self.workers = 1

    def submit(self, function, argument):
        future = Future()
        future.cancel()
        future.set_running_or_notify_cancel()
        return future


def test_no_row_is_made_up_when_all_processes_are_gone():
    with pytest.raises(PoolLostError, match="repeat the command"):
        list(run(Gone(), dies_over_three, {0: 1, 1: 2}))
