"""What runs cases: processes that take a function and its argument, and may die over it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Protocol


class Pool(Protocol):
    """Processes that work at the same time.

    A future whose process died raises BrokenExecutor, and then every other future of the pool may
    too; `restart` makes the pool usable again.
    """

    @property
    def ahead(self) -> int:
        """How many cases to hand out at a time, so that no process waits."""
        ...

    def submit(self, function: Callable[[Any], Any], argument: Any) -> Future[Any]:
        """Have function(argument) computed."""
        ...

    def is_lost(self, error: BaseException) -> bool:
        """Whether an error means that the pool tried a case again and again and gave it up."""
        ...

    def restart(self) -> None:
        """Start new processes in place of those that died."""
        ...

    def close(self) -> None:
        """End the work, finished or not."""
        ...
