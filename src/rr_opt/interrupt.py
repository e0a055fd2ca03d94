"""Ctrl-C, remembered: compiled code may swallow the exception that Python raises for it.

SIGTERM ends a run in the same way, so that no file is left half written. `held_back` defers both
during an operation that must not be interrupted. Masking them for this thread is not enough: any
other thread takes the signal, and Python still runs its handler in the main thread.
"""

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

MESSAGE = "Interrupted. No file was left half-written."

_SIGNALS = (signal.SIGINT, signal.SIGTERM)

_seen = False


def watch() -> None:
    """From now on remember an interrupt besides raising KeyboardInterrupt for it.

    A run that was started to ignore interrupts continues to ignore them.
    """
    for number in _SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _remember)
    sys.unraisablehook = _unraisable


def ignore() -> None:
    """Ignore interrupts from now on: the work is done, or its failure has been reported."""
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def seen() -> bool:
    """Whether the user has pressed Ctrl-C."""
    return _seen


def check() -> None:
    """Raise KeyboardInterrupt if an earlier one was swallowed."""
    if _seen:
        raise KeyboardInterrupt


def _remember(_number: int, _frame: FrameType | None) -> None:
    global _seen  # noqa: PLW0603 - a signal is global to the process
    _seen = True
    raise KeyboardInterrupt


def _unraisable(what: "sys.UnraisableHookArgs") -> None:
    """Suppress the report of an interrupt in a finalizer: `check` raises it again."""
    if not (_seen and isinstance(what.exc_value, KeyboardInterrupt)):
        sys.__unraisablehook__(what)


@contextmanager
def held_back(*numbers: signal.Signals) -> Iterator[None]:
    """Defer the handlers of these signals; pending ones run at the end."""
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
