"""The C of a function in stages gives, for each point, what CasADi's virtual machine gives."""

import ctypes
import shutil

import casadi as ca
import numpy as np
import pytest

from rr_opt.mechanics.code_generation import in_stages, source_file
from rr_opt.mechanics.compile_cache import library
from rr_opt.motion.dynamics import derive

pytestmark = pytest.mark.skipif(not shutil.which("cc"), reason="there is no C compiler")
LOOP = """
void run(const double* in, double* out) {
  V x[N0 + N1], kept[NK0 + 1], y[NY];
  int i, l;
  for (i = 0; i < N0 + N1; ++i) for (l = 0; l < L; ++l) x[i][l] = in[i * 8 + l];
  rr_0(x, kept);
  rr_1(x + N0, kept, y);
  for (i = 0; i < NY; ++i) for (l = 0; l < L; ++l) out[i * 8 + l] = y[i][l];
}
int lanes(void) { return L; }
"""


def every_operation():
    first, second = ca.SX.sym("first", 2), ca.SX.sym("second", 2)
    (a, b), (x, y) = ca.vertsplit(first), ca.vertsplit(second)
    outputs = [
        a + b, a * x - y, x / b + y / b, ca.sqrt(ca.fabs(x)), ca.sin(x) + ca.cos(y), ca.tan(a * x),
        ca.tanh(x / a), ca.exp(-x), ca.log(ca.fabs(y) + b), ca.sign(x), ca.fmin(x, y),
        ca.fmax(a, y), ca.atan2(x, y), ca.if_else(x < y, a, b), ca.if_else(x <= a, x, 2.0),
        ca.if_else(ca.logic_or(ca.logic_and(x < y, a < x), b < y), x, b),
        ca.power(ca.fabs(x), 1.5), ca.power(b, x), 1 / x, 2 * x, x**2, -y, a, ca.SX(3.0),
    ]  # fmt: skip
    return ca.Function("every", [second, first], [ca.vertcat(*outputs)])


def motion():
    given = derive(("coulomb_friction", "quadratic_drag")).motion
    *state, p = given.sx_in()
    return ca.Function("m", [ca.vertcat(*state), p], [ca.vertcat(*given(*state, p))])


@pytest.mark.parametrize("flags", [("-O1",), ("-O2", "-march=native")], ids=" ".join)
@pytest.mark.parametrize("function", [every_operation(), motion()], ids=["operations", "motion"])
def test_as_casadi(function, flags, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    stages = in_stages(function, "rr", (1, 0))
    later, first, out = function.numel_in(0), function.numel_in(1), function.numel_out(0)
    sizes = {"NP": first, "N0": first, "N1": later, "NY": out, "NK0": stages.kept[0]}
    head = "".join(f"#define {name} {size}\n" for name, size in sizes.items())
    source = head + source_file("rr_opt.mechanics", "lanes.c") + stages.source + LOOP
    made = library(source, (*flags, "-fPIC", "-shared"), make=True)
    assert made
    x = np.random.default_rng(4).uniform(0.3, 1.5, (first + later, 8))
    y = np.full((out, 8), np.nan)
    made.run.argtypes = [ctypes.c_void_p] * 2
    made.run(x.ctypes.data, y.ctypes.data)
    for lane in range(made.lanes()):
        true = np.asarray(function(x[first:, lane], x[:first, lane])).ravel()
        np.testing.assert_allclose(y[:, lane], true, rtol=1e-12, atol=1e-13)
