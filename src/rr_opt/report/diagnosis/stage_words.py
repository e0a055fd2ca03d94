"""How a stage's test is told."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rr_opt.diagnose.diagnosis import Stage
from rr_opt.diagnose.stages.blame import FALSE_ALARM, FLOOR


def stage_words(stages: Sequence[Stage]) -> list[str]:
    """Of each stage `fault`, `clear`, `not clear` or, downstream of a fault, `after the fault`.

    Not clear is a stage that is not lit and sees something all the same.
    """
    first = next((k for k, stage in enumerate(stages) if stage.guilty), len(stages))
    return [
        "fault" if stage.guilty else "after the fault" if k > first else _unlit(stage)
        for k, stage in enumerate(stages)
    ]


def _unlit(stage: Stage) -> str:
    seen = stage.p_value < FALSE_ALARM and stage.size > FLOOR
    return "not clear" if seen else "clear"


def size_text(stage: Stage) -> str:
    """How large a stage's fault would be, and the chance of it: `3.10 σ, p < 1e-12`."""
    p = stage.p_value
    if not math.isfinite(p):
        return f"{stage.size:.2f} σ"
    if p < 1e-12:
        return f"{stage.size:.2f} σ, p < 1e-12"
    return f"{stage.size:.2f} σ, p = {p:.2f}" if p >= 0.095 else f"{stage.size:.2f} σ, p = {p:.1g}"
