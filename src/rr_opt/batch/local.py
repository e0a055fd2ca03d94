"""Processes of this machine."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from multiprocessing import resource_tracker
from typing import Any

from joblib import cpu_count
from joblib.externals.loky import ProcessPoolExecutor

from rr_opt.batch import ONE_THREAD
from rr_opt.interrupt import held_back

_LOOK = 1.0  # s
_HANDED_ON = 1.0
"""Time that the executor gets to hand on work before it is ended, s."""


class LocalPool:
    """`workers` processes on this machine; None: one per usable core.

    One case takes one core: numerical libraries are kept from starting threads of their own.
    """

    def __init__(self, workers: int | None = None):
        self.workers = workers or cpu_count()
        self._executor = self._started()
        self._given: set[Future[Any]] = set()

    @property
    def ahead(self) -> int:
        """Two cases a process: one that it works at, and the next."""
        return 2 * self.workers

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        """Have function(argument) computed."""
        # An interrupt in the middle would leave work behind that nobody knows of.
        with held_back(signal.SIGINT, signal.SIGTERM), _blocked(signal.SIGINT):
            future = self._executor.submit(function, argument)
            self._given = {one for one in self._given if not one.done()} | {future}
        return future

    def is_lost(self, error: BaseException) -> bool:  # noqa: ARG002 - as every pool
        """Never: BrokenExecutor reports what died."""
        return False

    def restart(self) -> None:
        """Start new processes."""
        self.close()
        self._executor = self._started()

    def close(self) -> None:
        """End all processes."""
        # The executor's own thread fails loudly if it is ended before it has handed work on.
        end = time.monotonic() + _HANDED_ON
        while time.monotonic() < end and not all(f.running() or f.done() for f in self._given):
            time.sleep(_HANDED_ON / 100)
        self._given = set()
        self._executor.shutdown(wait=True, kill_workers=True)

    def _started(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            max_workers=self.workers,
            timeout=None,
            initializer=_begin,
            initargs=(os.getpid(),),
            env=ONE_THREAD,
        )


@contextmanager
def _blocked(number: signal.Signals) -> Iterator[None]:
    """Within it this thread takes no such signal, and neither do processes started here: they
    inherit the mask, and Ctrl-C goes to them too while they still load."""
    # Which would unblock it if it were started within (Python 3.11).
    resource_tracker.ensure_running()
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, [number])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _begin(parent: int) -> None:
    """Leave Ctrl-C to the process that gives the work, and do not outlive it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        never = threading.Event()
        while os.getppid() == parent:
            never.wait(_LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
