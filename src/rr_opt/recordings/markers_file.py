"""What a marker file holds, whatever its format."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MarkerData:
    """Where k markers were seen at n times, in the capture system's frame, third axis up.

    name       of the file
    t          (n,), s, increasing, on the capture's clock; 0 is where the file's own clock has it
    frame      (n,), the frames' numbers as in the file
    labels     (k,), the markers' names, each once
    positions  (n, k, 3), m; NaN where a marker was not seen
    rate       frames per second, Hz, as the file states it; else as the times have it
    residual   (n, k), m, of the capture's own triangulation, NaN where unknown; None: not told
    source     where it came from: file, format, unit, encoding; plain text by name
    doubts     sentences on what looked wrong and what was made of it
    """

    name: str
    t: Array
    frame: NDArray[np.int64]
    labels: tuple[str, ...]
    positions: Array
    rate: float
    residual: Array | None = None
    source: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    doubts: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.t)
