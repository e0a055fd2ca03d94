"""The landscape as machine code tells of every gait what it tells in NumPy, the unsettled too."""

import shutil
from dataclasses import fields

import numpy as np
import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design import landscape as landscape_code
from rr_opt.design.decisions import decisions, settings_of
from rr_opt.design.landscape import Cycles

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")


@pytest.mark.parametrize("name", ["reference", "paper_loads", "no_rate_limit_backward"])
def test_landscape_code(name, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(landscape_code, "_PAYS", 1)
    problem = PROBLEMS[name]
    box = decisions(problem)
    landscape = settings_of(problem, box)[0].landscape
    gaits = box.physical(np.random.default_rng(1).random((333, 4)))
    gaits[0, :3] *= 4  # past the singular posture
    code = landscape_code._code.__wrapped__(landscape._effects)
    landscape._code = None
    by_numpy = landscape.cycles(gaits, 24)
    assert code.code(gaits.shape[1])
    landscape._code = code
    compiled = landscape.cycles(gaits, 24)
    for field in fields(Cycles):
        one, other = (getattr(cycles, field.name) for cycles in (by_numpy, compiled))
        known = np.isfinite(by_numpy.speed) & (np.abs(by_numpy.v).max(axis=0) < 10)
        assert known.sum() > 300
        scale = np.abs(one[..., known]).max()
        assert np.abs(one - other)[..., known].max() <= 1e-9 * (1 + scale)
    assert np.array_equal(np.isfinite(by_numpy.speed), np.isfinite(compiled.speed))
