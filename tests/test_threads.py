"""Threads are a process's own: a child that was forked has none of its parent's."""

import multiprocessing
import os
import threading

import pytest

from rr_opt import threads


def _squared(_: int = 0) -> list[int]:
    return threads.in_threads(lambda k: k * k, range(9))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_child_has_its_own(monkeypatch):
    monkeypatch.setattr(threads, "_processors", lambda: 2)
    assert _squared() == [k * k for k in range(9)]
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(_squared, (0,)).get(timeout=30) == [k * k for k in range(9)]


def test_what_was_begun_is_waited_for_but_not_for_ever():
    go = threading.Event()
    begun = threads.in_background(lambda: go.wait(60) and _squared())
    threads.finish(0.01)
    assert not begun.done()
    go.set()
    threads.finish(60)
    assert begun.result(0) == _squared()
