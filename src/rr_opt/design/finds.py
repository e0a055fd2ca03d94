"""What a search has found so far."""

from __future__ import annotations

from dataclasses import dataclass, field

from rr_opt.design.setting import Setting
from rr_opt.design.solve import Candidate


@dataclass(frozen=True)
class Finds:
    """Candidates with their settings, in any order; why other starts led nowhere; and, where it
    is known, why no gait can keep all limits."""

    pairs: list[tuple[Setting, Candidate]] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    clash: str = ""

    @property
    def good(self) -> list[tuple[Setting, Candidate]]:
        """Optima, best first."""
        optima = [pair for pair in self.pairs if pair[1].feasible and pair[1].success]
        return sorted(optima, key=lambda pair: pair[1].rank)

    @property
    def fastest(self) -> float:
        """Speed of the best optimum, m/s; 0 if there is none."""
        return max((abs(one.speed) for _, one in self.good), default=0.0)

    def __add__(self, other: Finds) -> Finds:
        return Finds(self.pairs + other.pairs, self.lost + other.lost, self.clash or other.clash)
