"""A pendulum driven by a torque, as a second model that can be diagnosed.

    J th'' = tau - b th' - m l g sin th

with viscous friction only; `pendulum_effects` lists what may be missing. It shares nothing with the
Roller Racer but the protocol, and shows what of the diagnosis belongs to no machine in particular.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.machines.pendulum.effects import EXTRAS, Extra
from rr_opt.model.experiment import Uncertainty
from rr_opt.sysid.least_squares import Fit
from rr_opt.sysid.model import Asked, Candidate, Data, Form, Piece, Proposal, Quantity, Response
from rr_opt.sysid.sensitivities import DriveSlopes, Recorded, gram_of, slopes
from rr_opt.sysid.shooting import DrivePath, System, predict

G = 9.81
"""m/s2."""

_EACH = 8
"""Steps between two samples."""

_UNITS = {"J": "kg m^2", "ml": "kg m", "b": "N m s"}


@dataclass(frozen=True)
class Swing:
    """A recording: t (n,) s; angle (n,) rad from hanging down, NaN where there is none.

    torque  of the motor (n,), N m, taken as straight between the samples
    sigma   of the angle, rad
    """

    name: str
    t: Array
    angle: Array
    torque: Array
    sigma: float
    held_out: bool = False


class Pendulum:
    """Recordings of a pendulum and its nominal J, ml, b; answers `diagnose.model.Model`."""

    channels = ("angle",)
    inexact = 0.0
    rough: frozenset[str] = frozenset()
    vague: Mapping[str, float] = MappingProxyType({})
    placed: frozenset[str] = frozenset()
    jumping = dear = frozenset(name for name, extra in EXTRAS.items() if not extra.smooth)

    def __init__(
        self,
        swings: Sequence[Swing],
        nominal: Mapping[str, float],
        uncertainty: Mapping[str, Uncertainty],
    ) -> None:
        """nominal: J (kg m2), ml (kg m), b (N m s). What `uncertainty` does not name is exact."""
        self.swings = tuple(swings)
        self.nominal = {name: nominal[name] for name in _UNITS}
        self.runs: Sequence[Data] = [_data(swing) for swing in self.swings]
        self.parameters: tuple[Quantity, ...] = tuple(
            _parameter(name, self.nominal[name], uncertainty[name])
            for name in _UNITS
            if name in uncertainty
        )
        # A period of small swings: in one, the way round has not yet parted from the way back.
        self.window = 2 * math.pi * math.sqrt(self.nominal["J"] / (self.nominal["ml"] * G))
        torque = float(np.sqrt(np.mean(np.concatenate([s.torque for s in self.swings]) ** 2)))
        speeds = [float(np.nanmax(np.abs(_mean_speeds(s)))) for s in self.swings]
        self.catalogue: Mapping[str, Candidate] = {
            name: _candidate(extra, torque, max(*speeds, 1e-3)) for name, extra in EXTRAS.items()
        }

    def propose(self, name: str, form: int, fit: Fit) -> Sequence[Proposal]:
        """Where the effect's form says; a fit of a pendulum is cheap, so each is worth it."""
        forms = self.catalogue[name].forms
        return [Proposal(start, fit.cost, 1.0) for start in forms[form].starts]

    def twin(self, values: Mapping[str, float]) -> None:
        """None: no two sets of values of a pendulum are alike."""

    def nameless(self, whole: Fit, windows: Fit) -> None:
        """None: it has no term without a name."""

    def start(self, piece: Piece) -> Array:
        """Angle and speed (rad, rad/s) by a straight line through the first tenth of a second."""
        data = self.runs[piece.run]
        t, angle = data.t[piece.span], data.values[piece.span, 0]
        early = (t - t[0] <= 0.1) & np.isfinite(angle)
        slope, at = np.polyfit(t[early] - t[0], angle[early], 1)
        return np.array([at, slope])

    @property
    def start_within(self) -> Array:
        """Nothing is known."""
        return np.full(2, np.inf)

    def respond(
        self,
        piece: Piece,
        values: Mapping[str, float],
        effects: tuple[str, ...],
        start: Array,
        wanted: tuple[str, ...] | None = None,
    ) -> Response:
        """Predict a piece of a run; see `diagnose.model.Model`."""
        extras = tuple(extra for name, extra in EXTRAS.items() if name in effects)
        system, names = _system(extras)
        given = self.nominal | dict(values)
        p = np.array([given[name] for name in names])
        swing, t = self.swings[piece.run], self.runs[piece.run].t[piece.span]
        late = sum(given[extra.quantity] for extra in extras if extra.delays)
        path = _path(swing, t, late)
        made = predict(system, path, start, p)
        if wanted is None:
            return Response(made.seen)
        by = np.array([[float(own == name) for name in wanted] for own in names])
        delays = [wanted.index(e.quantity) for e in extras if e.delays and e.quantity in wanted]
        by_delay = _path_by_delay(swing, t, path, late, delays, len(wanted)) if delays else None
        out = slopes(system, path, made, p, by, by_delay)
        return Response(made.seen, out.by_parameter, out.by_start)

    def off(self, asked: Sequence[Asked], effects: tuple[str, ...]) -> Sequence[Array]:
        """(predicted - recorded)/sigma; see `diagnose.model.Model`."""
        return [
            self._recorded(one.piece).off(
                self.respond(one.piece, one.values, effects, one.start).predicted
            )
            for one in asked
        ]

    def grams(
        self,
        asked: Sequence[Asked],
        effects: tuple[str, ...],
        wanted: tuple[str, ...],
        *,
        stray: bool = False,
    ) -> Sequence[Array]:
        """J'J of each piece. What a pendulum's model leaves out is not known beforehand: that
        column is 0."""
        out = []
        for one in asked:
            made = self.respond(one.piece, one.values, effects, one.start, wanted)
            recorded = self._recorded(one.piece)
            by_value, by_start = (part[:, 0] * recorded.weight for part in made.slopes)
            off = recorded.off(made.predicted)
            out.append(gram_of(by_start, *[np.zeros_like(off)] * stray, by_value, off))
        return out

    def _recorded(self, piece: Piece) -> Recorded:
        data = self.runs[piece.run]
        return Recorded.of(data.values[piece.span], data.sigma[piece.span])


