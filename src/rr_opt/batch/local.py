"""Processes of this machine."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from joblib import cpu_count
from joblib.externals.loky import ProcessPoolExecutor

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
_LOOK = 1.0  # s


class LocalPool:
    """So many processes of this machine; None: one for each of its cores that may be used.

    One case takes one core: numerical libraries are kept from starting threads of their own.
    """

    def __init__(self, workers: int | None = None):
        self.workers = workers or cpu_count()
        self._executor = self._started()

    @property
    def ahead(self) -> int:
        """Two cases a process: one that it works at, and the next."""
        return 2 * self.workers

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        """Have function(argument) computed."""
        return self._executor.submit(function, argument)

    def is_lost(self, error: BaseException) -> bool:  # noqa: ARG002 - as every pool
        """Never: what died is told by BrokenExecutor."""
        return False

    def restart(self) -> None:
        """Start new processes."""
        self._executor.shutdown(wait=True, kill_workers=True)
        self._executor = self._started()

    def close(self) -> None:
        """End all processes."""
        self._executor.shutdown(wait=True, kill_workers=True)

    def _started(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            max_workers=self.workers,
            timeout=None,
            initializer=_begin,
            initargs=(os.getpid(),),
            env=dict.fromkeys(_THREADS, "1"),
        )


def _begin(parent: int) -> None:
    """Leave Ctrl-C to the process that gives the work, and do not outlive it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
