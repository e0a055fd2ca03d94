"""The strip of stages, from the recording to the floor, with the guilty one lit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from rr_opt.diagnose.diagnosis import Stage
from rr_opt.report.diagnosis.diagnosed import Diagnosed
from rr_opt.report.diagnosis.stage_words import size_text, stage_words

STYLE = """
ol.strip { list-style:none; margin:0; padding:0; display:grid; gap:8px;
  grid-template-columns:repeat(auto-fit,minmax(120px,1fr)); }
ol.strip li { border:1px solid var(--line); border-radius:8px; padding:10px; min-width:0;
  background:var(--ground); overflow-wrap:anywhere; }
ol.strip b, ol.strip span { display:block; }
ol.strip b { font-size:.92rem; }
ol.strip b::first-letter { text-transform:uppercase; }
ol.strip span { color:var(--grey); font-size:.86rem; }
ol.strip .mark { color:var(--good); font-weight:650; }
ol.strip .after .mark, ol.strip .unclear .mark, ol.strip .untested .mark { color:var(--grey); }
ol.strip .guilty { background:var(--bad); border-color:var(--bad); }
ol.strip .guilty b, ol.strip .guilty span { color:#fff; }
.flow { columns:2; column-gap:20px; margin-bottom:20px; }
.flow figure { break-inside:avoid; }
.told { margin:10px 0 0; color:var(--grey); font-size:.9rem; }
@media (max-width:860px) { .flow { columns:1; } ol.strip { grid-template-columns:minmax(0,1fr); }
  ol.strip li { display:grid; grid-template-columns:1fr auto; column-gap:12px; }
  ol.strip span.size { grid-column:1 / -1; } }
"""

_PLACES = (
    ("measurement", ("measurement",)),
    ("actuation", ("actuation",)),
    ("axles", ("constraint_axle1", "constraint_axle2")),
    ("rolling, yaw, mass", ("rolling", "yaw", "mass")),
    ("floor", ("floor",)),
)
"""Where an effect can act, upstream first."""


@dataclass(frozen=True)
class _Box:
    name: str
    kind: str
    mark: str
    size: str


def strip(one: Diagnosed) -> str:
    """The strip as HTML; without tests of the stages it tells where the accepted effect acts."""
    stages = one.found.stages
    boxes = _tested(stages) if stages else _untested(one.found.channel)
    items = "".join(
        f'<li class="{box.kind}"><b>{escape(box.name)}</b>'
        f'<span class="mark">{escape(box.mark)}</span>'
        f'<span class="size">{escape(box.size)}</span></li>'
        for box in boxes
    )
    return f'<ol class="strip">{items}</ol><p class="told">{escape(_told(one))}</p>'


_LOOKS = {
    "fault": ("guilty", "✗ fault"),
    "clear": ("clear", "✓ clear"),
    "not clear": ("unclear", "? not clear"),
    "after the fault": ("after", "after the fault"),
}


def _tested(stages: Sequence[Stage]) -> list[_Box]:
    return [
        _Box(stage.name.replace("_", " "), *_LOOKS[word], size_text(stage))
        for stage, word in zip(stages, stage_words(stages), strict=True)
    ]


def _untested(channel: str) -> list[_Box]:
    boxes = []
    for name, channels in _PLACES:
        here = channel in channels
        mark = "✗ the effect acts here" if here else "–"
        boxes.append(_Box(name, "guilty" if here else "untested", mark, ""))
    return boxes


def _told(one: Diagnosed) -> str:
    if not one.found.stages:
        lit = "" if one.found.channel == "none" else " Lit: where the accepted effect acts."
        return f"The stages were not tested one by one.{lit}"
    where = f"{one.where[0].upper()}{one.where[1:].removesuffix('.')}. " if one.where else ""
    if not one.guilty:
        return f"{where or 'No stage has a fault that counts. '}{_SIGMA}"
    named = one.found.verdict == "missing_physics"
    lit = "the stage in which what was named acts" if named else "the first stage with a fault"
    return f"{where}Lit: {lit}; a fault shows in the stages after it too. {_SIGMA}"


_SIGMA = "σ: one standard deviation of the noise."
