"""A pendulum driven by a torque, as a second model that can be diagnosed.

    J th'' = tau - b th' - m l g sin th

with viscous friction only; `effects` lists what may be missing. It shares nothing with the
Roller Racer but the protocol, and shows what of the diagnosis belongs to no machine in particular.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from types import MappingProxyType

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.machines.pendulum.effects import EXTRAS, Extra
from rr_opt.model.experiment import Uncertainty
from rr_opt.sysid.diagnosis import Misfit
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.machine import Term
from rr_opt.sysid.model import (
    Choice,
    Data,
    EffectInfo,
    Form,
    Linearisation,
    Noise,
    Quantity,
    Request,
    Segment,
    Simulation,
)
from rr_opt.sysid.sensitivities import DriveSlopes, Recorded, Sought, grams
from rr_opt.sysid.settings import SETTINGS
from rr_opt.sysid.shooting import DrivePath, Path, System, predict

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
    """Recordings of a pendulum and its nominal J, ml, b; answers `sysid.model.Model`."""

    channels = ("angle",)
    inputs: Mapping[str, str] = MappingProxyType({})
    form_error = 0.0

    def __init__(
        self,
        swings: Sequence[Swing],
        nominal: Mapping[str, float],
        uncertainty: Mapping[str, Uncertainty],
    ) -> None:
        """nominal: J (kg m2), ml (kg m), b (N m s). What `uncertainty` does not name is exact."""
        self.swings, self._uncertainty = tuple(swings), uncertainty
        self.nominal = {name: nominal[name] for name in _UNITS}
        self.runs: Sequence[Data] = [_data(swing) for swing in self.swings]
        self.parameters: tuple[Quantity, ...] = tuple(
            _parameter(name, self.nominal[name], uncertainty[name])
            for name in _UNITS
            if name in uncertainty
        )
        self.correlation_time = SETTINGS.correlation_time
        # A period of small swings: in one, the way round has not yet parted from the way back.
        self.segment_length = 2 * math.pi * math.sqrt(self.nominal["J"] / (self.nominal["ml"] * G))
        torque = float(np.sqrt(np.mean(np.concatenate([s.torque for s in self.swings]) ** 2)))
        speeds = [float(np.nanmax(np.abs(_mean_speeds(s)))) for s in self.swings]
        self.catalogue: Mapping[str, EffectInfo] = {
            name: _effect_info(extra, torque, max(*speeds, 1e-3)) for name, extra in EXTRAS.items()
        }

    def upstream(self) -> Sequence[tuple[tuple[Choice, ...], Mapping[str, float]]]:
        """Nothing: the torque that drives it is taken as it was measured."""
        return [((), {})]

    def proposals(
        self, fit: Fit, complete: Sequence[str]
    ) -> Sequence[tuple[Choice, Mapping[str, float]]]:
        """Where the forms of effects without derivatives say."""
        return [
            (Choice(name), guess)
            for name, info in self.catalogue.items()
            if not info.smooth and name not in complete
            for guess in info.forms[0].guesses
        ]

    def with_noise(self, noise: Sequence[Noise]) -> Pendulum:
        """The same swings with other noise."""
        swings = [replace(one, sigma=one.sigma * noise[0].level) for one in self.swings]
        return Pendulum(swings, self.nominal, self._uncertainty)

    def unknown_inputs(self, fit: Fit) -> tuple[Sequence[Term], Mapping[Segment, Linearisation]]:
        """Not looked for."""
        return (), {}

    def next_experiment(self, best: Fit, rival: tuple[str, Fit] | None) -> None:
        """Not looked for."""

    def worth(self, before: Sequence[Misfit], after: Sequence[Misfit]) -> str:
        """Left to the misfit."""
        return ""

    def accuracy(self, misfits: Sequence[Misfit]) -> str:
        """Left to the misfit."""
        return ""

    def equivalent(self, values: Mapping[str, float]) -> None:
        """None: no two sets of values of a pendulum are alike."""

    def initial_state(
        self, segment: Segment, effects: tuple[str, ...], values: Mapping[str, float]
    ) -> Array:
        """Angle and speed (rad, rad/s) by a straight line through the first tenth of a second."""
        data = self.runs[segment.run]
        t, angle = data.t[segment.span], data.values[segment.span, 0]
        early = (t - t[0] <= 0.1) & np.isfinite(angle)
        slope, at = np.polyfit(t[early] - t[0], angle[early], 1)
        return np.array([at, slope])

    def converted(
        self, request: Request, before: tuple[str, ...], effects: tuple[str, ...]
    ) -> Array:
        """The same: no effect has a state of its own."""
        return request.state

    def state_scale(self, effects: tuple[str, ...]) -> Array:
        """As much as the noise, and as much a second."""
        return np.full(2, self.swings[0].sigma)

    def state_prior(self, effects: tuple[str, ...]) -> Array:
        """Nothing is known."""
        return np.full(2, np.inf)

    def simulate(
        self, requests: Sequence[Request], effects: tuple[str, ...]
    ) -> Sequence[Simulation]:
        """Simulate segments."""
        out = []
        for one in requests:
            made = self._simulated(one, effects)[-1]
            out.append(Simulation(self._recorded(one.segment).off(made.seen), made.states[:, -1]))
        return out

    def linearise(
        self, requests: Sequence[Request], effects: tuple[str, ...], wanted: tuple[str, ...]
    ) -> Sequence[Linearisation]:
        """Linearise segments."""
        extras = _chosen(effects)
        out = []
        for one in requests:
            system, names, p, path, late, made = self._simulated(one, effects)
            by = np.array([[float(own == name) for name in wanted] for own in names])
            by = by.reshape(len(names), len(wanted))
            delays = [wanted.index(e.quantity) for e in extras if e.delays and e.quantity in wanted]
            swing, t = self.swings[one.segment.run], self.runs[one.segment.run].t[one.segment.span]
            moved = _path_by_delay(swing, t, path, late, delays, len(wanted)) if delays else None
            sought = Sought(path, made, p, by, moved, self._recorded(one.segment))
            ((gram, end),) = grams(system, [sought])
            out.append(Linearisation(gram, end))
        return out

    def predicted(self, request: Request, effects: tuple[str, ...]) -> Array:
        """What would be recorded of a segment (n, 1), rad."""
        return self._simulated(request, effects)[-1].seen

    def _simulated(
        self, request: Request, effects: tuple[str, ...]
    ) -> tuple[System, tuple[str, ...], Array, DrivePath, float, Path]:
        """The system, its parameters' names and values, its drive, how late that is, its path."""
        extras = _chosen(effects)
        system, names = _system(extras)
        given = self.nominal | dict(request.values)
        p = np.array([given.get(name, 0.0) for name in names])
        segment = request.segment
        swing, t = self.swings[segment.run], self.runs[segment.run].t[segment.span]
        late = sum(given.get(extra.quantity, 0.0) for extra in extras if extra.delays)
        path = _path(swing, t, late)
        return system, names, p, path, late, predict(system, path, request.state, p)

    def _recorded(self, segment: Segment) -> Recorded:
        data = self.runs[segment.run]
        values = data.values[segment.span].copy()
        values[segment.until - segment.first :] = np.nan
        return Recorded.of(values, data.weighted_sigma[segment.span])


def _chosen(effects: tuple[str, ...]) -> tuple[Extra, ...]:
    return tuple(extra for name, extra in EXTRAS.items() if name in effects)


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


def _effect_info(extra: Extra, torque: float, speed: float) -> EffectInfo:
    own = extra.constant
    size = own.size(torque, speed)
    quantity = Quantity(extra.quantity, own.unit, 0.0, size, False, own.low, own.high, 0.0)
    form = Form((quantity,), ({extra.quantity: extra.begin * size},))
    return EffectInfo(
        *(extra.name, extra.family, extra.channel, extra.sentence, (form,)), smooth=extra.smooth
    )
