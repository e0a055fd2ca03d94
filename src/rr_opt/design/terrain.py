"""The objective and rows for sines: speed, torque, direction and turn of many gaits at once.

On the unit box of the decisions for the scan and the climbs, and as a program in amplitude, period,
offset and ballast for the final climb. There each torque peak is a row of its own that follows the
peak along the cycle: if held at fixed phases, the torque would peak beside them, and along a limit
the gaits are so similar that an optimum can drift far.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from rr_opt.array import Array, Indices
from rr_opt.design.decisions import Decisions, Setting, TurnRows, reach_before_singularity
from rr_opt.design.landscape import Cycles, dense
from rr_opt.design.transcription import ROWS
from rr_opt.model.problem import CANCELLED, LEAST, Interval
from rr_opt.sqp import Ascent, Program, Seen

_UNSETTLED = 10.0
"""Utilisation of each limit assigned to a gait without a steady cycle."""
_SEEN_FROM = 0.5
"""Utilisation of the torque limit above which a peak is a row."""
_DENSER, _WITHIN = 4, 12
"""Oversampling factor, by Fourier series, that resolves a peak; phases on either side within which
it is tracked."""
_AS_BADLY = 0.9
_LEAST_TORQUE = 1e-4
"""N m; errors of smaller torques are relative to this."""
_WIDE = 0.05
"""Smallest amplitude by which a stencil is scaled, rad."""
STANDS = 1e-6
"""m/s: 1 mm, the resolution of a capture system, in a quarter of an hour. Anything slower on a
circle counts as standing still."""
_ROUNDING = 1e-15
"""Rounding error of a mean speed: times the largest speed and the root of the phases."""
_MARGIN = 0.05
"""Singularity margin, relative to the robot's size, below which stencils shrink with it."""


_STEP = {True: 1e-4, False: 1e-3}
"""Step of a stencil, by whether friction is viscous; other friction is solved less exactly."""
_ANY_WAY = Interval(-4 * math.pi, 4 * math.pi)
_ANY_RADIUS = Interval(math.log(1e-9), math.log(1e9))
_FORWARD = Interval(1e-6, math.inf)
"""Bounds of the forward speed, in units of the speed's scale: 0 is neither forward nor backward."""


_CIRCLE, _SIDE = ("circle x", "circle y"), "side"
"""Rows of a circle: the mean velocity, and the side of the turn."""

LIMITS = ("rate", "angle", "singularity", "torque", "grip", "power", "cost_of_transport", "speed")
Aim = Literal["speed", "rows", "turn"]


@dataclass(frozen=True)
class Merit:
    """The penalised objective: the speed less a penalty for each row outside its interval.

    rows       the interval of each row
    penalties  for an excess of 1 of each row, m/s
    """

    rows: tuple[Interval, ...]
    penalties: tuple[float, ...]

    def __call__(self, values: Array) -> Array:
        """values: speed and rows, (1 + R, ...)."""
        merit = values[0]
        for row, asked, penalty in zip(values[1:], self.rows, self.penalties, strict=True):
            excess = np.maximum(row - asked.high, asked.low - row)
            merit = merit - penalty * np.maximum(excess, 0.0)
        return merit


@dataclass(frozen=True)
class _Side:
    """A row of a program: coefficient (value - end) <= 0, or = 0."""

    name: str
    coefficient: float
    end: float
    equal: bool


