"""How often a recording was sampled; apart from what smooths it, which loads scipy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def time_step(t: Array) -> float:
    """The usual time between samples, s; 1 where there are too few to tell."""
    step = np.diff(t)
    step = step[step > 0]
    return float(np.median(step)) if len(step) else 1.0
