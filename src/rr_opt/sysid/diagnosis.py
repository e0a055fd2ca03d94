"""What a diagnosis found, as frozen data; `diagnosis.json` and the page show it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from rr_opt.array import Array
from rr_opt.formatting import words_of
from rr_opt.messages import listed
from rr_opt.sysid.settings import SETTINGS

Verdict = Literal["consistent", "parameters", "missing_physics", "unexplained"]


@dataclass(frozen=True)
class Estimate:
    """A value with its 95 % interval, SI."""

    value: float
    low: float
    high: float
    unit: str


@dataclass(frozen=True)
class Finding:
    """An accepted effect, or a parameter whose nominal value is wrong.

    confidence  0 to 1, against the best explanation without it
    removes     share of the misfit beyond the noise (mean square) that it explains, 0 to 1: alone,
                of the held-out recordings; beside others, what returns on the fitted ones if it is
                dropped. Shares of several effects need not add up to 1
    lookalikes  what moves a machine much as it does and is not ruled out
    """

    name: str
    confidence: float
    parameters: Mapping[str, Estimate]
    removes: float
    lookalikes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Tried:
    """A set of effects that was fitted.

    fit    misfit of its simulation beyond the noise, RMS in sigma
    score  -2 log predictive density, leave-one-recording-out; lower is better
    """

    effects: tuple[str, ...]
    fit: float
    score: float
    values: Mapping[str, float]
    accepted: bool


@dataclass(frozen=True)
class Curve:
    """A residual as a function of one variable: mean and standard error in bins, in sigma."""

    variable: str
    unit: str
    at: Array
    mean: Array
    error: Array


@dataclass(frozen=True)
class Stage:
    """One step from the recording to the motion, tested on its own.

    statistic, p_value  of the null hypothesis: no fault in this stage
    size                how large the fault would be, RMS in sigma beyond the noise
    where               in words: phase, speed, heading, place, recordings
    """

    name: str
    channel: str
    statistic: float
    p_value: float
    size: float
    guilty: bool
    where: str
    curves: tuple[Curve, ...] = ()


@dataclass(frozen=True)
class Mismatch:
    """Whether the model, its values refitted, misfits the recordings it is fitted to at all.

    rms      in sigma, beyond the noise
    p_value  chance that noise alone leaves as much, by chi-square: the residuals of a correct
             model are as white as the noise
    """

    rms: float
    p_value: float


@dataclass(frozen=True)
class Misfit:
    """How far a recording is from a prediction: RMS in sigma by channel; 1 is the noise.

    residuals  (n, channels) in sigma;  predicted, sigma  (n, channels);  t (n,) s
    """

    recording: str
    held_out: bool
    rms: float
    channels: Mapping[str, float]
    t: Array
    predicted: Array
    residuals: Array
    sigma: Array | float = 1.0

    @property
    def recorded(self) -> Array:
        """What was recorded (n, channels)."""
        return self.predicted - self.residuals * self.sigma


@dataclass(frozen=True)
class NextExperiment:
    """The recording that would best discriminate between the remaining explanations.

    separation  RMS difference between the two explanations after refitting, in sigma
    """

    amplitude: float
    period: float
    offset: float
    seconds: float
    start: str
    heading: float
    between: tuple[str, str]
    separation: float
    sentence: str


@dataclass(frozen=True)
class Tie:
    """An explanation that predicts the recordings about as well as the answer does.

    answer  the answer's effects, or a wrong value
    rival   the effects that would do in their place, or the values any one of which would
    """

    answer: tuple[str, ...]
    rival: tuple[str, ...]


def groups(ties: Iterable[Tie]) -> tuple[tuple[str, ...], ...]:
    """For each tie all that it names, once."""
    named = (tuple(dict.fromkeys((*tie.answer, *tie.rival))) for tie in ties)
    return tuple(dict.fromkeys(named))


@dataclass(frozen=True)
class Residue:
    """The residual where no effect fits: a missing force as a function of one variable.

    variable  what it depends on most; at, mean, error as in Curve, force in N
    share     of the remaining misfit that the function removes
    """

    kind: str
    variable: str
    unit: str
    at: Array
    mean: Array
    error: Array
    share: float
    sentence: str


@dataclass(frozen=True)
class Remainder:
    """The misfit that remains with the named effects.

    rms         in sigma beyond the noise, of held-out recordings where there are any
    share       of the initial misfit beyond the noise (mean square), 0 to 1
    depends_on  the channel it enters through and the variable it follows most, in words, if any
    matters     how well the corrected model predicts, in a sentence
    """

    size: Literal["none", "small", "large"]
    rms: float
    share: float
    depends_on: str = ""
    matters: str = ""

    @property
    def part(self) -> str:
        """The share in words."""
        return f"{100 * self.share:.0f} % of the initial misfit beyond the noise"


@dataclass(frozen=True)
class Diagnosis:
    """The answer and what it rests on.

    nominal, refitted, final   misfit of each recording: nominal, with parameters refitted within
                               their uncertainties, with the accepted effects
    before, after              RMS over the held-out recordings in sigma, 1 is the noise
    suspects                   lookalikes of effects, which predict better than these but were
                               tested in few trials
    ties                       what the recordings cannot distinguish from the answer
    values                     of all parameters and effects of the corrected robot, SI
    remainder                  the misfit that remains with the accepted effects
    """

    verdict: Verdict
    summary: str
    mismatch: Mismatch
    channel: str
    where: str
    stages: tuple[Stage, ...]
    findings: tuple[Finding, ...]
    parameters: Mapping[str, Estimate]
    tried: tuple[Tried, ...]
    ties: tuple[Tie, ...]
    next_experiment: NextExperiment | None
    residue: tuple[Residue, ...]
    nominal: tuple[Misfit, ...]
    refitted: tuple[Misfit, ...]
    final: tuple[Misfit, ...]
    before: float
    after: float
    values: Mapping[str, float]
    seconds: Mapping[str, float]
    converged: bool = True
    remainder: Remainder = Remainder("none", 0.0, 0.0)
    suspects: tuple[Finding, ...] = ()

    @property
    def indistinguishable(self) -> tuple[tuple[str, ...], ...]:
        """Of each tie, the answer and its rival together."""
        return groups(self.ties)

    @property
    def advice(self) -> str:
        """What to record next; empty where nothing is open."""
        settled = self.remainder.size == "none" and not self.ties
        if self.next_experiment is None or self.verdict == "consistent" or settled:
            return ""
        return self.next_experiment.sentence


def tied(answer: Sequence[str], rival: Sequence[str], verdict: Verdict) -> str:
    """The rival in words, as `servo lag alone`."""
    if verdict == "parameters":
        return f"a wrong {listed(map(words_of, rival), 'or')}"
    alone = " alone" if set(rival) < set(answer) else ""
    return f"{listed(map(words_of, rival))}{alone}"


def summary_of(found: Diagnosis, worth: str = "", doubt: str = "") -> str:
    """What was found, how sure, what it is worth, what remains, what to record next.

    worth  what it is worth in the machine's own terms: `the place was 8 mm off and is 1 mm off; `
    doubt  why nothing is named although something is missing
    """
    names = listed(words_of(one.name) for one in found.findings)
    wrong = f"values of {names} are" if len(found.findings) > 1 else f"value of {names} is"
    sure = ", ".join(f"{100 * one.confidence:.0f} %" for one in found.findings)
    differs = found.before**2 - 1 > SETTINGS.none**2
    refitted = " once its values are refitted within their uncertainties" if differs else ""
    opening = {
        "consistent": f"The nominal model explains the recordings{refitted}.",
        "parameters": f"The model is right, but the {wrong} not.",
        "missing_physics": f"The model leaves out {names} (confidence {sure}).",
        "unexplained": "Physics is missing; no effect in the catalogue is shown to be the cause.",
    }[found.verdict]
    held = any(one.held_out for one in found.final)
    which = "held-out recordings" if held else "the recordings, all of which were fitted"
    before, after = (f"{one:.2f}" for one in (found.before, found.after))
    moved = "rose" if found.after > found.before else "fell"
    change = f"stayed at {after}" if before == after else f"{moved} from {before} to {after}"
    misfit = f"On {which}, {worth}the misfit {change} sigma, where 1 is noise alone."
    remainder, remains = found.remainder, ""
    if found.verdict != "consistent" and remainder.size != "none":
        depends = f": {remainder.depends_on}" if remainder.depends_on else ""
        remains = f"The remainder is {remainder.size} ({remainder.part}){depends}."
    own = {one.name for one in (*found.findings, *found.suspects)}
    others = dict.fromkeys(
        tied(one.answer, one.rival, found.verdict) for one in found.ties if {*one.rival} != own
    )
    rivals = listed((f"from {one}" for one in others), "or")
    tie = (
        f"These recordings cannot distinguish this {rivals}."
        if rivals and (found.verdict in ("missing_physics", "parameters") or found.suspects)
        else ""
    )
    alike = dict.fromkeys(other for one in found.findings for other in one.lookalikes)
    not_excluded = f"Not ruled out: {listed(alike, 'or')}." if alike else ""
    likely = (f"{words_of(s.name)} (confidence {100 * s.confidence:.0f} %)" for s in found.suspects)
    few = "few blind trials have tested this"
    suspected = f"Suspected ({few}): {listed(likely)}." if found.suspects else ""
    why = doubt if found.verdict == "unexplained" else ""
    every = (opening, suspected, tie, not_excluded, why, misfit, remains, found.advice)
    return " ".join(part for part in every if part)