@dataclass(frozen=True)
class Terrain:
    """The gaits of a setting.

    way   +1 forward, -1 backward, 0 either
    rows  the rows included, of torque, economy, direction and turn
    aim   the objective: the speed, or least violation of the rows or of the requested turn
    """

    setting: Setting
    box: Decisions
    way: int
    rows: tuple[str, ...] = ("torque", "economy", "direction", "turn")
    aim: Aim = "speed"

    @cached_property
    def _loads(self) -> dict[str, float]:
        """Limits on the loads along the cycle, by name."""
        limits = {name: getattr(self.setting.problem.limits, name) for name in ("torque", "grip")}
        counted = "torque" in self.rows
        return {name: one for name, one in limits.items() if counted and math.isfinite(one)}

    def _used(self, cycles: Cycles, gaits: Array, denser: int = 1) -> list[tuple[str, Array]]:
        """Utilisation of each load's limit at the phases and between them, (N', K)."""
        loads = [("torque", cycles.torque)] if "torque" in self._loads else []
        if "grip" in self._loads:
            loads += [("grip", one) for one in self.setting.landscape.grips(cycles, gaits)]
        return [(name, np.abs(dense(one, denser)) / self._loads[name]) for name, one in loads]

    @cached_property
    def _economy(self) -> dict[str, float]:
        """Limits on quantities of a whole period, by name."""
        return self.setting.problem.limits.economy if "economy" in self.rows else {}

    def _shares(self, cycles: Cycles, gaits: Array, denser: int = 1) -> dict[str, Array]:
        """Utilisation of those limits, (K,) each."""
        if not self._economy:
            return {}
        limits, speed = self._economy, np.abs(cycles.speed)
        power, cost = self.setting.landscape.costs(cycles, gaits, denser)
        used = {"power": power, "cost_of_transport": cost}
        shares = {name: used[name] / one for name, one in limits.items() if name in used}
        if "speed" in limits:
            shares["speed"] = 2 - speed / limits["speed"]
        return shares

    @cached_property
    def _turn(self) -> TurnRows | None:
        return self.box.turn if "turn" in self.rows else None

    @cached_property
    def _ahead(self) -> bool:
        return self.way != 0 and "direction" in self.rows

    @cached_property
    def kept(self) -> tuple[Interval, ...]:
        """The interval of each row: utilisation of limits, forward speed, those of the turn."""
        torque = (Interval(-math.inf, 1.0),) if self._loads or self._economy else ()
        ahead = (_FORWARD,) if self._ahead else ()
        return (*torque, *ahead, *(self._turn.intervals if self._turn else ()))

    def merit(self, unit: float, torque: float, turn: float) -> Merit:
        """The speed less penalties, in a unit (m/s), for a violation of 1."""
        heavy = (torque * unit,) if self._loads or self._economy else ()
        ahead = (torque,) if self._ahead else ()
        rest = len(self.kept) - len(heavy) - len(ahead)
        return Merit(self.kept, (*heavy, *ahead, *(turn * unit,) * rest))

    def over(self, points: Array, nodes: int) -> Array:
        """Speed and rows at points (K, 4) of the unit box, (1 + R, K)."""
        gaits = self.box.physical(points)
        with np.errstate(all="ignore"):
            cycles = self.setting.landscape.cycles(gaits, nodes)
            used = [one.max(axis=0) for _, one in self._used(cycles, gaits)]
            shares = self._shares(cycles, gaits).values()
            used += [np.minimum(share, 1 + _UNSETTLED) for share in shares]
            torque = (np.max(used, axis=0),) if used else ()
            function = self._function(cycles, gaits)
            # The forward speed in the objective's unit, so that one weight serves both.
            unit = np.abs(cycles.speed) / function if self._cheap else 1.0
            values = self._values(cycles, gaits, unit)
            seen = np.array([function, *torque, *values])
        lost = ~np.isfinite(seen).all(axis=0)
        seen[:, lost], seen[0, lost] = 0.0, -_UNSETTLED if self.aim == "turn" else 0.0
        for row, kept in zip(seen[1:], self.kept, strict=True):
            far = kept.high + _UNSETTLED if math.isfinite(kept.high) else kept.low - _UNSETTLED
            row[lost] = far
        return seen

    @property
    def _cheap(self) -> bool:
        """Whether the cost of transport is minimised."""
        return self.aim == "speed" and self.setting.problem.objective != "speed"

    def _function(self, cycles: Cycles, gaits: Array, denser: int = 1) -> Array:
        """The objective. For speed, its magnitude, which is smooth between forward and backward; a
        row sets the direction. For cost of transport, its inverse, which is 0 for a robot at
        rest."""
        if self._cheap:
            return 1 / self.setting.landscape.costs(cycles, gaits, denser)[1]
        if self.aim == "speed":
            return np.abs(cycles.speed)
        turn = self.box.turn
        if self.aim == "rows" or turn is None:
            return np.zeros_like(cycles.speed)
        values = np.array(
            [np.zeros_like(cycles.speed), *turn.values(cycles.speed, cycles.turn, gaits[1])]
        )
        return Merit(turn.intervals, (1.0,) * len(turn.intervals))(values)

    def _values(self, cycles: Cycles, gaits: Array, unit: float | Array) -> list[Array]:
        """Forward speed in a unit (m/s), then the turn's rows."""
        V, E = cycles.mean[:2], cycles.mean[2:]
        ahead = [self.way * (V * E).sum(axis=0) / unit] if self._ahead else []
        turn = self._turn.values(cycles.speed, cycles.turn, gaits[1]) if self._turn else []
        return [*ahead, *turn]

    @cached_property
    def _bounds(self) -> tuple[Array, Array]:
        """Bounds of amplitude, period, offset, ballast share, direction of V, logarithm of the
        radius."""
        box, gait = self.box, self.setting.problem.gait
        share = 0.0 if box.ballast.fixed else self.setting.fixed_share
        radii = Interval(0.0, 0.0)
        if self._radius:
            radii = _ANY_RADIUS if self.aim == "turn" else Interval(self._asked, self._asked)
        boxes = (
            Interval(*[gait.amplitude.low] * 2) if box.amplitude_pinned else gait.amplitude,
            box.period if box.period.fixed else gait.period,
            box.offset if box.offset.fixed else gait.offset,
            Interval(0.0, 1.0) if share is None else Interval(share, share),
            _ANY_WAY if self._radius else Interval(0.0, 0.0),
            radii,
        )
        low, high = np.array([(one.low, one.high) for one in boxes]).T
        return low, high

    @cached_property
    def free(self) -> Indices:
        """Which of the decisions are free."""
        low, high = self._bounds
        return np.flatnonzero(low < high)

    @cached_property
    def _sides(self) -> list[_Side]:
        """All rows except the torque's, equations first."""
        rows = list(zip(self._named, self.kept[len(self.kept) - len(self._named) :], strict=True))
        if self._radius:
            rows = [(name, kept) for name, kept in rows if name != "curvature"]
            rows += [(name, Interval(0.0, 0.0)) for name in _CIRCLE]
            rows.append((_SIDE, Interval(0.0, math.inf)))
        if self.box.command:
            rows.append(("command", self.box.command.amplitude))
        sides = []
        for name, kept in rows:
            if kept.fixed:
                sides.append(_Side(name, 1.0, kept.low, True))
                continue
            ends = ((-1.0, kept.low), (1.0, kept.high))
            sides += [_Side(name, *end, False) for end in ends if math.isfinite(end[1])]
        return sorted(sides, key=lambda side: not side.equal)

    def program(self, start: Array, nodes: int) -> tuple[Program, Array]:
        """The program from a gait (4,), amplitude, period, offset, share, and its start."""
        free, limits = self.free, self.setting.problem.limits
        low, high = (end.copy() for end in self._bounds)
        start = np.append(start, self._lifted(start, nodes))
        if self._radius and start[5] > self._asked:
            low[5] = self._asked
        elif self._radius:
            high[5] = self._asked
        start = np.clip(start, low, high)
        size = min(1.0, limits.singularity / (_MARGIN * self.setting.problem.robot.platform1.c))
        scale = np.array([size * max(start[0], _WIDE), start[1], 0.5 * size, 1.0, 1.0, 1.0])
        matrix, most = np.array([[1.0, 0, 1, 0, 0, 0], [1.0, 0, -1, 0, 0, 0]]), [self.box.reach] * 2
        if math.isfinite(limits.rate):
            matrix = np.vstack([matrix, [1.0, -limits.rate / (2 * math.pi), 0, 0, 0, 0]])
            most.append(0.0)
        fixed = np.setdiff1d(np.arange(6), free)

        def look(points: Array) -> Seen:
            decided = np.repeat(start[:, None], len(points), axis=1)
            decided[free] = points.T
            gaits, beta, size = decided[:4], decided[4], decided[5]
            with np.errstate(all="ignore"):
                cycles = self.setting.landscape.cycles(gaits, nodes)
                unit = max(float(np.abs(cycles.speed[0])), STANDS)
                values = self._values(cycles, gaits, unit)
                function = self._function(cycles, gaits, _DENSER)
            known = dict(zip(self._named, values, strict=True))
            if self._radius:
                along = cycles.turn / gaits[1] * math.copysign(1.0, self._radius) * np.exp(size)
                if self._cheap:
                    function = function * along / np.abs(cycles.speed)
                else:
                    function = along if self.aim == "speed" else -np.abs(size - self._asked)
                known |= self._circle_rows(cycles.mean, along / unit, beta, unit)
            if self.box.command:
                known["command"] = gaits[0] / self.box.command.servo.gain(gaits[1])
            rows = [side.coefficient * (known[side.name] - side.end) for side in self._sides]
            with np.errstate(all="ignore"):
                loads = self._used(cycles, gaits, _DENSER)
                shares = self._shares(cycles, gaits, _DENSER)
            worst, names = list(rows), [side.name for side in self._sides]
            for name, used in loads:
                worst.append(_heights(used, used.argmax(axis=0)) - 1)
                peaks = [_heights(used, at) - 1 for at in _followed(used)]
                rows, names = rows + peaks, names + [name] * len(peaks)
            for name, share in shares.items():
                worst.append(share - 1)
                rows, names = [*rows, share - 1], [*names, name]
            shape = (-1, len(points))
            rounding = _ROUNDING * math.sqrt(nodes) * float(np.abs(cycles.v[:, 0]).max()) / unit
            return Seen(
                function, np.reshape(rows, shape), np.reshape(worst, shape), tuple(names), rounding
            )

        program = Program(
            low=low[free],
            high=high[free],
            scale=scale[free],
            matrix=matrix[:, free],
            most=most - matrix[:, fixed] @ start[fixed],
            look=look,
            equal=sum(side.equal for side in self._sides),
            unit=0.0 if self.aim == "speed" else 1.0,
            step=_STEP[self.setting.landscape.linear],
        )
        return program, start[free]

    def _lifted(self, gait: Array, nodes: int) -> Array:
        """The direction of V, rad, and the logarithm of the radius of a gait (4,). If the gait
        drives the other way rather than sideways, the direction is reversed: near V = 0 the two are
        neighbours."""
        cycle = self.setting.landscape.cycles(gait[:, None], nodes)
        V, E, omega = cycle.mean[:2, 0], cycle.mean[2:, 0], float(cycle.turn[0]) / gait[1]
        speed = max(float(np.hypot(*V)), STANDS)
        back = self._ahead and -self.way * float(V @ E) > abs(V[0] * E[1] - V[1] * E[0])
        V = -V if back else V
        return np.array([math.atan2(V[1], V[0]), math.log(speed / max(abs(omega), 1e-12))])

    def _circle_rows(self, mean: Array, along: Array, beta: Array, unit: float) -> dict[str, Array]:
        """Rows of the circle; along: omega R; all in the given unit."""
        cos, sin = np.cos(beta), np.sin(beta)
        rows = {
            _CIRCLE[0]: mean[0] / unit - along * cos,
            _CIRCLE[1]: mean[1] / unit - along * sin,
            _SIDE: along - STANDS / unit,
        }
        return rows | (
            {"direction": self.way * (cos * mean[2] + sin * mean[3])} if self._ahead else {}
        )

    def _curvature_price(self, ascent: Ascent) -> float:
        """Gain of the function per unit of curvature.

        The function goes with omega R, and two rows say V = omega R (cos beta, sin beta), in units
        of |V|. So a radius larger by dR gains dR/R of it and, as it moves the rows, their prices.
        """
        at, beta = (
            next(i for i, side in enumerate(self._sides) if side.name in _CIRCLE),
            ascent.x[-1],
        )
        along = float(ascent.prices.rows[at : at + 2] @ [math.cos(beta), math.sin(beta)])
        return -self._radius * (ascent.value + along)

    @cached_property
    def _radius(self) -> float:
        """Of the requested circle, signed, m; 0 if none.

        The curvature turn/(T |V|) is sharply curved near V = 0: a tight circle lies in a narrow
        valley. With the direction beta of V as an extra variable, V = omega R (cos beta, sin beta)
        gives two rows that are almost linear. When searching for the closest circle, the logarithm
        of R is a further variable.
        """
        if not self.box.turn or not (self.aim == "turn" or self._turn):
            return 0.0
        others = self.aim == "turn" and len(self.box.turn.names) > 1
        asked = self.box.turn.turn.curvature
        return 1 / asked.low if asked.fixed and asked.low and not others else 0.0

    @property
    def _asked(self) -> float:
        return math.log(abs(self._radius))

    @cached_property
    def _named(self) -> tuple[str, ...]:
        return (*(("direction",) if self._ahead else ()), *(self._turn.names if self._turn else ()))

    def gait_at(self, start: Array, x: Array) -> Array:
        """Amplitude, period, offset, share (4,) at a point of the program from `start`."""
        gait = np.clip(np.append(start, [0.0, 0.0]), *self._bounds)
        gait[self.free] = x
        return gait[:4]

    def clashing(self, gait: Array, nodes: int, excess: float) -> list[str]:
        """The limits that a gait violates, the worst by this much, about equally."""
        gaits = gait[:, None]
        cycles = self.setting.landscape.cycles(gaits, nodes)
        used = [*self._used(cycles, gaits), *self._shares(cycles, gaits).items()]
        shares: dict[str, float] = {}
        for name, share in used:
            shares[name] = max(float(share.max()), shares.get(name, 0.0))
        return [name for name, share in shares.items() if share > 1 + _AS_BADLY * excess]

    def measured(self, gait: Array, nodes: int) -> Array:
        """Mean speed, m/s, peak torque, N m, and, if it counts, the cost of transport of a gait
        (4,); and the scales of their relative errors."""
        with np.errstate(all="ignore"):
            cycle = self.setting.landscape.cycles(gait[:, None], nodes)
        torque = np.abs(dense(cycle.torque, _DENSER))
        speed, peak = float(cycle.speed[0]), float(_heights(torque, torque.argmax(axis=0))[0])
        scale = max(abs(speed), CANCELLED * float(np.abs(cycle.v).max()))
        seen = [(speed, scale), (peak, max(peak, _LEAST_TORQUE))]
        if self.setting.problem.economy:
            cost = self.cost(gait, nodes)
            seen.append((cost, cost * scale / abs(speed)))
        return np.array(seen).T

    def cost(self, gait: Array, nodes: int) -> float:
        """Cost of transport of a gait (4,)."""
        with np.errstate(all="ignore"):
            cycle = self.setting.landscape.cycles(gait[:, None], nodes)
            return float(self.setting.landscape.costs(cycle, gait[:, None], _DENSER)[1][0])

    def prices(
        self, gait: Array, speed: float, turn: float, ascent: Ascent
    ) -> tuple[dict[str, float], dict[str, float]]:
        """Gain per unit of each limit, and per unit by which an active bound moves up: in speed,
        m/s, or as a reduction of the cost of transport.

        speed (m/s) and turn (rad per period) of the gait
        """
        limits, robot, period = self.setting.problem.limits, self.setting.problem.robot, gait[1]
        found: dict[str, float] = dict.fromkeys((*LIMITS, *ROWS, "command"), 0.0)
        posture = float(ascent.prices.linear[:2].sum())
        if limits.angle <= reach_before_singularity(robot, limits.singularity):
            found["angle"] = posture
        else:
            # c1 cos(edge) + c2 = margin, so a wider margin reduces the edge.
            found["singularity"] = -posture / (robot.platform1.c * math.sin(self.box.reach))
        sides, prices = self._sides, ascent.prices
        if math.isfinite(limits.rate):
            found["rate"] = float(prices.linear[2] * period) / (2 * math.pi)
        for name, price in zip(ascent.names[len(sides) :], prices.rows[len(sides) :], strict=True):
            found[name] += (-1 if name in LEAST else 1) * float(price) / getattr(limits, name)
        slopes = self._turn.slopes(speed, turn, period) if self._turn else {}
        slopes["direction"] = 1 / max(abs(speed), STANDS)
        slopes["command"] = 1.0
        for side, price in zip(sides, prices.rows, strict=False):
            if side.name not in (*_CIRCLE, _SIDE):
                found[side.name] += side.coefficient * float(price) * slopes[side.name]
        if self._radius:
            found["curvature"] = self._curvature_price(ascent)
        names = ("amplitude", "period", "offset", "ballast")
        bounds: dict[str, float] = dict.fromkeys(names, 0.0)
        for i, up, down in zip(self.free[self.free < len(names)], prices.high, prices.low):  # noqa: B905
            bounds[names[i]] = float(up - down)
        bounds["amplitude"] += found.pop("command")
        if self._cheap:
            # The objective is 1/cost: the cost falls by cost^2 times its gain.
            per = ascent.value**-2
            found = {name: per * price for name, price in found.items()}
            bounds = {name: per * price for name, price in bounds.items()}
        return found, bounds


