"""An interval's functions as machine code, where a C compiler is at hand and it pays.

CasADi's virtual machine takes some 4 ns an operation, and an interval with its derivatives has some
30 000. Compiled they take a fifth of that, even unoptimised, as here: a compiler that optimises
takes ten seconds over them instead of one, for code that is less than twice as fast.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca

from rr_opt.physics.externals import externals

_FLAGS = ("-O0", "-fPIC", "-shared")
_FEW, _PAYS = 500, 13_000
"""Evaluations of intervals after which it is seen whether the functions were compiled before, and
after which to compile them takes no longer than has been taken without."""


class Functions(NamedTuple):
    """Of an interval: its values, their Jacobian and their weighted Hessian."""

    step: ca.Function
    jacobian: ca.Function
    hessian: ca.Function


class Code:
    """Functions that are compiled once they are used often."""

    def __init__(self, functions: Functions) -> None:
        self.functions, self._asked = functions, 0
        self._compiled: Functions | None = None

    @property
    def compiled(self) -> Functions | None:
        """The compiled functions; None where there are none, or not yet."""
        return self._compiled

    def used(self, evaluations: int) -> None:
        """Count so many more evaluations of the functions."""
        before, self._asked = self._asked, self._asked + evaluations
        if self._compiled is None and any(before < some <= self._asked for some in (_FEW, _PAYS)):
            make = self._asked >= _PAYS
            compiled = externals("interval", self.functions, _FLAGS, make=make)
            self._compiled = Functions(*compiled) if compiled else None
