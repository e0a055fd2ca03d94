"""Every case to an outcome, whatever happens to the processes that compute it.

If a process dies, nothing says which case it died over. So every case that was under way is done
again, each alone in the pool: the one over which a process dies once more is reported as lost.
"""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from typing import Any, Protocol, TypeVar

from rr_opt.outcome import RollerRacerError


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


def pool_of(workers: int | None, scheduler: str | None) -> Pool:
    """`workers` processes on this machine (None: one per core), or those of a dask cluster."""
    # Here and not above: it loads joblib, which only studies and trials need.
    from rr_opt.batch.pools import ClusterPool, LocalPool

    return ClusterPool(scheduler) if scheduler else LocalPool(workers)


Task = TypeVar("Task")
Result = TypeVar("Result")

LOST = (
    "The process that solved this case died each time it was tried. It may have run out of memory, "
    "or a compiled library may have crashed. Solve the case by itself with "
    "`rr-opt maximize-speed` to see why."
)


class PoolLostError(RollerRacerError):
    """The processes are gone, not over one case but for all of them."""


def run(
    pool: Pool, function: Callable[[Task], Result], tasks: Mapping[int, Task]
) -> Iterator[tuple[int, Result | str]]:
    """Each task's key with function(task), as they are finished; a sentence where it was lost.

    function itself is not expected to raise. Raises PoolLostError if the pool cannot go on.
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
        f"The processes that solve the cases were lost ({what}). Expected them to be there to the "
        "end. Finished rows are kept: see to the scheduler, and give the same command again."
    ) from error


def _alone(pool: Pool, function: Callable[[Task], Result], task: Task) -> Result | str:
    future = pool.submit(function, task)
    wait([future])
    if _broken(future):
        pool.restart()
        return LOST
    return _outcome(pool, future)
