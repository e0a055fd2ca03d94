"""A CasADi function that is compiled once it is used often, where a C compiler is at hand."""

from __future__ import annotations

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.physics.externals import externals

_FLAGS = ("-O1", "-ffp-contract=off", "-fPIC", "-shared")
"""No operation is done otherwise than by CasADi's virtual machine: the numbers are the same."""


class OftenUsed:
    """A function as machine code from its `pays`-th call on; if it was before, from its `few`-th.

    few, pays  calls that take as long as to look for what was compiled before, and as to compile
    """

    def __init__(self, function: ca.Function, few: int, pays: int) -> None:
        self._function, self._left = function, {few: False, pays: True}
        self._calls = 0

    def __call__(self, *args: ArrayLike) -> NDArray[np.float64]:
        """Evaluate it, a function of one output."""
        make = self._left.pop(self._calls, None)
        if make is not None:
            name = self._function.name()
            compiled = externals(name, (self._function,), _FLAGS, make=make)
            if compiled:
                self._function, self._left = compiled[0], {}
        self._calls += 1
        return np.asarray(self._function(*args))
