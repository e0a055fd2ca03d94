"""Parallel work in threads, on all processors that are free."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import lru_cache
from typing import TypeVar

from rr_opt import interrupt

Part = TypeVar("Part")
Done = TypeVar("Done")


def in_threads(work: Callable[[Part], Done], parts: Sequence[Part]) -> list[Done]:
    """work(part) of each, in order. It has to release the GIL, as ctypes calls do, and must not
    call this itself."""
    if min(_processors(), len(parts)) < 2:
        return [work(part) for part in parts]
    return list(_pool(os.getpid(), "at-once").map(work, parts))


def in_background(work: Callable[[], Done]) -> Future[Done]:
    """work(), begun in a thread of its own as soon as a processor is free of such work.

    The process does not end before all of it has; after an interrupt no more is begun.
    """

    def unless_interrupted() -> Done:
        interrupt.check()
        return work()

    return _pool(os.getpid(), "background").submit(unless_interrupted)


@lru_cache(maxsize=2)
def _pool(process: int, purpose: str) -> ThreadPoolExecutor:
    """Threads of this process: a fork does not inherit its parent's."""
    return ThreadPoolExecutor(_processors(), f"rr-opt-{process}-{purpose}")


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
