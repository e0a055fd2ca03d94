"""Progress on stderr: the current step of a verb, and the time elapsed."""

import re
import sys
import time
from typing import Any, Self

from rr_opt import interrupt

_COUNTED = re.compile(r"(.*?)\s*(\d+) of (\d+)$")
_PARTS = 4
"""Reports per counted stage if stderr is not a terminal."""

_quiet = False


def silence(quiet: bool) -> None:
    """Set whether this process reports progress and warnings."""
    global _quiet  # noqa: PLW0603 - there is one stderr
    _quiet = quiet


def silent() -> bool:
    """Whether the user wants no progress and no warnings."""
    return _quiet


class StepDisplay:
    """A context within which `steps(text)` shows the step; `start 3 of 8` moves a bar.

    On a terminal one line is redrawn; elsewhere each stage is a line. A call also raises a pending
    interrupt.
    """

    def __init__(self) -> None:
        self._bar: Any = None
        self._task: Any = None
        self._stage: Any = None
        self._begun = time.monotonic()

    def __enter__(self) -> Self:
        if sys.stderr.isatty() and not _quiet:
            self._bar = _bar()
            self._task = self._bar.add_task("starting", total=None)
            self._bar.start()
        return self

    def __call__(self, text: str) -> None:
        """Show that a step begins."""
        interrupt.check()
        counted = _COUNTED.fullmatch(text)
        number, total = (int(counted[2]), int(counted[3])) if counted else (1, None)
        if self._bar is not None:
            self._bar.update(self._task, description=text, completed=number - 1, total=total)
        elif not _quiet:
            stage = (counted[1], _PARTS * number // (total or 1)) if counted else text
            if stage != self._stage:
                seconds = time.monotonic() - self._begun
                print(f"{seconds:6.1f} s  {text}", file=sys.stderr, flush=True)  # noqa: T201
            self._stage = stage

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()
        if kind is None:
            interrupt.check()


def _bar() -> Any:
    from rich import progress as rich
    from rich.console import Console

    return rich.Progress(
        rich.TextColumn("{task.description:<28}"),
        rich.BarColumn(bar_width=24),
        rich.TimeElapsedColumn(),
        rich.TextColumn("left"),
        rich.TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        speed_estimate_period=60,
    )
