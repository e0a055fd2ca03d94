"""The reproduction as a record for scripts, and as text for a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rr_opt import __version__
from rr_opt.paper.printed import CITATION
from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit import Section, sections
from rr_opt.report.paper.audit.section import Value
from rr_opt.report.text import columns


@dataclass(frozen=True)
class Reproduced:
    """What was found, the sections that tell it, the fingerprint of the input, and the speed of the
    typical gait by a MuJoCo model, m/s, if there was one."""

    found: Reproduction
    sections: tuple[Section, ...]
    sha256: str
    mujoco: float | None

    @property
    def lead(self) -> str:
        """What was done, in a sentence or two."""
        rows = (*self.found.tables.table2, *self.found.tables.table3)
        near = sum(one.near_mean for one in rows)
        return (
            "The tables and figures again, by the shipped prototype, and what was found on the "
            f"way. {near} of {len(rows)} measured averages hold the model's speed within their "
            "interval; Table 2's amplitude and the friction were fitted to them."
        )


def reproduced(found: Reproduction, sha256: str, mujoco: float | None = None) -> Reproduced:
    """The reproduction with its sections."""
    return Reproduced(found, sections(found, mujoco), sha256, mujoco)


def record(result: Reproduced) -> dict[str, Any]:
    """The content of reproduce.json: the tables of all sections, in the units of their heads."""
    return {
        "status": "reproduced",
        "message": result.lead,
        "paper": CITATION,
        "mujoco_speed": result.mujoco,
        "sections": {
            one.key: {
                "title": one.title,
                "finding": one.finding,
                "sentences": list(one.sentences),
                "rows": [dict(zip(one.head, map(_finite, row), strict=True)) for row in one.rows],
            }
            for one in result.sections
        },
        "version": __version__,
        "input_sha256": result.sha256,
    }


def _finite(value: Value) -> Value:
    """The value, or None for no bound."""
    return None if isinstance(value, float) and math.isinf(value) else value


def summary(result: Reproduced, files: Sequence[Path]) -> str:
    """The findings as text for a terminal."""
    lines = ["The paper, reproduced and audited.", ""]
    for one in result.sections:
        lines += [one.title, f"  {one.finding}"]
    told = [("files" if not i else "", str(file)) for i, file in enumerate(files)]
    return "\n".join([*lines, "", *columns(told)]) + "\n"
