"""How findings are written for people: names, verdicts, values with their intervals."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.formatting import number, with_unit, words_of
from rr_opt.messages import listed
from rr_opt.model.experiment import Experiment, Run
from rr_opt.model.parameters import PARAMETERS, parameters_of
from rr_opt.sysid.diagnosis import (
    Diagnosis,
    Estimate,
    Finding,
    Misfit,
    Remainder,
    Stage,
    Tie,
    Tried,
    tied,
)
from rr_opt.sysid.settings import SETTINGS

_NAMES = {
    "coulomb_friction": "Coulomb friction",
    "left_right_drag": "drag that differs between left and right",
    "com_offset": "an off-axis centre of mass",
    "axle_misalignment": "an axle misalignment",
    "marker_offset": "an offset of the tracked point",
    "clock_offset": "a clock offset",
    "floor_tilt": "a floor tilt",
    "floor_patch": "a floor patch",
    "lateral_slip": "lateral slip of the wheels",
    "servo_lag": "servo lag",
    "servo_rate_limit": "the servo's rate limit",
    "servo_backlash": "servo backlash",
    "servo_offset": "a servo offset",
    "wheel_inertia": "wheel inertia",
    "dragged_cable": "a dragged cable",
    "stribeck_friction": "Stribeck friction",
}

_COMMON = {
    "m": ("mm", 1e3, 1.0),
    "kg": ("g", 1e3, 1.0),
    "s": ("ms", 1e3, 1.0),
    "N": ("mN", 1e3, 1.0),
    "rad": ("mrad", 1e3, 0.5),
    "N m s": ("µN m s", 1e6, 1e-2),
    "kg m^2": ("kg m²", 1.0, math.inf),
    "dimensionless": ("", 1.0, math.inf),
}
"""SI unit to the customary unit, and the size below which it is used."""


def effect_words(name: str) -> str:
    """An effect in words, as the object of a sentence."""
    return _NAMES.get(name, name.replace("_", " "))


def parameter_words(name: str) -> str:
    """`kappa1` as `viscous wheel friction of platform 1`; others by their names."""
    return PARAMETERS[name].full_words if name in PARAMETERS else words_of(name)


def candidate_words(effects: Sequence[str]) -> str:
    """A set of effects."""
    return " + ".join(map(words_of, effects)) or "none (parameters only)"


def headline(
    found: Diagnosis,
    effect: Callable[[str], str] = effect_words,
    parameter: Callable[[str], str] = parameter_words,
) -> str:
    """The verdict in a sentence; effect, parameter: functions from names to words."""
    names = [one.name for one in found.findings]
    if found.verdict == "consistent":
        return "The model explains the recordings"
    if found.verdict == "parameters":
        values = listed(f"the {parameter(name)}" for name in names) or "a value"
        return f"The model is right, but {values} differ{'s' * (len(names) < 2)} from nominal"
    if found.verdict == "missing_physics":
        return f"The model leaves out {listed(map(effect, names)) or 'something'}"
    if found.suspects:
        several = "are" if len(found.suspects) > 1 else "is"
        names = listed(effect(one.name) for one in found.suspects)
        return f"Physics is missing; {names} {several} suspected"
    return "Physics is missing, but no effect could be named"


def caveat(found: Diagnosis) -> str:
    """What a file with the corrected values has to say about them, if anything."""
    if found.verdict != "unexplained":
        return ""
    return "These values predict best; any effects among them are not established."


def tie_text(tie: Tie, found: Diagnosis) -> str:
    """`Coulomb friction and servo lag from Coulomb friction alone`, or `a wrong m1 from ...`."""
    answer = tied((), tie.answer, found.verdict)
    return f"{answer} from {tied(tie.answer, tie.rival, found.verdict)}"


def value_text(one: Estimate) -> str:
    """`15.2 mN [14.1, 16.3]`, to the digits that its interval supports."""
    low, high, _ = _texts(one, one.low, one.high)
    return f"{number_text(one, one.value)} [{low}, {high}]"


def interval_text(one: Estimate) -> str:
    """`14.1 to 16.3 mN`."""
    low, high, unit = _texts(one, one.low, one.high)
    return f"{low} to {high} {unit}".strip()


def number_text(one: Estimate, value: float) -> str:
    """Another value of the same quantity, in its unit and with its digits."""
    return " ".join(_texts(one, value)).strip()


def _texts(one: Estimate, *values: float) -> list[str]:
    """Values of a quantity in its unit, to two digits of its interval; and the unit."""
    finite = [abs(x) for x in (one.value, one.low, one.high) if math.isfinite(x)]
    size = max(finite, default=0.0)
    unit, factor, below = _COMMON.get(one.unit, (one.unit, 1.0, math.inf))
    if size >= below:
        unit, factor = one.unit, 1.0
    width = (one.high - one.low) * factor
    digits = None
    if math.isfinite(width) and width > 0 and 1e-3 <= size * factor < 1e6:
        digits = min(max(1 - math.floor(math.log10(width / 2)), 0), 6)
    return [*(_fixed(value * factor, digits) for value in values), unit]


def _fixed(value: float, digits: int | None) -> str:
    if not math.isfinite(value):
        return "∞" if value > 0 else "-∞"
    return number(value, 3) if digits is None else f"{value:.{digits}f}"


def total(beyond: float) -> float:
    """The misfit with an excess `beyond` over the noise, both RMS in sigma: 1 is noise alone."""
    return math.hypot(1.0, beyond)


def remainder_text(one: Remainder) -> str:
    """`large: misfit 1.08 σ, 3 % of the initial misfit beyond the noise; a force ...`."""
    if one.size == "none":
        return "none"
    depends = f"; {one.depends_on}" if one.depends_on else ""
    return f"{one.size}: misfit {total(one.rms):.2f} σ, {one.part}{depends}"


def share_text(finding: Finding) -> str:
    """The share of the mismatch that it explains."""
    share = 100 * finding.removes
    return f"{share:.0f} %" if share >= 0.5 else "less than 0.5 %"


def stage_words(stages: Sequence[Stage]) -> list[str]:
    """For each stage `fault` where an unknown input would explain most; `affected` where one
    would explain some of the misfit too; or `clear`."""
    words = []
    for stage in stages:
        seen = stage.p_value < SETTINGS.false_alarm and stage.size > SETTINGS.negligible
        words.append("fault" if stage.guilty else "affected" if seen else "clear")
    return words


def stage_name(stage: Stage) -> str:
    """`rolling`, `axle 1, sideways`."""
    return _STAGES.get(stage.channel, stage.name.replace("_", " "))


_STAGES = {"constraint_axle1": "axle 1, sideways", "constraint_axle2": "axle 2, sideways"}


def stage_text(stage: Stage, found: Diagnosis) -> str:
    """How much an unknown input there would explain, and its p-value: `explains 55 %, p < 1e-12`.

    The share is of the misfit beyond the noise with the robot's values re-fitted, in mean square;
    omitted where that is negligible.
    """
    beyond, p, parts = max(found.mismatch.rms, stage.size), stage.p_value, []
    if beyond > SETTINGS.negligible:
        parts.append(f"explains {100 * (stage.size / beyond) ** 2:.0f} %")
    if p < 1e-12:
        parts.append("p < 1e-12")
    elif math.isfinite(p):
        parts.append(f"p = {p:.2f}" if p >= 0.095 else f"p = {p:.1g}")
    return ", ".join(parts)


_MOST = 30
"""Most rows of candidates; diagnosis.json has all."""


def effects_table(found: Diagnosis) -> doc.Table:
    """The accepted effects and the suspected ones with their values; nothing for a verdict without
    effects."""
    rows: list[list[doc.Cell]] = []
    named = found.findings if found.verdict != "parameters" else ()
    for finding in (*named, *found.suspects):
        name, sure = candidate_words([finding.name]), f"{finding.confidence:.2f}"
        if finding in found.suspects:
            name += ", suspected"
        first = [name, sure, share_text(finding)]
        for name, value in finding.parameters.items():
            rows.append([first[0], name, value_text(value), *first[1:]])
            first = ["", "", ""]
    head = ["Effect", "Parameter", "Value [95 % interval]", "Confidence", "Explains"]
    return doc.table(head, rows)


_CANDIDATES = (
    "Each candidate was fitted to the recordings in use, with the parameters re-estimated. Score: "
    "twice the loss in log predictive density, with each recording predicted from the others; "
    "lower is better. Misfit: RMS simulation residual over the fitted recordings; 1 is noise alone."
)


def candidates_table(found: Diagnosis) -> doc.Table:
    """All sets of effects that were fitted, the best first."""
    tried = found.tried
    return doc.table_of(
        tried[:_MOST],
        {
            "Effects": lambda each: _candidate(each, tried),
            "Score above the best": lambda each: (
                f"+{each.score - tried[0].score:.0f}" if math.isfinite(each.score) else "–"
            ),
            "Misfit": lambda each: f"{total(each.fit):.2f} σ",
            "Verdict": lambda each: doc.Badge("accepted", "good") if each.accepted else "",
        },
        _CANDIDATES if tried else "",
    )


def _candidate(one: Tried, tried: Sequence[Tried]) -> str:
    """The effects; for sets of the same effects in different forms, also their parameters."""
    same = [set(each.values) for each in tried if each.effects == one.effects]
    own = [name.partition(".")[2] for name in one.values if name not in set.intersection(*same)]
    form = f" ({', '.join(own).replace('_', ' ')})" if own else ""
    return candidate_words(one.effects) + form


def parameters_table(found: Diagnosis, experiment: Experiment) -> doc.Table:
    """The robot's own parameters, values of its effects included: nominal, and as estimated."""
    robot = experiment.robot
    own = {f"{use.name}.{name}": v for use in robot.physics for name, v in use.values.items()}
    nominal = parameters_of(robot) | own
    moved = {
        name
        for finding in found.findings
        if found.verdict == "parameters"
        for name in finding.parameters
    }

    def believed(name: str, value: Estimate) -> str | None:
        known = experiment.uncertainty.get(name)
        if name not in nominal:
            return None
        text = number_text(value, nominal[name])
        if known is None:
            return text
        if known.factor is not None:
            return f"{text}, within a factor of {known.factor:g}"
        return f"{text} ± {number_text(value, known.sigma)}"

    columns = {
        "Parameter": lambda each: each[0],
        "What": lambda each: parameter_words(each[0]),
        "Nominal": lambda each: believed(*each),
        "Estimated": lambda each: number_text(each[1], each[1].value),
        "95 % interval": lambda each: interval_text(each[1]),
    }
    if moved:
        changed = doc.Badge("off nominal", "warn")
        columns["Verdict"] = lambda each: changed if each[0] in moved else ""
    # The others are values of effects that the answer adds.
    shown = [one for one in found.parameters.items() if one[0] in nominal or "." not in one[0]]
    return doc.table_of(shown, columns)


