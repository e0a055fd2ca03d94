"""The tables of a diagnosis: effects, candidates, parameters, misfits, recordings."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.formatting import number, with_unit
from rr_opt.model.experiment import Run
from rr_opt.model.parameters import parameters_of
from rr_opt.report.diagnosis import words
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.sysid.diagnosis import Estimate, Misfit, Tried

_MOST = 30
"""Rows of candidates; diagnosis.json has all."""


def effects_table(one: ExplainedExperiment) -> doc.Table:
    """What was accepted, with its values; nothing for a verdict without effects."""
    rows: list[list[doc.Cell]] = []
    for finding in one.found.findings if one.found.verdict != "parameters" else ():
        removes = words.share_text(finding) + (", minor" if finding.minor else "")
        first = [words.candidate_words([finding.name]), f"{finding.confidence:.2f}", removes]
        for name, value in finding.parameters.items():
            rows.append([first[0], name, words.value_text(value), *first[1:]])
            first = ["", "", ""]
    head = ["Effect", "Parameter", "Value [95 % interval]", "Confidence", "Explains"]
    return doc.table(head, rows)


_CANDIDATES = (
    "Each row was fitted to the fitted recordings, with the robot's parameters re-estimated. "
    "Score: twice the loss of log predictive density, each recording predicted from the others; "
    "lower is better. Misfit: RMS residual of simulation in the fitted recordings; 1 is the noise."
)


def candidates_table(one: ExplainedExperiment) -> doc.Table:
    """All sets of effects that were fitted, the best first."""
    tried = sorted(one.found.tried, key=lambda each: each.score)
    return doc.table_of(
        tried[:_MOST],
        {
            "Effects": lambda each: _candidate(each, tried),
            "Score over the best": lambda each: f"+{each.score - tried[0].score:.0f}",
            "Misfit": lambda each: f"{words.total(each.fit):.2f} σ",
            "Verdict": lambda each: doc.Badge("accepted", "good") if each.accepted else "",
        },
        _CANDIDATES if tried else "",
    )


def _candidate(one: Tried, tried: Sequence[Tried]) -> str:
    """The effects; of sets with the same effects in other forms also which parameters they have."""
    same = [set(each.values) for each in tried if each.effects == one.effects]
    own = [name.partition(".")[2] for name in one.values if name not in set.intersection(*same)]
    form = f" ({', '.join(own).replace('_', ' ')})" if own else ""
    return words.candidate_words(one.effects) + form


def parameters_table(one: ExplainedExperiment) -> doc.Table:
    """The robot's own parameters: as believed, and as estimated."""
    nominal = parameters_of(one.experiment.robot)
    moved = {
        name
        for finding in one.found.findings
        if one.found.verdict == "parameters"
        for name in finding.parameters
    }

    def believed(name: str, value: Estimate) -> str | None:
        known = one.experiment.uncertainty.get(name)
        if name not in nominal:
            return None
        text = words.number_text(value, nominal[name])
        if known is None:
            return text
        if known.factor is not None:
            return f"{text}, within a factor of {known.factor:g}"
        return f"{text} ± {words.number_text(value, known.sigma)}"

    columns = {
        "Parameter": lambda each: each[0],
        "What": lambda each: words.parameter_words(each[0]),
        "As believed": lambda each: believed(*each),
        "Estimated": lambda each: words.number_text(each[1], each[1].value),
        "95 % interval": lambda each: words.interval_text(each[1]),
    }
    if moved:
        changed = doc.Badge("not as believed", "warn")
        columns["Verdict"] = lambda each: changed if each[0] in moved else ""
    return doc.table_of([one for one in one.found.parameters.items() if "." not in one[0]], columns)


def misfit_table(one: ExplainedExperiment) -> doc.Table:
    """Misfit of every recording and channel, before and after."""
    found, off = one.found, one.found.mismatch
    names = list(dict.fromkeys(name for each in found.final for name in each.channels))

    def change(pair: tuple[Misfit, Misfit], name: str) -> str | None:
        before, after = (level.channels.get(name) for level in pair)
        return None if before is None or after is None else f"{before:.2f} → {after:.2f}"

    note = (
        "With the robot's values re-fitted within their stated uncertainty, the fitted recordings "
        f"leave a misfit of {words.total(off.rms):.2f} σ; noise alone leaves that much or more "
        f"with probability {off.p_value:.2g}."
    )
    columns = {
        "Recording": lambda pair: pair[1].recording,
        "Use": lambda pair: doc.Badge("held out", "note") if pair[1].held_out else "fitted",
        "All, σ": lambda pair: f"{pair[0].rms:.2f} → {pair[1].rms:.2f}",
        **{name: lambda pair, name=name: change(pair, name) for name in names},
    }
    return doc.table_of(zip(found.nominal, found.final, strict=True), columns, note)


def recordings_table(one: ExplainedExperiment) -> doc.Table:
    """What was recorded."""

    def good(run: Run) -> str:
        recording = run.recording
        flags = np.array([recording.flags[name] > 0 for name in recording.channels])
        share = 100 * (1 - float(flags.mean()))
        return f"{len(recording)} samples, {number(share, 3)} % good"

    return doc.table_of(
        one.experiment.runs,
        {
            "Recording": lambda run: run.name,
            "Use": lambda run: "held out" if run.use == "holdout" else "fitted",
            "Start": lambda run: run.start,
            "Amplitude": lambda run: with_unit(run.gait.amplitude, "rad", 3),
            "Period": lambda run: with_unit(run.gait.period, "s", 3),
            "Offset": lambda run: with_unit(run.gait.offset, "rad", 3),
            "Length": lambda run: f"{run.recording.t[-1] - run.recording.t[0]:.3g} s",
            "Data": good,
        },
    )
