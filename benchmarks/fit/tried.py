"""What is noted of a way while it is measured."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass
class Tried:
    """What came of a way.

    warm, far, cold  CPU seconds of fits: warm only of those that reached the minimum
    missed, stopped  how often a warm one did not, and after how many seconds one was given up
    reached          of the far ones;  worst  cost above the least, relative
    """

    warm: list[float] = field(default_factory=list)
    missed: int = 0
    stopped: float = 0.0
    cold: float | None = None
    far: list[float] = field(default_factory=list)
    reached: int = 0
    worst: float = 0.0