def _data(swing: Swing) -> Data:
    sigma = np.full((swing.t.size, 1), swing.sigma)
    return Data(swing.name, swing.t, swing.angle[:, None], sigma, swing.held_out)


def _mean_speeds(swing: Swing) -> Array:
    """Over a tenth of a second each, so that the noise does not count, rad/s."""
    every = max(round(0.1 / float(np.median(np.diff(swing.t)))), 1)
    return np.diff(swing.angle[::every]) / np.diff(swing.t[::every])


def _path(swing: Swing, t: Array, late: float) -> DrivePath:
    inner = np.arange(_EACH) / _EACH
    edges = np.append((t[:-1, None] + np.diff(t)[:, None] * inner).ravel(), t[-1])
    torque = np.interp(edges + late, swing.t, swing.torque)
    nodes = np.array([[torque[:-1], (torque[:-1] + torque[1:]) / 2, torque[1:]]])
    return DrivePath(np.diff(edges), nodes, torque[None, ::_EACH], _EACH)


def _path_by_delay(
    swing: Swing, t: Array, path: DrivePath, late: float, delays: list[int], wanted: int
) -> DriveSlopes:
    """How the torque changes with the delay: by its slope over a sample to either side."""
    step = float(np.median(np.diff(t)))
    begins = t[0] + np.append(0.0, np.cumsum(path.h))[:-1]

    def slope(at: Array) -> Array:
        ahead, behind = (np.interp(at + late + s, swing.t, swing.torque) for s in (step, -step))
        out = np.zeros((1, at.size, wanted))
        out[0][:, delays] = ((ahead - behind) / (2 * step))[:, None]
        return out

    nodes = [slope(begins + part * path.h) for part in (0.0, 0.5, 1.0)]
    return DriveSlopes(slope(t), np.stack(nodes, axis=1))


@lru_cache
def _system(extras: tuple[Extra, ...]) -> tuple[System, tuple[str, ...]]:
    """The motion with some effects in it, and the names of its parameters."""
    angle, w, tau = (ca.SX.sym(name) for name in ("angle", "w", "tau"))
    symbols = {name: ca.SX.sym(name) for name in _UNITS}
    torque = tau - symbols["b"] * w - symbols["ml"] * G * ca.sin(angle)
    for extra in extras:
        symbols[extra.quantity] = ca.SX.sym(extra.quantity)
        torque += extra.torque(w, tau, symbols[extra.quantity])
    inputs = [ca.vertcat(angle, w), tau, ca.vertcat(*symbols.values())]
    rates = ca.Function("rates", inputs, [ca.vertcat(w, torque / symbols["J"])])
    # Dry friction brings the speed to rest at once: that state is stepped implicitly.
    return System(rates, ca.Function("seen", inputs, [angle]), stiff=1), tuple(symbols)


def _parameter(name: str, value: float, known: Uncertainty) -> Quantity:
    if known.factor:
        low, high = value / known.factor, value * known.factor
        return Quantity(name, _UNITS[name], value, value, True, low, high, value, free=True)
    return Quantity(name, _UNITS[name], value, known.sigma, True, value / 3, 3 * value, value)


def _candidate(extra: Extra, torque: float, speed: float) -> Candidate:
    own = extra.constant
    size = own.size(torque, speed)
    quantity = Quantity(extra.quantity, own.unit, 0.0, size, False, own.low, own.high, 0.0)
    form = Form((quantity,), ({extra.quantity: extra.begin * size},))
    return Candidate(extra.name, extra.family, extra.channel, extra.sentence, (form,))
