"""Ctrl-C, remembered: compiled code may swallow the exception that Python raises for it.

SIGTERM ends a run in the same way, so that no file is left half written. `held_back` lets both
wait while something is done that must not stop in the middle. Masking them for this thread is not
enough: where there are other threads, one of those takes the signal, and Python runs its handler
in the main thread all the same.
"""

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

MESSAGE = "Interrupted. No file was left half written."

_SIGNALS = (signal.SIGINT, signal.SIGTERM)

_seen = False


def watch() -> None:
    """From now on remember an interrupt beside raising KeyboardInterrupt for it.

    A run that was started to ignore interrupts goes on ignoring them.
    """
    for number in _SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _remember)
    sys.unraisablehook = _unraisable


def ignore() -> None:
    """Ignore interrupts from now on: the work is done, or its failure is reported."""
    for number in _SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def seen() -> bool:
    """Whether the user has pressed Ctrl-C."""
    return _seen


def check() -> None:
    """Raise KeyboardInterrupt if an earlier one went missing."""
    if _seen:
        raise KeyboardInterrupt


def _remember(_number: int, _frame: FrameType | None) -> None:
    global _seen  # noqa: PLW0603 - a signal is global to the process
    _seen = True
    raise KeyboardInterrupt


def _unraisable(what: "sys.UnraisableHookArgs") -> None:
    """Say nothing of an interrupt that fell into a finalizer: `check` raises it again."""
    if not (_seen and isinstance(what.exc_value, KeyboardInterrupt)):
        sys.__unraisablehook__(what)


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
