"""report.html of a diagnosis: one file that opens anywhere, the verdict and the strip first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

from rr_opt.answers.diagnosis import DiagnosisAnswer, Loss, LossUnknown
from rr_opt.answers.quantities import number, with_unit
from rr_opt.model.experiment import Run
from rr_opt.model.parameters import Uncertainty, parameters_of
from rr_opt.report.diagnosis.loss import share_lost
from rr_opt.report.diagnosis.words import (
    candidate_words,
    headline,
    interval_text,
    number_text,
    parameter_words,
    share_text,
    size_text,
    stage_words,
    value_text,
)
from rr_opt.report.html import Badge, Cell, card, document, figure, table
from rr_opt.sysid.diagnosis import Estimate, Finding, Misfit, Stage
from rr_opt.version import __version__

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


def strip(one: DiagnosisAnswer) -> str:
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


def _told(one: DiagnosisAnswer) -> str:
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


_MOST = 30
"""Rows of candidates; diagnosis.json has all."""


def effects_table(one: DiagnosisAnswer) -> str:
    """What was accepted, with its values; nothing for a verdict without effects."""
    if one.found.verdict == "parameters" or not one.found.findings:
        return ""
    rows: list[list[Cell]] = []
    for finding in one.found.findings:
        for k, (name, value) in enumerate(finding.parameters.items()):
            first: list[Cell] = _effect_cells(finding) if k == 0 else ["", "", ""]
            rows.append([first[0], name, value_text(value), *first[1:]])
    head = ["Effect", "Parameter", "Value [95 % interval]", "Confidence", "Removes"]
    return table(head, rows)


def _effect_cells(finding: Finding) -> list[Cell]:
    removes = share_text(finding) + (", minor" if finding.minor else "")
    return [finding.name.replace("_", " "), f"{finding.confidence:.2f}", removes]


def candidates_table(one: DiagnosisAnswer) -> str:
    """All sets of effects that were fitted, the best first."""
    tried = sorted(one.found.tried, key=lambda each: each.score)
    if not tried:
        return ""
    rows: list[list[Cell]] = [
        [
            candidate_words(each.effects),
            f"+{each.score - tried[0].score:.0f}",
            f"{each.fit:.2f} σ",
            "–" if np.isnan(each.left_out) else f"{each.left_out:.2f} σ",
            Badge("accepted", "yes") if each.accepted else "",
        ]
        for each in tried[:_MOST]
    ]
    head = ["Effects", "Score over the best", "Misfit", "Misfit, left out", "Verdict"]
    return table(head, rows)


def parameters_table(one: DiagnosisAnswer) -> str:
    """The robot's own parameters: as believed, and as estimated."""
    nominal = parameters_of(one.experiment.robot)
    moved = {
        name
        for finding in one.found.findings
        if one.found.verdict == "parameters"
        for name in finding.parameters
    }
    head = ["Parameter", "What", "As believed", "Estimated", "95 % interval"]
    head += ["Verdict"] if moved else []
    rows: list[list[Cell]] = []
    for name, value in one.found.parameters.items():
        if "." in name:
            continue
        believed = nominal.get(name)
        verdict: list[Cell] = [Badge("not as believed", "assumed") if name in moved else ""]
        rows.append(
            [
                name,
                parameter_words(name),
                "–" if believed is None else _believed(value, believed, _known(one, name)),
                number_text(value, value.value),
                interval_text(value),
                *(verdict if moved else []),
            ]
        )
    return table(head, rows) if rows else ""


def _believed(value: Estimate, believed: float, known: Uncertainty | None) -> str:
    text = number_text(value, believed)
    if known is None:
        return text
    if known.factor is not None:
        return f"{text}, within a factor of {known.factor:g}"
    return f"{text} ± {number_text(value, known.sigma)}"


def _known(one: DiagnosisAnswer, name: str) -> Uncertainty | None:
    return one.experiment.uncertainty.get(name)


def misfit_table(one: DiagnosisAnswer) -> str:
    """Misfit of every recording and channel, before and after."""
    rows: list[list[Cell]] = []
    for before, after in zip(one.found.nominal, one.found.final, strict=True):
        use = Badge("held out", "fitted") if after.held_out else "fitted"
        rows.append(
            [
                after.recording,
                use,
                f"{before.rms:.2f} → {after.rms:.2f}",
                *(_channel(before, after, name) for name in _channels(one)),
            ]
        )
    return table(["Recording", "Use", "All, σ", *_channels(one)], rows)


def _channels(one: DiagnosisAnswer) -> list[str]:
    return list(dict.fromkeys(name for each in one.found.final for name in each.channels))


def _channel(before: Misfit, after: Misfit, name: str) -> str:
    if name not in before.channels or name not in after.channels:
        return "–"
    return f"{before.channels[name]:.2f} → {after.channels[name]:.2f}"


def recordings_table(one: DiagnosisAnswer) -> str:
    """What was recorded."""
    rows: list[list[Cell]] = [_recorded(run) for run in one.experiment.runs]
    head = ["Recording", "Use", "Start", "Amplitude", "Period", "Offset", "Length", "Data"]
    return table(head, rows)


