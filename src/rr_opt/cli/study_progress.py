"""Progress of a study on stderr: how many cases are done, and how long the others will take."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Any, Self

from rr_opt.cli import interrupt


class CaseProgress:
    """A context whose calls count finished cases; a bar with the time left, on a terminal only.

    A call also ends the work if the user has asked for it.
    """

    def __init__(self, done: int, total: int):
        self._done, self._total = done, total
        self._bar: Any = None
        self._task: Any = None

    def __enter__(self) -> Self:
        if sys.stderr.isatty():
            self._bar = _bar()
            self._task = self._bar.add_task("cases", total=self._total, completed=self._done)
            self._bar.start()
        return self

    def __call__(self) -> None:
        """One more case is finished."""
        interrupt.check()
        if self._bar is not None:
            self._bar.advance(self._task)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()


def _bar() -> Any:
    from rich.console import Console  # noqa: PLC0415
    from rich.progress import (  # noqa: PLC0415
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    return Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        speed_estimate_period=60,
    )
