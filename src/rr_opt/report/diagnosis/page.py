"""report.html of a diagnosis: one file that opens anywhere, the verdict and the strip first."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

from rr_opt import __version__
from rr_opt.report.diagnosis.diagnosed import Diagnosed
from rr_opt.report.diagnosis.loss import Loss, NotTold
from rr_opt.report.diagnosis.loss_words import share_lost
from rr_opt.report.diagnosis.recording_tables import misfit_table, recordings_table
from rr_opt.report.diagnosis.strip import STYLE, strip
from rr_opt.report.diagnosis.tables import (
    candidates_table,
    effects_table,
    parameters_table,
)
from rr_opt.report.diagnosis.words import candidate_words, headline, share_text, value_text
from rr_opt.report.html import card, document, figure

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


def page(one: Diagnosed, figures: Mapping[str, str], captions: Mapping[str, str]) -> str:
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


def _header(one: Diagnosed) -> str:
    good = one.found.verdict == "consistent"
    return (
        f'<header class="{"" if good else "bad"}"><p class="kind">Roller Racer · '
        f"{escape(one.name)} · diagnosis</p><h1>{escape(headline(one.found))}</h1>"
        f'<p class="lead">{escape(one.found.summary)}</p></header>'
    )


def _tiles(one: Diagnosed) -> str:
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


def _off(one: Diagnosed) -> str:
    off = one.found.mismatch
    return (
        "With the robot's values re-fitted within what was stated of them, the fitted recordings "
        f"are {off.rms:.2f} σ off beyond the noise; noise alone leaves that much or more with "
        f"probability {off.p_value:.2g}."
    )


def _open(one: Diagnosed) -> str:
    found = one.found
    said = [
        f"These recordings cannot tell {' from '.join(candidate_words([n]) for n in group)}."
        for group in found.indistinguishable
    ]
    said += [each.sentence for each in found.residue]
    if found.next_experiment is not None:
        said.append(found.next_experiment.sentence)
    return "".join(f"<p>{escape(sentence)}</p>" for sentence in said)


def _no_loss(one: Diagnosed) -> str:
    """Why no loss is told, where none is."""
    return f"<p>{escape(one.loss.sentence)}</p>" if isinstance(one.loss, NotTold) else ""


def _with_note(body: str, note: str) -> str:
    return f'{body}<p class="told">{escape(note)}</p>' if body else ""


def _doubts(one: Diagnosed) -> str:
    told = (*one.left_out, *one.doubts)
    items = "".join(f'<li class="bad">{escape(text)}</li>' for text in told)
    return f'<ul class="checks">{items}</ul>' if items else ""


def _footer(one: Diagnosed) -> str:
    steps = ", ".join(f"{step} {time:.1f} s" for step, time in one.found.seconds.items())
    return (
        f"<footer>rr-opt {escape(__version__)} · input SHA-256 <code>{escape(one.sha256)}</code> · "
        f"{escape(steps)} · the corrected robot is in robot-corrected.yaml, all numbers in "
        "diagnosis.json</footer>"
    )
