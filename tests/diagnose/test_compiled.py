"""What is compiled computes what the virtual machine and NumPy compute, and is never needed."""

from dataclasses import replace
from shutil import which

import numpy as np
import pytest

from rr_opt.diagnose import shoot
from rr_opt.diagnose.compiled import found
from rr_opt.diagnose.shoot import DriveSlopes, predict, slopes
from rr_opt.physics.assembly import values_of
from rr_opt.physics.floor_motion import floor_motion
from tests.diagnose.test_slopes import CASES
from tests.robots import BENCHMARK

needs_compiler = pytest.mark.skipif(not which("cc"), reason="there is no C compiler")


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    return tmp_path / "rr-opt"


def both(system, drive, start, p):
    """Prediction and derivatives, by p and by what moves the drive: compiled if that pays."""
    wanted = np.random.default_rng(1).normal(size=(p.size, 3)) * (np.arange(3) != 1)
    rng = np.random.default_rng(2)
    moved = DriveSlopes(
        rng.normal(size=(*drive.at.shape, 3)), rng.normal(size=(*drive.nodes[:, 1].shape, 3))
    )
    made = predict(system, drive, start, p)
    return made, slopes(system, drive, made, p, wanted, moved), slopes(
        system, drive, made, p, wanted, None
    )  # fmt: skip


@needs_compiler
@pytest.mark.parametrize("name", CASES)
def test_the_same_numbers(name, monkeypatch, own_cache):
    system, drive, start, p, _ = CASES[name]
    start = np.array(start)
    p = values_of(BENCHMARK, floor_motion().parameters) if p is None else np.array(p)
    plain, *plain_slopes = both(system, drive, start, p)
    monkeypatch.setattr(shoot, "_FEW", 0)
    monkeypatch.setattr(shoot, "_PAYS", 0)
    fast, *fast_slopes = both(replace(system, lasts=True), drive, start, p)
    assert list(own_cache.glob("*.so"))
    np.testing.assert_allclose(fast.states, plain.states, rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(fast.seen, plain.seen, rtol=1e-12, atol=1e-14)
    for mine, other in zip(fast_slopes, plain_slopes, strict=True):
        for a, b in (
            (mine.by_parameter, other.by_parameter),
            (mine.by_start, other.by_start),
        ):
            np.testing.assert_allclose(a, b, atol=1e-11 * np.abs(b).max())


@needs_compiler
def test_what_does_not_compile_is_done_without(own_cache):
    assert found("this is not C", (1, 1, 1, 1), make=True) is None
    assert not list(own_cache.iterdir())


def test_without_a_compiler(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    assert found("int x;", (1, 1, 1, 1), make=True) is None


@needs_compiler
def test_a_cache_that_cannot_be_written_is_done_without(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert found("int x;", (1, 1, 1, 1), make=True) is None
