"""An interval's functions are compiled once they are used often, and then give what they gave."""

import shutil

import numpy as np
import pytest

from rr_opt.design import interval as machine
from rr_opt.design.interval import IntervalTerms
from rr_opt.design.shapes.fourier import FourierShape
from rr_opt.mechanics.runge_kutta import BUTCHER6


@pytest.fixture
def code(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return IntervalTerms((), "inertia", FourierShape(1), 0, 1, BUTCHER6, ("torque",)).code


def _given(function):
    rng = np.random.default_rng(0)
    return [rng.uniform(0.5, 1.5, function.size_in(i)) for i in range(function.n_in())]


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_compiled_alike(code):
    code.used(machine._PAYS - 1)
    assert code.compiled is None
    code.used(1)
    for one, other in zip(code.functions, code.compiled, strict=True):
        given = _given(one)
        expected = np.array(one(*given))
        assert np.abs(np.array(other(*given)) - expected).max() <= 1e-12 * np.abs(expected).max()


def test_without_a_compiler(code, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    code.used(machine._PAYS)
    assert code.compiled is None