def _followed(used: Array) -> list[Indices]:
    """Nodes (K,) of each of the first gait's peaks in every gait.

    used: utilisation of the limit (N, K)
    """
    first, n = used[:, 0], len(used)
    peaks = np.flatnonzero(
        (first >= np.roll(first, 1)) & (first > np.roll(first, -1)) & (first > _SEEN_FROM)
    )
    around = (peaks[:, None] + np.arange(-_WITHIN, _WITHIN + 1)) % n
    return [at[used[at].argmax(axis=0)] for at in around]


def _heights(used: Array, at: Indices) -> Array:
    """Heights (K,) of peaks near phases (K,): of the quartic through five of them.

    A parabola jumps as a peak passes from one phase to the next, by enough to stall a climb.
    """
    k, n = np.arange(used.shape[1]), len(used)
    y = np.array([used[(at + i) % n, k] for i in (-2, -1, 0, 1, 2)])
    p = _QUARTIC @ y
    t = np.zeros(len(k))
    for _ in range(_NEWTON):
        slope = p[1] + t * (2 * p[2] + t * (3 * p[3] + t * 4 * p[4]))
        bend = 2 * p[2] + t * (6 * p[3] + t * 12 * p[4])
        t = np.where(bend < 0, np.clip(t - slope / np.where(bend < 0, bend, -1.0), -1.0, 1.0), t)
    return p[0] + t * (p[1] + t * (p[2] + t * (p[3] + t * p[4])))


_NEWTON = 3
_QUARTIC = np.linalg.inv(np.vander(np.arange(-2.0, 3.0), increasing=True))
"""From values at -2 .. 2 to coefficients."""
