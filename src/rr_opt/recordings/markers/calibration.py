"""Where markers sit on the robot, learnt from recordings in which it drives.

Markers whose distance does not change are on one platform. The shape of a platform is the mean of
its frames, each turned onto the others. The joint P is the point that keeps its place in both
platforms' axes, as the motion of the servo shows. The axes follow from the wheels.
Which platform is the first shows in the distances of its axles from P, or in the sign of phi.

Wheels that do not slip keep the axle's centre from moving sideways. With P moving by (along, side)
in some axes of the platform while these turn by `turn`, the axle lies in the direction a from P at
the distance c where

    side cos a - along sin a + c turn = 0

at every instant. That is linear in (cos a, -sin a, c), whose scale is known, and all three
measured quantities have noise: total least squares, an eigenvector of three by three. Rows are
sums over a quarter of a second, in which platforms swing, and over seconds, in which they go far:
the noise of a sum is that of its ends. What is found is where the wheels roll to: an axle that toes
in has turned its platform's axes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from scipy.cluster.hierarchy import fcluster, linkage
from scipy.spatial.distance import squareform

from rr_opt.array import Array
from rr_opt.model.experiment import Layout
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.outcome import InputError
from rr_opt.recordings.cleaning import unwrapped
from rr_opt.recordings.markers.rigid import Complex, bodies_of, fit, places_of, seen_from_above
from rr_opt.recordings.noise import noise_of
from rr_opt.recordings.readers.marker_rows import MarkerData, carriers
from rr_opt.recordings.time_axis import LACKING
from rr_opt.recordings.warnings import Notice, notice

_FRAMES = 2000
_ROUNDS = 20
_TRIES = 3
_SETTLED = 1e-7
"""A round that moves the shapes by less than this is the last, m."""
_VAGUE = 0.02
"""Standard deviation beyond which the joint counts as unknown, m."""


@dataclass(frozen=True)
class Axle:
    """An axle as seen from P.

    direction  from P to the axle, in the axes whose heading is given, rad
    distance   m
    sigma      standard deviation of the direction, rad
    error      standard deviation of the distance, m
    """

    direction: float
    distance: float
    sigma: float
    error: float


@dataclass(frozen=True)
class Calibration:
    """Places of markers as recordings show them.

    layout   axes along which the wheels roll; where these do not show it, platform 1's axis runs
             from P to the mean of its markers, platform 2's from the mean of its markers to P
    joint    standard deviation of P in the platforms' axes, m
    axles    of platform 1 and 2; None where the wheels do not show them
    ordered  whether it is known which platform is the first
    """

    layout: Layout
    joint: float
    axles: tuple[Axle, Axle] | None
    ordered: bool = False

    @property
    def notice(self) -> Notice:
        """The result, and how well it is known."""
        both = self.layout.platform1, self.layout.platform2
        one, two = (", ".join(carriers([*places])) for places in both)
        known = {"one": one, "two": two, "joint": 1e3 * self.joint}
        if self.axles is None:
            return notice("layout.estimated", **known)
        first, second = self.axles
        return notice(
            "layout.calibrated" if self.ordered else "layout.rolling",
            **known,
            c1=1e3 * first.distance,
            c2=1e3 * second.distance,
            angle=1e3 * max(first.sigma, second.sigma),
        )


def calibration(
    recordings: Sequence[MarkerData], robot: Robot | None = None, gaits: Sequence[Gait | None] = ()
) -> Calibration:
    """The places of markers that recordings of one robot show together.

    robot, gaits  nominal robot and commands, which identify the platforms; otherwise the first
                  label's platform is the first

    Raises InputError if the markers do not form two rigid platforms that move against each other,
    or do not show which is the first.
    """
    labels = [one for one in recordings[0].labels if all(one in r.labels for r in recordings)]
    places = [places_of(one)[:, [one.labels.index(name) for name in labels]] for one in recordings]
    up = _upright(np.concatenate(places), recordings[0].up)
    seen = [seen_from_above(one, up)[0] for one in places]
    layout, joint = _shaped(labels, np.concatenate(seen), up)
    bodies = bodies_of(layout, labels, recordings[0].lever)
    fits = [fit(bodies, one[:, bodies.columns]) for one in seen]
    times, joints = [one.t for one in recordings], [one.joint for one in fits]
    first, second = (axle_of(times, joints, [one.heading[:, k] for one in fits]) for k in (0, 1))
    if first is None or second is None:
        return Calibration(layout, joint, None)
    one = _turned(layout.platform1, first.direction)
    two = _turned(layout.platform2, second.direction)
    phis = [one.heading[:, 1] - one.heading[:, 0] for one in fits]
    order = _order((first, second), robot, [*zip(times, phis, gaits, strict=False)])
    if order < 0:
        one, two, first, second = two, one, second, first
    # Platform 2's axis points from its axle to P.
    layout = Layout(one, _turned(two, np.pi), up)
    return Calibration(layout, joint, (first, second), ordered=bool(order))


_FLAT = 0.2
"""A robot on a floor moves by less than this up and down, relative to along and across."""


def _upright(places: Array, usual: str) -> str:
    """The axis along which markers (n, k, 3) hardly move; `usual` where none stands out."""
    seen = places[:, np.isfinite(places[..., 0]).sum(axis=0) > 1]
    if not seen.size:
        return usual
    moved = np.median(np.nanstd(seen, axis=0), axis=0)
    least, more, _ = np.argsort(moved)
    return "xyz"[least] if moved[least] < _FLAT * moved[more] else usual


def _turned(places: Mapping[str, tuple[float, ...]], by: float) -> dict[str, tuple[float, ...]]:
    """Places in axes that are turned by an angle, rad."""
    turned = {name: complex(*at[:2]) * np.exp(-1j * by) for name, at in places.items()}
    return {name: (float(z.real), float(z.imag)) for name, z in turned.items()}


_BUILT = 2e-3
"""How well the builder knows an axle's distance from P, m."""
_LIKELIER = 25.0
"""Chi squared by which distances have to be likelier than exchanged ones."""
_FOLLOWS = 0.5
"""Least correlation of a phi that follows its command."""