def misfit_table(found: Diagnosis) -> doc.Table:
    """Misfit of every recording and channel, before and after."""
    off = found.mismatch
    names = list(dict.fromkeys(name for each in found.final for name in each.channels))

    def change(pair: tuple[Misfit, Misfit], name: str) -> str | None:
        before, after = (level.channels.get(name) for level in pair)
        return None if before is None or after is None else f"{before:.2f} → {after:.2f}"

    note = (
        "With the robot's values re-fitted within their stated uncertainty, the fitted recordings "
        f"have a misfit of {total(off.rms):.2f} σ; noise alone would give that much or more with "
        f"probability {off.p_value:.2g}."
    )
    columns = {
        "Recording": lambda pair: pair[1].recording,
        "Use": lambda pair: doc.Badge("held out", "note") if pair[1].held_out else "fitted",
        "All, σ": lambda pair: f"{pair[0].rms:.2f} → {pair[1].rms:.2f}",
        **{name: lambda pair, name=name: change(pair, name) for name in names},
    }
    return doc.table_of(zip(found.nominal, found.final, strict=True), columns, note)


def recordings_table(experiment: Experiment) -> doc.Table:
    """What was recorded."""

    def good(run: Run) -> str:
        recording = run.recording
        flags = np.array([recording.flags[name] > 0 for name in recording.channels])
        share = 100 * (1 - float(flags.mean()))
        return f"{len(recording)} samples, {number(share, 3)} % good"

    return doc.table_of(
        experiment.runs,
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
