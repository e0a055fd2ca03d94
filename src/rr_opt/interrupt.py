"""Ctrl-C, remembered: compiled code may swallow the exception that Python raises for it.

SIGTERM ends a run in the same way, so that no file is left half written.
"""

from __future__ import annotations

import signal
from types import FrameType

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
