"""Jumps, repeats, disorder and unevenness of the times are found, told and never hidden."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from rr_opt.model.experiment import Flag
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.time_axis import in_order


def csv(times, mark=lambda n: n):
    rows = "".join(f"{t:.4f},{mark(n)},0,0,0\n" for n, t in enumerate(times))
    return "t,x,y,psi,phi\n" + rows


def test_a_steady_rate_has_no_doubts(write):
    for rate in (8.0, 100.0, 120.0, 250.0, 600.0):
        run = read_file(write(csv(np.round(np.arange(3000) / rate, 3))))
        assert run.doubts == ()
        assert float(run.source["rate"].split()[0]) == pytest.approx(rate, rel=1e-4)


def test_a_jump_with_its_place_and_the_rows_that_it_lacks(write):
    times = np.arange(100) / 100
    run = read_file(write(csv(np.delete(times, slice(40, 50)))))
    (doubt,) = run.doubts
    assert "jumps once (0.11 s at t = 0.39 s): at 100 Hz about 10 rows are missing" in doubt


def test_rows_out_of_order_are_sorted_and_flagged(write):
    times = [0.0, 0.01, 0.04, 0.02, 0.03, 0.05]
    run = read_file(write(csv(times)))
    assert run.t.tolist() == sorted(times)
    assert run.values["x"].tolist() == [0, 1, 3, 4, 2, 5]
    assert run.flags["x"].tolist() == [0, 0, 0, 0, Flag.OUT_OF_ORDER, 0]
    assert run.doubts == ("Out of order, now sorted by time: line 4.",)


def test_a_clock_that_jumps_once_does_not_spoil_what_follows(write):
    times = np.arange(50) / 100
    times[20] = 99.0
    run = read_file(write(csv(times)))
    assert run.t[-1] == 99.0
    assert np.flatnonzero(run.flags["x"]).tolist() == [49]


def test_a_row_that_is_there_twice_is_left_out(write):
    text = csv(np.arange(5) / 100)
    line = text.splitlines()[3]
    run = read_file(write(text.replace(line, f"{line}\n{line}")))
    assert run.values["x"].tolist() == [0, 1, 2, 3, 4]
    assert not run.flags["x"].any()
    assert run.doubts == ("Dropped, same time as another row: line 5.",)


def test_two_rows_of_one_time_that_disagree_are_no_data(write):
    run = read_file(write(csv([0.0, 0.01, 0.02, 0.02, 0.03])))
    assert run.t.tolist() == [0.0, 0.01, 0.02, 0.03]
    assert run.flags["x"].tolist() == [0, 0, Flag.OUT_OF_ORDER, 0]
    assert any("different values" in doubt for doubt in run.doubts)


def test_a_row_without_a_time_is_left_out_and_told(write):
    run = read_file(write(csv(np.arange(5) / 100).replace("0.0200", "")))
    assert run.values["x"].tolist() == [0, 1, 3, 4]
    assert "Dropped, no time: line 4." in run.doubts


def test_an_uneven_rate_is_told(write):
    times = np.cumsum(np.random.default_rng(5).uniform(0.0075, 0.0125, 200))
    assert any("interval is not constant" in doubt for doubt in read_file(write(csv(times))).doubts)


@pytest.mark.parametrize("apart", [0.0, 1e-320, 1e-10])
def test_times_that_no_clock_tells_apart_are_one(apart):
    times = np.array([0.0, apart, 0.01, 0.02, 0.02 + apart])
    order = in_order(times, np.zeros((5, 1)), range(2, 7))
    assert order.rows.tolist() == [0, 2, 3]
    assert [one.code for one in order.doubts] == ["time.twice"]


@pytest.mark.parametrize("times", list(itertools.permutations(range(5))))
def test_the_fewest_rows_are_called_out_of_order(times):
    """Against every way to leave rows out."""
    order = in_order(np.array(times, float), np.zeros((5, 1)), range(2, 7))
    assert order.rows.tolist() == [times.index(n) for n in range(5)]
    fewest = min(
        5 - size
        for size in range(6)
        for kept in itertools.combinations(times, size)
        if list(kept) == sorted(kept)
    )
    assert order.moved.sum() == fewest


def test_times_that_jitter_keep_their_rate_and_lack_no_row(write):
    t = np.arange(2000) / 100 + np.random.default_rng(0).uniform(-0.003, 0.003, 2000)
    run = read_file(write(csv(np.sort(t))))
    assert float(run.source["rate"].split()[0]) == pytest.approx(100, rel=1e-3)
    assert any("interval is not constant" in doubt for doubt in run.doubts)
    assert not any("missing" in doubt for doubt in run.doubts)


def test_two_recordings_in_one_file_are_told(write):
    run = read_file(write(csv(np.concatenate([np.arange(500), np.arange(400) + 0.5]) / 100)))
    told = next(doubt for doubt in run.doubts if "two recordings in one file" in doubt)
    assert "from 4.99 to 0.005 s in line 502" in told
