"""Threads are a process's own: a child that was forked has none of its parent's."""

import multiprocessing
import os

import pytest

from rr_opt import interrupt, threads


def _squared(_: int = 0) -> list[int]:
    return threads.in_threads(lambda k: k * k, range(9))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_forked_child_has_its_own(monkeypatch):
    monkeypatch.setattr(threads, "_processors", lambda: 2)
    assert _squared() == [k * k for k in range(9)]
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply_async(_squared, (0,)).get(timeout=30) == [k * k for k in range(9)]


def test_after_an_interrupt_no_more_is_begun(monkeypatch):
    assert threads.in_background(_squared).result(30) == _squared()
    monkeypatch.setattr(interrupt, "_seen", True)
    late = []
    assert isinstance(
        threads.in_background(lambda: late.append(1)).exception(30), KeyboardInterrupt
    )
    assert not late
