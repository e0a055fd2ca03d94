"""The steps of a run by their numbers: what happens at which."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise


@dataclass(frozen=True)
class Course:
    """Of `count` steps, the robot is let go at `let_go`; the recording begins at `first` and has
    what is at the beginning of every `every`-th step."""

    let_go: int
    first: int
    every: int
    count: int

    @property
    def recorded(self) -> range:
        """Steps at whose beginning there is a sample."""
        return range(self.first, self.count, self.every)

    def parts(self, *, pushed: bool, torque: bool) -> Iterator[tuple[int, int]]:
        """From which step to before which other they are alike, so that they are taken together.

        pushed  whether step `first` is unlike the others
        torque  whether the steps that begin with a sample have to be looked at when they are taken
        """
        marks = {0, self.let_go, self.first, self.count}
        if pushed:
            marks.add(self.first + 1)
        if torque:
            marks |= {n for k in self.recorded for n in (k, k + 1)}
        return pairwise(sorted(mark for mark in marks if mark <= self.count))

    def samples(self, start: int) -> slice:
        """Which steps from `start` on, not before `first`, are recorded."""
        return slice((self.first - start) % self.every, None, self.every)
