"""What is compiled computes what the virtual machine and NumPy compute, and is never needed."""

import os
from dataclasses import replace
from shutil import which

import numpy as np
import pytest

from rr_opt import interrupt
from rr_opt.motion.dynamics import values_of
from rr_opt.motion.floor_motion import floor_motion
from rr_opt.sysid import compiled, paths
from rr_opt.sysid import shooting as shoot
from rr_opt.sysid.compiled import found
from rr_opt.sysid.paths import DrivePath, DriveSlopes, Recorded, Sought
from rr_opt.sysid.sensitivities import grams
from rr_opt.sysid.shooting import predict_all
from tests.robots import BENCHMARK
from tests.sysid.test_slopes import CASES

needs_compiler = pytest.mark.skipif(not which("cc"), reason="there is no C compiler")


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    return tmp_path / "rr-opt"


def both(system, drives, starts, p):
    """Predictions, and J'J by p and by what moves the drive: compiled if that pays."""
    rng = np.random.default_rng(2)
    made = predict_all(
        system, [(drive, start, p) for drive, start in zip(drives, starts, strict=True)]
    )
    asked, still = [], []
    for drive, one in zip(drives, made, strict=True):
        wanted = rng.normal(size=(p.size, 3)) * (np.arange(3) != 1)
        moved = DriveSlopes(
            rng.normal(size=(*drive.at.shape, 2)),
            rng.normal(size=(len(drive.nodes), drive.h.size, 2)),
            np.array([1, 2]),
        )
        values = one.seen + rng.normal(size=one.seen.shape)
        values[rng.uniform(size=values.shape) < 0.2] = np.nan
        recorded = Recorded.of(values, rng.uniform(0.5, 2.0, values.shape))
        more = rng.normal(size=(*values.shape, 1))
        asked.append(Sought(drive, one, p, wanted, moved, recorded, more))
        still.append(replace(asked[-1], drive_by=None, more=None))
    return made, grams(system, asked), grams(system, still)


def shorter(drive, samples):
    steps = (samples - 1) * drive.each
    return DrivePath(drive.h[:steps], drive.nodes[:, :, :steps], drive.at[:, :samples], drive.each)


