"""What the counts of a servo mean."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class CountScale:
    """Counts to phi; by default those of the servo CDS5516.

    counts  how many there are over `range`, rad; a negative range: phi falls as they rise
    zero    the count at which phi = 0
    """

    counts: int = 1024
    range: float = math.radians(300)
    zero: float = 512.0

    @property
    def each(self) -> float:
        """By how much phi rises with a count, rad."""
        return self.range / self.counts
