"""The array type of the package."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Floats, in any shape; docstrings give the shape."""

Indices = NDArray[np.int_]
"""Whole numbers, in any shape."""
