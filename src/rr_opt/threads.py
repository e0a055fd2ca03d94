"""Parallel work in threads, on all processors that are free."""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from functools import lru_cache
from typing import TypeVar

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

    The process does not end before all of it has.
    """
    begun = _pool(os.getpid(), "background").submit(work)
    _unfinished.add(begun)
    begun.add_done_callback(_unfinished.discard)
    return begun


_unfinished: set[Future] = set()


def finish(seconds: float) -> None:
    """Wait for what was begun in the background, but no longer than this."""
    wait(_unfinished, seconds)


@lru_cache(maxsize=2)
def _pool(process: int, purpose: str) -> ThreadPoolExecutor:
    """Threads of this process: a fork does not inherit its parent's."""
    return ThreadPoolExecutor(_processors(), f"rr-opt-{process}-{purpose}")


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
