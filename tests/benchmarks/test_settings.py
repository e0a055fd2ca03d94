"""The numbers that were chosen, halved and doubled: what is computed again, and what is not."""

from contextlib import closing
from functools import partial

import numpy as np
import pytest

from benchmarks.settings.variants import Memory, Watched, changed, every_variant, variants, varied
from rr_opt.batch.run import pool_of, run
from rr_opt.sysid.settings import SETTINGS
from tests.cli.test_diagnose import columns, write


@pytest.fixture
def watched():
    before = SETTINGS.__class__
    object.__setattr__(SETTINGS, "__class__", Watched)
    yield
    object.__setattr__(SETTINGS, "__class__", before)


def test_settings_are_noted_where_they_are_read(watched):
    memory, calls = Memory(), []

    @memory.remembering
    def inner(numbers):
        calls.append(numbers)
        return SETTINGS.named * numbers.sum()

    _ = SETTINGS.evidence
    assert inner(np.ones(3)) == inner(np.ones(3))
    assert inner(np.ones(2)) != inner(np.ones(3))
    assert len(calls) == 2
    assert memory.read == {"named"}


def test_the_same_objects_are_the_same_arguments():
    memory, calls = Memory(), []

    @memory.remembering
    def count(given, many=1):
        calls.append(given)
        return len(calls)

    one, other = object(), object()
    assert [count(one), count(one), count(other), count(one, many=2)] == [1, 1, 2, 3]


def test_changes_end():
    before = SETTINGS.named
    with changed({"named": 0.9}):
        assert SETTINGS.named == 0.9
    assert before == SETTINGS.named


def test_variants():
    assert varied(4, 0.5) == 2
    assert varied(1, 0.5) == 1
    assert varied(0.5, 2.0) == pytest.approx(2 / 3)
    assert varied(0.2, 2.0) == 0.4
    assert varied((0.3, 30.0), 2.0) == (0.6, 60.0)
    assert list(variants(["further"])) == ["as chosen", "further halved", "further doubled"]
    assert "growth halved" not in variants([])


def test_changes_count_in_another_process(tmp_path):
    folder = write(tmp_path, [columns(k, 6) for k in range(3)], ("fit", "holdout", "fit"))
    wanted = {"as chosen": {}, "certain": {"inconstant": 1.01}}
    with closing(pool_of(1, None)) as pool:
        ((_, said),) = run(pool, partial(every_variant, wanted=wanted), {1: folder})
    assert [one["verdict"] for one in said.values()] == ["consistent", "unexplained"]
