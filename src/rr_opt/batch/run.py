"""Bring every case to an outcome, even if the processes that compute it die.

When a process dies, it is unknown which case killed it. So every case in progress is repeated, each
alone in the pool: one that kills its process again is reported as lost.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from typing import TYPE_CHECKING, Any, TypeVar

from rr_opt.outcome import RollerRacerError

if TYPE_CHECKING:
    from rr_opt.batch.pools import Pool


def pool_of(workers: int | None, scheduler: str | None) -> Pool:
    """`workers` processes on this machine (None: one per core), or those of a dask cluster."""
    # Imported here as it loads joblib, which only studies and trials need.
    from rr_opt.batch.pools import ClusterPool, LocalPool

    return ClusterPool(scheduler) if scheduler else LocalPool(workers)


Task = TypeVar("Task")
Result = TypeVar("Result")

LOST = (
    "The process that solved this case died each time it was tried. It may have run out of memory, "
    "or a compiled library may have crashed. Solve the case alone with `rr-opt maximize-speed` to "
    "see why."
)


class PoolLostError(RollerRacerError):
    """The processes are gone for all cases, not because of one."""


def run(
    pool: Pool, function: Callable[[Task], Result], tasks: Mapping[int, Task]
) -> Iterator[tuple[int, Result | str]]:
    """Each task's key with function(task), as they finish; a sentence where it was lost.

    function itself is not expected to raise. Raises PoolLostError if the pool cannot continue.
    """
    waiting = list(tasks)[::-1]
    under_way: dict[Future[Any], int] = {}
    while waiting or under_way:
        broken = False
        try:
            while waiting and len(under_way) < pool.ahead:
                under_way[pool.submit(function, tasks[waiting[-1]])] = waiting[-1]
                waiting.pop()
        except BrokenExecutor:
            broken = True
        if under_way:
            wait(under_way, return_when=FIRST_COMPLETED)
        broken = broken or any(_broken(future) for future in under_way)
        for future in [one for one in under_way if one.done() and not _broken(one)]:
            yield under_way.pop(future), _outcome(pool, future)
        if broken:
            pool.restart()
            for key in under_way.values():
                yield key, _alone(pool, function, tasks[key])
            under_way.clear()


def _error(future: Future[Any]) -> BaseException | None:
    return CancelledError() if future.cancelled() else future.exception()


def _broken(future: Future[Any]) -> bool:
    return future.done() and isinstance(_error(future), BrokenExecutor)


def _outcome(pool: Pool, future: Future[Any]) -> Any:
    error = _error(future)
    if error is None:
        return future.result()
    if pool.is_lost(error):
        return LOST
    what = str(error) or type(error).__name__
    raise PoolLostError(
        f"The processes that solve the cases were lost ({what}). Expected them to run to the end. "
        "Finished rows are kept: check the scheduler, and repeat the command."
    ) from error


def _alone(pool: Pool, function: Callable[[Task], Result], task: Task) -> Result | str:
    future = pool.submit(function, task)
    wait([future])
    if _broken(future):
        pool.restart()
        return LOST
    return _outcome(pool, future)
