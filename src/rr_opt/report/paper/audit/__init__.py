"""The audit in plain words: each section tells what was computed, and what follows."""

from __future__ import annotations

from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit.amplitude import amplitude_section
from rr_opt.report.paper.audit.columns import columns_section
from rr_opt.report.paper.audit.left_out import left_out_section
from rr_opt.report.paper.audit.limits import limits_section, posture_section
from rr_opt.report.paper.audit.period import period_section
from rr_opt.report.paper.audit.readings import readings_section
from rr_opt.report.paper.audit.section import Section
from rr_opt.report.paper.audit.signs import signs_section
from rr_opt.report.paper.audit.turning import turning_section

__all__ = ["Section", "sections"]


def sections(found: Reproduction, mujoco: float | None) -> tuple[Section, ...]:
    """All sections, in the order in which they are read.

    mujoco: the mean speed of the gait of Fig. 3 by a MuJoCo model, m/s, if there is one.
    """
    return (
        signs_section(found, mujoco),
        left_out_section(found),
        columns_section(found),
        readings_section(found),
        limits_section(found),
        posture_section(found),
        period_section(found),
        amplitude_section(found),
        turning_section(found),
    )
