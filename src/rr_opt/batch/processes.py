"""What a process must know before its work begins: its threads, and which signals wait.

Signals held back while something is done that must not stop in the middle.

Masking them for this thread is not enough: where there are other threads, one of those takes the
signal, and Python runs its handler in the main thread all the same.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
"""As environment variables, to be set before NumPy is loaded."""


@contextmanager
def held_back(*numbers: signal.Signals) -> Iterator[None]:
    """Within it a handler of these signals waits; what came meanwhile is handled at its end."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[tuple[int, FrameType | None]] = []
    handlers: dict[int, Callable[[int, FrameType | None], Any]] = {}
    try:
        # A handler that is not replaced yet may raise while others are.
        for number in numbers:
            handler = signal.getsignal(number)
            if callable(handler):
                handlers[number] = handler
                signal.signal(number, lambda *what: came.append(what))
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number, frame in came:
            handlers[number](number, frame)
