"""Work shared out over processes, as a `map` whose results come in order."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any

from rr_opt import interrupt
from rr_opt.batch.local import LocalPool
from rr_opt.batch.run import run

_WORKERS = 2


class SharedWork:
    """Calls function(item) for every item, in some processes; both have to be picklable.

    workers  how many; None: two, or on a single core one. One is this process itself
    Other processes load what they need while the caller is still at work of its own.
    """

    def __init__(self, workers: int | None = None) -> None:
        workers = workers or min(_WORKERS, os.cpu_count() or 1)
        self._pool = LocalPool(workers) if workers > 1 else None
        if self._pool:
            for _ in range(workers):
                self._pool.submit(_load, None)

    def __call__(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        """The results in the order of the items; what a process died over is done here."""
        if self._pool is None:
            return [_here(function, item) for item in items]
        tasks = dict(enumerate(items))
        done: dict[int, Any] = {}
        for key, result in run(self._pool, function, tasks):
            interrupt.check()
            done[key] = function(tasks[key]) if isinstance(result, str) else result
        return [done[key] for key in tasks]

    def close(self) -> None:
        """End the processes."""
        if self._pool:
            self._pool.close()


def _here(function: Callable[[Any], Any], item: Any) -> Any:
    interrupt.check()
    return function(item)


def _load(_: None) -> None:
    """Load what a fit needs."""
