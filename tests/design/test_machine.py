"""An interval's functions are compiled once they are used often, and then give what they gave."""

import shutil

import numpy as np
import pytest

from rr_opt.design import multiple_shooting
from rr_opt.design.multiple_shooting import IntervalTerms
from rr_opt.design.shapes import FourierShape


@pytest.fixture
def terms(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return IntervalTerms((), "inertia", FourierShape(1), 0, 1, ("torque",))


def _given(function):
    rng = np.random.default_rng(0)
    return [rng.uniform(0.5, 1.5, function.size_in(i)) for i in range(function.n_in())]


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_compiled_alike(terms):
    assert terms.compiled.code(multiple_shooting._PAYS) is None
    compiled = terms.compiled.code(1)
    for one, other in zip(terms.functions, compiled, strict=True):
        given = _given(one)
        expected = np.array(one(*given))
        assert np.abs(np.array(other(*given)) - expected).max() <= 1e-12 * np.abs(expected).max()


def test_without_a_compiler(terms, monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler")
    assert terms.compiled.code(multiple_shooting._PAYS + 1) is None
