"""Independent streams of chance from one seed, so that one draw does not shift another."""

from __future__ import annotations

import zlib

import numpy as np


def stream(seed: int, *purpose: object) -> np.random.Generator:
    """The generator of a seed for a purpose; the same words give the same numbers."""
    words = [zlib.crc32(str(word).encode()) for word in purpose]
    return np.random.default_rng([seed, *words])
