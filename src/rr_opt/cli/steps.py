"""Progress on stderr: which step a verb is at, and for how long it has been running."""

from __future__ import annotations

import re
import sys
from types import TracebackType
from typing import Any, Self

from rr_opt.cli import interrupt

_COUNTED = re.compile(r"(.*?)\s*(\d+) of (\d+)$")


class Steps:
    """A context within which `steps(text)` tells the step; `start 3 of 8` moves a bar.

    On a terminal one line is redrawn; elsewhere nothing is drawn, as logs need no animation.
    A call also ends the work if the user has asked for it.
    """

    def __init__(self) -> None:
        self._bar: Any = None
        self._task: Any = None

    def __enter__(self) -> Self:
        if sys.stderr.isatty():
            self._bar = _bar()
            self._task = self._bar.add_task("starting", total=None)
            self._bar.start()
        return self

    def __call__(self, text: str) -> None:
        """Tell that a step begins."""
        interrupt.check()
        if self._bar is None:
            return
        counted = _COUNTED.fullmatch(text)
        if counted:
            number, total = int(counted[2]), int(counted[3])
            self._bar.update(self._task, description=text, completed=number - 1, total=total)
        else:
            self._bar.update(self._task, description=text, completed=0, total=None)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()
        if kind is None:
            interrupt.check()


def _bar() -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    return Progress(
        TextColumn("{task.description:<28}"),
        BarColumn(bar_width=24),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
    )
