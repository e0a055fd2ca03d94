"""Work shared out over processes, as a `map` whose results come in order."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from rr_opt.batch.local import LocalPool
from rr_opt.batch.run import run
from rr_opt.cli import interrupt

_WORKERS = 2


class SharedWork:
    """Calls function(item) for every item, in two processes; both have to be picklable.

    The processes load what they need while the caller is still at work of its own.
    """

    def __init__(self) -> None:
        self._pool = LocalPool(_WORKERS)
        for _ in range(_WORKERS):
            self._pool.submit(_load, None)

    def __call__(self, function: Callable[[Any], Any], items: Iterable[Any]) -> list[Any]:
        """The results in the order of the items; what a process died over is done here."""
        tasks = dict(enumerate(items))
        done: dict[int, Any] = {}
        for key, result in run(self._pool, function, tasks):
            interrupt.check()
            done[key] = function(tasks[key]) if isinstance(result, str) else result
        return [done[key] for key in tasks]

    def close(self) -> None:
        """End the processes."""
        self._pool.close()


def _load(_: None) -> None:
    """Load what a fit needs."""
    from rr_opt.diagnose import explain, racer  # noqa: F401, PLC0415