def _order(
    axles: tuple[Axle, Axle],
    robot: Robot | None,
    driven: Sequence[tuple[Array, Array, Gait | None]],
) -> int:
    """1 if the first axle is platform 1's, -1 if it is platform 2's, 0 if nothing shows it.

    driven: of each recording the times, phi if the first is platform 1, and the command. With the
    platforms exchanged phi has the other sign.
    """
    if robot is None:
        return 0
    built = robot.platform1.c, robot.platform2.c

    def misfit(both: Sequence[Axle]) -> float:
        return sum(
            ((one.distance - c) / np.hypot(one.error, _BUILT)) ** 2
            for one, c in zip(both, built, strict=True)
        )

    likelier = misfit(axles[::-1]) - misfit(axles)
    if abs(likelier) > _LIKELIER:
        return 1 if likelier > 0 else -1
    follows = [_correlation(phi, gait.angle(t)) for t, phi, gait in driven if gait is not None]
    usual = float(np.median(follows)) if follows else 0.0
    return int(np.sign(usual)) if abs(usual) > _FOLLOWS else 0


def _correlation(phi: Array, command: Array) -> float:
    """Of an angle, rad, within a turn, with its command."""
    known = np.isfinite(phi)
    if known.sum() < 3:
        return 0.0
    both = np.corrcoef(np.unwrap(phi[known]), command[known])[0, 1]
    return float(np.nan_to_num(both))


