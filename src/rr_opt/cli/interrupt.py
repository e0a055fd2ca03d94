"""Ctrl-C, remembered: compiled solvers may swallow the exception that Python raises for it."""

from __future__ import annotations

import signal
from types import FrameType

_seen = False


def watch() -> None:
    """From now on remember an interrupt beside raising KeyboardInterrupt for it.

    A run that was started to ignore interrupts goes on ignoring them.
    """
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, _remember)


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