@needs_compiler
@pytest.mark.parametrize(
    ("worth", "large"),
    [(0, 10**9), (10**9, 0)],
    ids=["in threads", "one after the other, hardly optimised"],
)
@pytest.mark.parametrize("name", CASES)
def test_the_same_numbers(name, worth, large, monkeypatch, own_cache):
    monkeypatch.setattr(compiled, "_WORTH", worth)
    monkeypatch.setattr(compiled, "_LARGE", large)
    system, drive, start, p, _ = CASES[name]
    p = values_of(BENCHMARK, floor_motion().parameters) if p is None else np.array(p)
    # More runs than there are lanes, of different lengths.
    drives = [shorter(drive, samples) for samples in (101, 60, 101, 33, 80, 101, 101, 2, 50, 101)]
    starts = [np.array(start) + 0.01 * k for k in range(len(drives))]
    plain = both(system, drives, starts, p)
    monkeypatch.setattr(shoot, "_FEW", 0)
    monkeypatch.setattr(shoot, "_PAYS", 0)
    fast = both(replace(system, lasts=True), drives, starts, p)
    assert list(own_cache.glob("*.so"))
    for mine, other in zip(fast[0], plain[0], strict=True):
        np.testing.assert_allclose(mine.states, other.states, rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(mine.seen, other.seen, rtol=1e-12, atol=1e-14)
    for fast_grams, plain_grams in zip(fast[1:], plain[1:], strict=True):
        for (a, a_end), (b, b_end) in zip(fast_grams, plain_grams, strict=True):
            size = np.sqrt(np.diag(b))
            np.testing.assert_allclose(a, b, atol=1e-11 * np.outer(size, size).max())
            np.testing.assert_allclose(a_end, b_end, atol=1e-11 * np.abs(b_end).max())


@needs_compiler
@pytest.mark.parametrize("name", CASES)
def test_few_runs_in_pieces(name, monkeypatch):
    system, drive, start, p, _ = CASES[name]
    p = values_of(BENCHMARK, floor_motion().parameters) if p is None else np.array(p)
    drives, starts = [drive, shorter(drive, 34)], [np.array(start)] * 2
    plain = both(system, drives, starts, p)
    monkeypatch.setattr(shoot, "_FEW", 0)
    monkeypatch.setattr(shoot, "_PAYS", 0)
    monkeypatch.setattr(paths, "_SHORTEST", 10)
    fast = both(replace(system, lasts=True), drives, starts, p)
    for fast_grams, plain_grams in zip(fast[1:], plain[1:], strict=True):
        for (a, a_end), (b, b_end) in zip(fast_grams, plain_grams, strict=True):
            size = np.sqrt(np.diag(b))
            np.testing.assert_allclose(a, b, atol=1e-11 * np.outer(size, size).max())
            np.testing.assert_allclose(a_end, b_end, atol=1e-11 * np.abs(b_end).max())


@needs_compiler
def test_steps_of_different_length_side_by_side(monkeypatch):
    system, drive, start, p, _ = CASES["fine"]
    one, p = CASES["smooth"][1], np.array(p)
    drives, starts = [drive, one, drive], [np.array(start)] * 3
    plain = both(system, drives, starts, p)
    monkeypatch.setattr(shoot, "_FEW", 0)
    monkeypatch.setattr(shoot, "_PAYS", 0)
    fast = both(replace(system, lasts=True), drives, starts, p)
    for both_of in zip(fast[1], plain[1], strict=True):
        for a, b in zip(*both_of, strict=True):
            np.testing.assert_allclose(a, b, atol=1e-11 * np.abs(b).max())


@needs_compiler
def test_a_source_is_written_only_to_be_compiled(monkeypatch, own_cache):
    written = []
    write = shoot.source_of
    monkeypatch.setattr(
        shoot, "source_of", lambda *of, **how: written.append(1) or write(*of, **how)
    )
    system = CASES["smooth"][0]
    for stiff, writer, files in ((0, "one", 1), (0, "one", 1), (0, "other", 2), (1, "other", 3)):
        monkeypatch.setattr(shoot, "_writer", lambda writer=writer: writer)
        assert shoot._compiled(replace(system, stiff=stiff), make=True)
        assert len(list(own_cache.glob("*.so"))) == len(written) == files


@needs_compiler
def test_what_does_not_compile_is_done_without(own_cache):
    assert found("this is not C", 1, 1, make=True) is None
    assert not list(own_cache.iterdir())


def test_without_a_compiler(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    assert found("int x;", 1, 1, make=True) is None


@needs_compiler
def test_what_leaves_the_numbers_counts_for_nothing(monkeypatch):
    system, drive, start, p, _ = CASES["fine"]
    (made,) = predict_all(system, [(drive, np.array(start), np.array(p))])
    lost, gap = made.seen.copy(), made.seen.shape[0] // 2
    lost[gap:] = np.nan
    recorded = Recorded.of(made.seen + 0.1, np.ones_like(made.seen))
    first = replace(recorded, weight=np.where(np.isnan(lost), 0.0, recorded.weight))
    states = made.states.copy()
    states[:, gap * drive.each :] = np.nan
    wanted = np.eye(len(p))
    asked = Sought(
        drive, replace(made, states=states, seen=lost), np.array(p), wanted, None, recorded
    )
    whole = Sought(drive, made, np.array(p), wanted, None, first)
    monkeypatch.setattr(paths, "_SHORTEST", 10)
    for few in (10**9, 0):
        monkeypatch.setattr(shoot, "_FEW", few)
        monkeypatch.setattr(shoot, "_PAYS", few)
        ((one, _),), ((other, _),) = (
            grams(replace(system, lasts=not few), [a]) for a in (asked, whole)
        )
        np.testing.assert_allclose(one, other, rtol=1e-9)


@needs_compiler
def test_a_run_whose_drive_stays_beside_one_whose_drive_is_moved(monkeypatch):
    system, drive, start, p, _ = CASES["fine"]
    (made,) = predict_all(system, [(drive, np.array(start), np.array(p))])
    moved = DriveSlopes(
        np.ones((*drive.at.shape, 1)), np.ones((len(drive.nodes), drive.h.size, 1)), np.array([0])
    )
    recorded = Recorded.of(made.seen + 0.1, np.ones_like(made.seen))
    asked = [
        Sought(drive, made, np.array(p), np.ones((len(p), 1)), by, recorded) for by in (moved, None)
    ]
    plain = grams(system, asked)
    monkeypatch.setattr(shoot, "_FEW", 0)
    monkeypatch.setattr(shoot, "_PAYS", 0)
    for fast, slow in zip(grams(replace(system, lasts=True), asked), plain, strict=True):
        for a, b in zip(fast, slow, strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-9)


def twins():
    system = CASES["smooth"][0]
    return replace(system, lasts=True), replace(system, stiff=1, lasts=True)


@needs_compiler
def test_what_will_be_used_as_much_is_compiled_ahead(own_cache):
    used, ahead = twins()
    shoot.code_of(used, shoot._PAYS + 1)
    shoot.prepare([used, ahead], like=used)
    code = shoot._begun[os.getpid(), ahead].result()
    assert (os.getpid(), used) not in shoot._begun
    assert len(list(own_cache.glob("*.so"))) == 2
    # Its first step is stepped by what was compiled.
    assert code is not None
    assert shoot.code_of(ahead, 1) is code


def test_nothing_is_compiled_ahead_for_little_use(own_cache):
    used, ahead = twins()
    shoot.code_of(used, shoot._FEW)
    shoot.prepare([ahead], like=used)
    assert (os.getpid(), ahead) not in shoot._begun
    assert not list(own_cache.glob("*.so"))


def test_what_cannot_be_compiled_ahead_is_done_without(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    used, ahead = twins()
    shoot.code_of(used, shoot._PAYS + 1)
    shoot.prepare([ahead], like=used)
    _, drive, start, p, _ = CASES["smooth"]
    (made,) = predict_all(ahead, [(drive, np.array(start), np.array(p))])
    (plain,) = predict_all(replace(ahead, lasts=False), [(drive, np.array(start), np.array(p))])
    np.testing.assert_array_equal(made.states, plain.states)


@needs_compiler
def test_nothing_is_compiled_ahead_after_an_interrupt(monkeypatch, own_cache):
    used, ahead = twins()
    shoot.code_of(used, shoot._PAYS + 1)
    monkeypatch.setattr(interrupt, "_seen", True)
    shoot.prepare([ahead], like=used)
    assert isinstance(shoot._begun[os.getpid(), ahead].exception(30), KeyboardInterrupt)
    assert len(list(own_cache.glob("*.so"))) == 1