def _shaped(labels: Sequence[str], seen: Array, up: str) -> tuple[Layout, float]:
    """Layout and P's standard deviation; seen: (n, k, 2) from above, m."""
    sample = seen[:: max(1, len(seen) // _FRAMES)]
    first, second = rigid_groups(labels, sample)
    groups = [first, second] if min(first) < min(second) else [second, first]
    shapes, poses = zip(*(_shape(sample[:, group]) for group in groups), strict=True)
    places, sigma = _joint(poses)
    layouts = []
    for group, shape, joint, sign in zip(groups, shapes, places, (1, -1), strict=True):
        off = shape - joint
        own = {labels[i]: (float(z.real), float(z.imag)) for i, z in zip(group, off, strict=True)}
        layouts.append(_turned(own, float(np.angle(sign * off.mean()))))
    return Layout(*layouts, up=up), sigma


_APART = 3.0
"""Least ratio of the changes of distances between platforms to those within. The latter come from
the markers' noise, and a marker may have twice the noise of another."""


def rigid_groups(labels: Sequence[str], seen: Array) -> tuple[list[int], list[int]]:
    """Two sets of markers with fixed distances, the larger first.

    seen: (n, k, 2), m. Raises InputError if there are no two such sets.
    """
    if len(labels) < 4:
        _refuse(labels, "fewer than two markers for each platform")
    apart = np.linalg.norm(seen[:, :, None] - seen[:, None], axis=-1)
    known = np.isfinite(apart).any(axis=0)
    apart = np.where(known, apart, 0.0)
    middle = np.nanmedian(apart, axis=0)
    change = 1.4826 * np.nanmedian(np.abs(apart - middle), axis=0)
    # Two markers that are never seen together are not known to be on one platform.
    change[~known] = 10 * change[known].max(initial=1.0)
    np.fill_diagonal(change, 0.0)
    tree = linkage(squareform((change + change.T) / 2, checks=False), "complete")
    # Cut where the next merger would join what moves: the largest step in the tree's heights.
    heights = np.maximum(tree[:, 2], 1e-6)
    cut = int(np.argmax(heights[1:] / heights[:-1])) if len(heights) > 1 else 0
    if heights[cut + 1] < _APART * heights[cut]:
        _refuse(labels, "no two sets of markers that move against each other")
    member = fcluster(tree, t=heights[cut] * 1.001, criterion="distance")
    sets = sorted(
        ([int(i) for i in np.flatnonzero(member == one)] for one in set(member)),
        key=len, reverse=True,
    )  # fmt: skip
    if len(sets) < 2 or len(sets[1]) < 2:
        _refuse(labels, "only one set of markers with fixed distances")
    if len(sets) > 2 and len(sets[2]) >= 2:
        _refuse(labels, "more than two sets of markers with fixed distances")
    return sets[0], sets[1]


def _refuse(labels: Sequence[str], what: str) -> NoReturn:
    raise InputError(
        f"The markers {', '.join(carriers(labels))} show {what}. Expected two rigid platforms with "
        "at least two markers each, and a servo that moves. Give the layout with --layout."
    )


def _shape(seen: Array) -> tuple[Complex, tuple[Complex, Complex]]:
    """A platform's markers in its own axes (complex, k), and its origin and turn (complex, n).

    Each round turns every frame onto the shape, and takes the median of the turned frames.
    """
    z = seen[..., 0] + 1j * seen[..., 1]
    whole = np.isfinite(z).all(axis=1)
    if not whole.any():
        raise InputError(
            "No frame shows all markers of a platform. Expected some that do, to learn its shape. "
            "Give the layout with --layout."
        )
    shape = z[whole][0] - z[whole][0].mean()
    for _ in range(_ROUNDS):
        origin, turn = _pose(z, shape)
        own = (z - origin[:, None]) * np.conj(turn)[:, None]
        if not np.isfinite(own).any(axis=0).all():
            raise InputError(
                "All markers of a platform are at one point. Expected them apart, to show its "
                "heading. Check the file, or give the layout with --layout."
            )
        new = np.nanmedian(own.real, axis=0) + 1j * np.nanmedian(own.imag, axis=0)
        new -= new.mean()
        done = np.abs(new - shape).max() < _SETTLED
        shape = new
        if done:
            break
    return shape, _pose(z, shape)


def _pose(z: Complex, shape: Complex) -> tuple[Complex, Complex]:
    weight = np.isfinite(z).astype(float)
    count = np.maximum(weight.sum(axis=1), 1)
    z = np.nan_to_num(z)
    centre, middle = z.sum(axis=1) / count, weight @ shape / count
    total = ((z - centre[:, None]) * weight) @ np.conj(shape)
    size = np.abs(total)
    known = (weight.sum(axis=1) >= 2) & (size > 0)
    turn = np.where(known, total / np.where(known, size, 1.0), np.nan)
    return centre - turn * middle, turn


def _joint(poses: Sequence[tuple[Complex, Complex]]) -> tuple[tuple[complex, complex], float]:
    """P in both platforms' axes: O1 + R1 u = O2 + R2 w in all frames, by least squares.

    Frames that are far off are dropped, and it is solved once more.
    """
    (o1, r1), (o2, r2) = poses
    good = np.isfinite(o1) & np.isfinite(o2) & np.isfinite(r1) & np.isfinite(r2)
    every, right = np.column_stack([r1, -r2]), o2 - o1
    found, size = np.zeros(2, complex), 0.0
    for _ in range(_TRIES):
        found = np.linalg.lstsq(every[good], right[good], rcond=None)[0]
        off = np.abs(every @ found - right)
        size = float(np.median(off[good])) if good.any() else 0.0
        good = np.isfinite(off) & (off <= 6 * max(size, 1e-12))
    A = every[good]
    variance = size**2 / (2 * np.log(2))
    covariance = variance * np.linalg.pinv(A.conj().T @ A, hermitian=True).real
    sigma = float(np.sqrt(np.diag(covariance).max()))
    weak = np.linalg.matrix_rank(A, tol=1e-6 * np.sqrt(len(A) + 1)) < 2
    if weak or sigma > _VAGUE:
        raise InputError(
            "The servo moves too little to locate the joint P, the point common to both platforms. "
            "Expected a motion of a few degrees. Record one, or give the layout with --layout."
        )
    return (complex(found[0]), complex(found[1])), sigma


_ROWS = (0.25, 1.0, 4.0)
"""s: from a part of a gait's period to several."""
_BLOCKS = 20
"""Left out one at a time, for the standard deviations."""
_SHOWN = 2.0
"""Least ratio of the mean square of the motion to that of the rolling residual, both in noise."""
_SURE = 0.03
"""Standard deviation beyond which a direction counts as unknown, rad."""
_LEAST = np.array([1e-6, 1e-6, 1e-5])
"""Least noise that is assumed: m, m, rad."""


def axle_of(
    times: Sequence[Array], joints: Sequence[Array], headings: Sequence[Array]
) -> Axle | None:
    """The axle that some recordings show; None if the platform does not roll, or too little.

    By recording: times (n,), s; P (n, 2), m; the platform's heading (n,), rad, within a turn.
    """
    noises = [_noise(*one) for one in zip(joints, headings, strict=True)]
    noise = np.fmax(np.fmax.reduce(noises), _LEAST)
    blocks = np.zeros((_BLOCKS, 3, 3))
    for seconds in _ROWS:
        motions = zip(times, joints, headings, strict=True)
        rows = np.concatenate([_rows(*one, seconds) for one in motions]) / noise
        blocks += [one.T @ one for one in np.array_split(rows, _BLOCKS)]
    total = blocks.sum(axis=0)
    if not total.any():
        return None
    sizes = np.linalg.eigvalsh(total)
    direction, distance = _solved(total, noise)
    apart = np.array([_solved(total - one, noise) for one in blocks]) - (direction, distance)
    apart[:, 0] = (apart[:, 0] + np.pi) % (2 * np.pi) - np.pi
    sigma, error = np.sqrt((_BLOCKS - 1) * apart.var(axis=0))
    if sizes[1] < _SHOWN * sizes[0] or not sigma < _SURE:
        return None
    return Axle(direction, distance, float(sigma), float(error))


def _noise(joint: Array, heading: Array) -> Array:
    """Of along, side and turn of a recording; NaN where it cannot be estimated."""
    place = max(noise_of(one).sigma for one in joint.T)
    return np.array([place, place, noise_of(unwrapped(heading)).sigma])


def _rows(t: Array, joint: Array, heading: Array, seconds: float) -> Array:
    """along, side and turn (rows, 3) over some seconds without a gap."""
    step = float(np.median(np.diff(t))) if len(t) > 1 else seconds
    turn = (np.diff(heading) + np.pi) % (2 * np.pi) - np.pi
    moved = np.diff(joint[:, 0] + 1j * joint[:, 1]) * np.exp(-1j * (heading[:-1] + turn / 2))
    each = np.column_stack([moved.real, moved.imag, turn])
    each[np.diff(t) > LACKING * step] = np.nan
    whole = max(1, round(seconds / step))
    starts = np.arange(0, len(each) - whole + 1, max(1, whole // 4))
    gone = np.concatenate([[0], np.cumsum(~np.isfinite(each).all(axis=1))])
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(np.nan_to_num(each), axis=0)])
    kept = starts[gone[starts + whole] == gone[starts]]
    return sums[kept + whole] - sums[kept]


def _solved(moments: Array, noise: Array) -> tuple[float, float]:
    """Direction and distance that leave least of the rows' second moments (3, 3), in noise."""
    along, side, turn = np.linalg.eigh(moments)[1][:, 0] / noise
    sign = 1.0 if turn > 0 else -1.0
    size = max(float(np.hypot(along, side)), 1e-300)
    return float(np.arctan2(-sign * along, sign * side)), sign * float(turn) / size
