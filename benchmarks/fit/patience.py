"""A fit that takes minutes is stopped: it is enough to know that it does."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE = 60.0
"""CPU seconds."""


@contextmanager
def patience(seconds: float) -> Iterator[None]:
    """Raises TimeoutError in the body after this many CPU seconds, between lines of Python only."""

    def stop(*_: object) -> None:
        raise TimeoutError(f"not done in {seconds:g} CPU s")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