def _recorded(run: Run) -> list[Cell]:
    recording, gait = run.recording, run.gait
    flags = np.array([recording.flags[name] > 0 for name in recording.channels])
    share = 100 * (1 - float(flags.mean()))
    return [
        run.name,
        run.use,
        run.start,
        with_unit(gait.amplitude, "rad", 3),
        with_unit(gait.period, "s", 3),
        with_unit(gait.offset, "rad", 3),
        f"{recording.t[-1] - recording.t[0]:.3g} s",
        f"{len(recording)} samples, {number(share, 3)} % good",
    ]


_TITLES = {
    "evidence": "What the fault depends on",
    "residue": "The force that has no name",
    "paths": "Before and after: paths",
    "misfit": "Before and after: misfit of each recording",
    "bands": "Before and after: what the simulation leaves",
    "loss": "What the wrong model would cost",
}

_CANDIDATES = (
    "Each row was fitted to the fitted recordings, with the robot's parameters re-estimated. "
    "Score: chi-square of data and knowledge and a price for each quantity; less is better. "
    "Misfit: beyond the noise; left out: of each recording predicted from the others."
)


def page(one: DiagnosisAnswer, figures: Mapping[str, str], captions: Mapping[str, str]) -> str:
    """The whole page; figures are SVG texts by name, captions under them."""
    drawn = "".join(
        figure(figures[name], title, captions[name])
        for name, title in _TITLES.items()
        if name in figures
    )
    body = [
        _header(one),
        card("Where it goes wrong", strip(one)),
        _tiles(one),
        f'<div class="flow">{drawn}</div>' if drawn else "",
        card("What was found", effects_table(one)),
        card("What the wrong model would cost", _no_loss(one)),
        card("What cannot be told, and what to record next", _open(one)),
        card("What was tried", _with_note(candidates_table(one), _CANDIDATES)),
        card("The robot's parameters", parameters_table(one)),
        card("Misfit by channel, before → after, σ", _with_note(misfit_table(one), _off(one))),
        card("Recordings", recordings_table(one) + _doubts(one)),
        _footer(one),
    ]
    return document(f"{one.name}: {headline(one.found)}", body, STYLE)


def _header(one: DiagnosisAnswer) -> str:
    good = one.found.verdict == "consistent"
    return (
        f'<header class="{"" if good else "bad"}"><p class="kind">Roller Racer · '
        f"{escape(one.name)} · diagnosis</p><h1>{escape(headline(one.found))}</h1>"
        f'<p class="lead">{escape(one.found.summary)}</p></header>'
    )


def _tiles(one: DiagnosisAnswer) -> str:
    found = one.found
    tiles = [
        (f"{found.before:.2f} σ", f"off before, {one.proven_on}"),
        (f"{found.after:.2f} σ", "off now; 1 is the noise"),
    ]
    for finding in found.findings[:3]:
        if found.verdict == "missing_physics":
            words = f"of the mismatch goes with {candidate_words([finding.name])}"
            tiles.append((share_text(finding), words))
        tiles += [
            (value.split(" [")[0], f"{name}, 95 %: {value.split(' [')[1].rstrip(']')}")
            for name, value in (
                (name, value_text(each)) for name, each in list(finding.parameters.items())[:2]
            )
        ]
    if isinstance(one.loss, Loss):
        tiles.append((share_lost(one.loss), "of the speed lost by the best gait as believed"))
    inner = "".join(
        f'<div class="tile"><b>{escape(value)}</b><span>{escape(words)}</span></div>'
        for value, words in tiles
    )
    return f'<div class="tiles">{inner}</div>'


def _off(one: DiagnosisAnswer) -> str:
    off = one.found.mismatch
    return (
        "With the robot's values re-fitted within what was stated of them, the fitted recordings "
        f"are {off.rms:.2f} σ off beyond the noise; noise alone leaves that much or more with "
        f"probability {off.p_value:.2g}."
    )


def _open(one: DiagnosisAnswer) -> str:
    found = one.found
    said = [
        f"These recordings cannot tell {' from '.join(candidate_words([n]) for n in group)}."
        for group in found.indistinguishable
    ]
    said += [each.sentence for each in found.residue]
    if found.next_experiment is not None:
        said.append(found.next_experiment.sentence)
    return "".join(f"<p>{escape(sentence)}</p>" for sentence in said)


def _no_loss(one: DiagnosisAnswer) -> str:
    """Why no loss is told, where none is."""
    return f"<p>{escape(one.loss.sentence)}</p>" if isinstance(one.loss, LossUnknown) else ""


def _with_note(body: str, note: str) -> str:
    return f'{body}<p class="told">{escape(note)}</p>' if body else ""


def _doubts(one: DiagnosisAnswer) -> str:
    told = (*one.left_out, *one.doubts)
    items = "".join(f'<li class="bad">{escape(text)}</li>' for text in told)
    return f'<ul class="checks">{items}</ul>' if items else ""


def _footer(one: DiagnosisAnswer) -> str:
    steps = ", ".join(f"{step} {time:.1f} s" for step, time in one.found.seconds.items())
    return (
        f"<footer>rr-opt {escape(__version__)} · input SHA-256 <code>{escape(one.sha256)}</code> · "
        f"{escape(steps)} · the corrected robot is in robot-corrected.yaml, all numbers in "
        "diagnosis.json</footer>"
    )
