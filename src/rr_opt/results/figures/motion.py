"""The path of P, with the robot drawn at a few instants, and as a film; a driven route."""

from __future__ import annotations

import math
import shutil
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Circle, Polygon
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from rr_opt.documents.archive import whole
from rr_opt.formatting import number
from rr_opt.model.problem import Limits
from rr_opt.model.robot import Robot
from rr_opt.motion.steady_cycle import Cycle, SteadyCycle, Trajectory
from rr_opt.outcome import InputError, RollerRacerError
from rr_opt.results.figures import style
from rr_opt.results.motion import Film, SimulatedMotion
from rr_opt.results.result import Progress

if TYPE_CHECKING:
    from rr_opt.results.route import DrivenRoute


def robot_length(robot: Robot) -> float:
    """From the wheels of platform 1 to those of platform 2 when stretched, m."""
    return robot.platform1.c + robot.platform2.c + 2 * robot.h


def draw_robot(ax: Axes, robot: Robot, motion: Trajectory, i: int, *, alpha: float = 1.0) -> list:
    """Draw the robot at instant i of a motion, less opaque with a smaller alpha.

    Returns the artists, in order, so that an animation can remove them again.
    """
    joint = complex(motion.x[i], motion.y[i])
    psi, phi, h = float(motion.psi[i]), float(motion.phi[i]), robot.h
    artists: list = []

    def shape(points: NDArray, **look: Any) -> None:
        corners = np.column_stack([np.real(points), np.imag(points)])
        artists.append(ax.add_patch(Polygon(corners, **look)))

    for one, axis, colour in (
        (robot.platform1, np.exp(1j * psi), style.PLATFORM1),
        (robot.platform2, -np.exp(1j * (psi + phi)), style.PLATFORM2),
    ):
        # Along the platform from the joint; 1j times the distance to the side.
        wide = 0.72 * one.b
        tail, nose = -0.25 * one.b, one.c + 0.35 * h
        hull = np.array([tail + 0.55j * wide, nose + 1j * wide, nose - 1j * wide,
                         tail - 0.55j * wide])  # fmt: skip
        hull = joint + axis * hull
        shape(hull, facecolor=colour, edgecolor=colour, alpha=0.55 * alpha, zorder=4)
        shape(hull, fill=False, edgecolor=colour, linewidth=1.2, alpha=alpha, zorder=5)
        ends = joint + axis * (one.c + np.array([-1j, 1j]) * one.b)
        artists += ax.plot(ends.real, ends.imag, color=style.WHEEL, lw=1.2, alpha=alpha, zorder=5)
        tyre = 1j * (0.16 * one.b + 0.001)
        wheel = np.array([-h - tyre, h - tyre, h + tyre, -h + tyre])
        for side in (-one.b, one.b):
            place = joint + axis * (one.c + 1j * side + wheel)
            shape(place, facecolor=style.WHEEL, edgecolor="none", alpha=alpha, zorder=5)
    size = 0.16 * min(robot.platform1.b, robot.platform2.b) + 0.003
    look = {"facecolor": style.PAPER, "edgecolor": style.INK, "linewidth": 1.1, "alpha": alpha}
    dot = ax.add_patch(Circle((joint.real, joint.imag), size, **look, zorder=6))
    return [*artists, dot]


def cycles_to_show(robot: Robot, cycle: Cycle) -> int:
    """Enough periods to move by a few robot lengths, or once round the circle."""
    wanted = 3.0 * robot_length(robot)
    step = max(abs(cycle.speed) * cycle.period, 1e-9)
    count = math.ceil(wanted / step)
    if abs(cycle.dpsi) > 1e-6:
        count = min(count, math.ceil(2 * math.pi / abs(cycle.dpsi)))
    return min(max(count, 2), 24)


_POINTS = 6000
"""Most points of a path that is drawn."""
_POSES = 20
"""Most poses of the robot, along the diagonal of the picture."""


def path(ax: Axes, robot: Robot, motion: Trajectory, speed: float, period: float) -> None:
    """The path of P (m) and the robot at its last instant and at some earlier ones.

    motion: turned as it should be drawn; speed: signed, m/s, gives the colour; period: of the
    gait, s, over which the arrow takes its direction.
    """
    step = max(1, len(motion.x) // _POINTS)
    ax.plot(motion.x[::step], motion.y[::step], color=style.colour_of(speed), lw=1.6, zorder=3,
            label="path of P")  # fmt: skip
    chosen = instants(motion, robot_length(robot))
    for order, i in enumerate(chosen):
        alpha = 1.0 - 0.65 * (len(chosen) - 1 - order) / max(len(chosen) - 1, 1)
        draw_robot(ax, robot, motion, i, alpha=alpha)
    _arrow(ax, robot, motion, speed, period)
    ax.margins(0.06)
    ax.set(aspect="equal", adjustable="datalim", xlabel="x, m", ylabel="y, m")


def instants(motion: Trajectory, length: float) -> list[int]:
    """Indices of poses at least 1.3 robot lengths apart, the last among them.

    They are farther apart on a long path: many poses hide the path, and take seconds to draw.
    """
    last = len(motion.x) - 1
    size = math.hypot(np.ptp(motion.x), np.ptp(motion.y))
    apart = max(1.3 * length, size / _POSES)
    chosen = [last]
    for i in range(last - 1, -1, -max(1, last // _POINTS)):
        near = [math.hypot(motion.x[i] - motion.x[j], motion.y[i] - motion.y[j]) for j in chosen]
        if min(near) >= apart:
            chosen.append(i)
    return chosen[::-1]


def along_travel(motion: Trajectory) -> Trajectory:
    """The motion rotated so that it leads along x from the origin."""
    way = (motion.x - motion.x[0]) + 1j * (motion.y - motion.y[0])
    angle = float(np.angle(way[-1]))
    way = way * np.exp(-1j * angle)
    return replace(motion, x=way.real, y=way.imag, psi=motion.psi - angle)


def _arrow(ax: Axes, robot: Robot, motion: Trajectory, speed: float, period: float) -> None:
    """An arrow in the direction of travel, ahead of the last pose."""
    before = int(np.searchsorted(motion.t, motion.t[-1] - period * (1 + 1e-9)))
    last = np.array([motion.x[-1], motion.y[-1]])
    step = last - np.array([motion.x[before], motion.y[before]])
    size = math.hypot(*step)
    if size < 1e-6:
        return
    leading = robot.platform1 if speed > 0 else robot.platform2
    start = last + step / size * (leading.c + 3 * robot.h)
    end = start + step / size * 0.3 * robot_length(robot)
    arrow = {"arrowstyle": "-|>", "color": style.colour_of(speed), "lw": 2.0, "mutation_scale": 14}
    ax.annotate("", tuple(end), tuple(start), arrowprops=arrow)
    ax.update_datalim([tuple(end)])


_WIDTH, _DPI = 7.2, 100


def frames(robot: Robot, trajectory: Trajectory, chosen: NDArray[np.int_]) -> Iterator[NDArray]:
    """A picture (height, width, 3) of 8-bit colours for each of the chosen instants.

    Axes and grid are drawn once; only what moves is drawn again.
    """
    with style.styled():
        drawn = style.figure(_WIDTH, _height(robot, trajectory))
        drawn.set_dpi(_DPI)
        canvas = FigureCanvasAgg(drawn)
        ax = drawn.add_subplot()
        margin, x, y = 0.75 * robot_length(robot), trajectory.x, trajectory.y
        ax.set(xlim=(x.min() - margin, x.max() + margin), xlabel="x, m", aspect="equal")
        ax.set(ylim=(y.min() - margin, y.max() + margin), ylabel="y, m")
        canvas.draw()
        drawn.set_layout_engine("none")
        still = canvas.copy_from_bbox(drawn.bbox)
        (trail,) = ax.plot([], [], color=style.colour_of(float(trajectory.v.mean())), lw=1.6)
        clock = ax.text(0.01, 0.97, "", transform=ax.transAxes, va="top", color=style.GREY)
        for i in chosen:
            trail.set_data(trajectory.x[: i + 1], trajectory.y[: i + 1])
            clock.set_text(f"t = {trajectory.t[i]:.2f} s   v = {trajectory.v[i]:+.3f} m/s")
            parts = draw_robot(ax, robot, trajectory, i)
            canvas.restore_region(still)
            for artist in (trail, *parts, clock):
                ax.draw_artist(artist)
            yield np.asarray(canvas.buffer_rgba())[..., :3].copy()
            for part in parts:
                part.remove()


def _height(robot: Robot, trajectory: Trajectory) -> float:
    """Inches to suit the path's shape; an even number of pixels, as video needs."""
    margin = 1.5 * robot_length(robot)
    wide, high = np.ptp(trajectory.x) + margin, np.ptp(trajectory.y) + margin
    return round(_DPI / 2 * min(max((_WIDTH - 0.8) * high / wide + 0.9, 2.6), 8.0)) / (_DPI / 2)


def over_time(
    axes: Sequence[Axes], motion: Trajectory, limits: Limits, rate: ArrayLike | None = None
) -> None:
    """Fill the axes, top to bottom: phi (rad), its rate (rad/s) if given, v (m/s), torque (N m)."""
    t = motion.t
    against_limit(axes[0], t, motion.phi, limits.angle, "φ, rad")
    if rate is not None:
        against_limit(axes[1], t, rate, limits.rate, "dφ/dt, rad/s")
    axes[-2].plot(t, motion.v, color=style.INK)
    axes[-2].set_ylabel("v, m/s")
    against_limit(axes[-1], t, motion.torque, limits.torque, "τ, N m")
    axes[-1].set_xlabel("time, s")
    for ax in axes:
        ax.set_xlim(t[0], t[-1])
    axes[0].figure.align_ylabels(list(axes))  # type: ignore[union-attr]


def cycle(axes: Sequence[Axes], steady: SteadyCycle, limits: Limits) -> None:
    """A steady cycle in four axes, and the mean of its v."""
    over_time(axes, steady, limits, steady.gait.rate(steady.t))
    mean = float(steady.v[:-1].mean())
    axes[2].axhline(mean, color=style.colour_of(steady.speed), lw=1.3, ls=(0, (5, 2)))
    axes[2].margins(y=0.25)
    means = f"mean of v {mean:+.4f} m/s, of P along its path {steady.speed:+.4f} m/s"
    style.note(axes[2], means, color=style.colour_of(steady.speed))


def against_limit(ax: Axes, t: ArrayLike, values: ArrayLike, limit: float, label: str) -> None:
    """A quantity over time with its limit; a limit far away is only named."""
    values = np.asarray(values, float)
    ax.plot(t, values, color=style.FORWARD)
    ax.set_ylabel(label)
    peak, unit = float(np.abs(values).max()), label.rsplit(", ", maxsplit=1)[-1]
    if not math.isfinite(limit):
        ax.margins(y=0.25)
        return
    if peak < 0.4 * limit:
        ax.margins(y=0.3)
        style.note(ax, f"{100 * peak / limit:.0f} % of the limit, {number(limit)} {unit}")
        return
    for value in (limit, -limit):
        ax.axhline(value, color=style.LIMIT, lw=1.2, ls=(0, (4, 2)))
    ax.set_ylim(-1.35 * max(limit, peak), 1.35 * max(limit, peak))
    style.note(ax, f"limit {number(limit)} {unit}", y=0.985, color=style.LIMIT)
    ax.axhline(0, color=style.GREY, lw=0.5)


def draw_motion(motion: SimulatedMotion) -> dict[str, str]:
    """Four axes, top to bottom: path (m), phi (rad), v (m/s), torque (N m)."""
    robot, trajectory, servo = motion.robot, motion.trajectory, motion.robot.servo
    drawn = style.figure(style.WIDTH, 8.0)
    axes = drawn.subplots(4, 1, gridspec_kw={"height_ratios": [2.4, 1, 1, 1]})
    path(axes[0], robot, trajectory, float(trajectory.v.mean()), motion.gait.period)
    axes[0].set_title("The path of P, and the robot at a few instants")
    over_time(axes[1:], trajectory, Limits(servo.angle_limit, torque=servo.torque_limit))
    for ax in axes[1:3]:
        ax.sharex(axes[3])
        ax.tick_params(labelbottom=False)
    return {"motion": style.svg(drawn)}


def draw_route(result: DrivenRoute) -> dict[str, str]:
    """The way seen from above, and the drive over time."""
    replay, command = result.replay, result.command
    if replay is None or command is None:
        return {}
    drawn = style.figure(style.WIDTH, 7.0)
    axes, driven = drawn.subplots(4, 1, sharex=True), replay.trajectory
    over_time(axes, driven, result.plan.problem.limits, command.at(driven.t)[1])
    return {"way": style.panel(5.0, lambda ax: _way(ax, result, driven)), "drive": style.svg(drawn)}


def _way(ax: Axes, result: DrivenRoute, driven: Trajectory) -> None:
    poses = [leg.at(s) for leg in result.plan.legs for s in np.linspace(0, leg.length, 100)]
    x, y = [pose.x for pose in poses], [pose.y for pose in poses]
    ax.plot(x, y, color="#b4bdc6", lw=5, label="path asked")
    ax.plot(driven.x, driven.y, color=style.INK, lw=1.2, label="path of P, driven")
    for i in (0, *instants(driven, robot_length(result.robot))):
        draw_robot(ax, result.robot, driven, i, alpha=0.7)
    ax.set(aspect="equal", adjustable="datalim", xlabel="x, m", ylabel="y, m")
    ax.legend()


_RATE = {"gif": 20, "mp4": 30}
_MOST_FRAMES = 1200


def check_film(kind: Film) -> None:
    """Raise InputError if films of this kind cannot be made on this machine."""
    if kind == "mp4" and shutil.which("ffmpeg") is None:
        raise InputError(
            "MP4 films need the program ffmpeg, which was not found. Install ffmpeg, or make a "
            "GIF with --animate gif."
        )


def write_film(
    path: Path, robot: Robot, trajectory: Trajectory, kind: Film, progress: Progress
) -> Path:
    """Write the film, in real time; a motion too long for that is shown faster."""
    rate = _RATE[kind]
    count = min(max(round(rate * float(trajectory.t[-1])), 1), _MOST_FRAMES)
    chosen = np.linspace(0, len(trajectory.t) - 1, count + 1).round().astype(int)

    def counted() -> Iterator[NDArray]:
        for place, picture in enumerate(frames(robot, trajectory, chosen), 1):
            progress(f"film, frame {place} of {len(chosen)}")
            yield picture

    with whole(path) as temporary:
        if kind == "gif":
            last = next(frames(robot, trajectory, chosen[-1:]))
            _gif(temporary, counted(), rate, last)
        else:
            _mp4(temporary, counted(), rate)
    return path


def _gif(path: Path, pictures: Iterator[NDArray], rate: int, fullest: NDArray) -> None:
    """One palette for all frames, of the fullest picture, so that colours do not change."""
    palette = Image.fromarray(fullest).quantize(128, method=Image.Quantize.MAXCOVERAGE)
    indexed = (
        Image.fromarray(picture).quantize(palette=palette, dither=Image.Dither.NONE)
        for picture in pictures
    )
    first = next(indexed)
    first.save(path, save_all=True, append_images=indexed, duration=1000 // rate, loop=0)


def _mp4(path: Path, pictures: Iterator[NDArray], rate: int) -> None:
    first = next(pictures)
    height, width, _ = first.shape
    command = [
        *("ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"),
        *("-s", f"{width}x{height}", "-r", str(rate), "-i", "-"),
        *("-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(path)),
    ]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as running:
        try:
            _feed(running.stdin, chain([first], pictures))
        except BaseException:
            running.kill()
            raise
        complaint = running.communicate()[1].decode(errors="replace").strip()
    if running.returncode:
        raise RollerRacerError(f"ffmpeg could not make the film: {complaint}")


def _feed(pipe: IO[bytes] | None, pictures: Iterable[NDArray]) -> None:
    # A broken pipe means that ffmpeg gave up: its own message says why.
    with suppress(BrokenPipeError):
        for picture in pictures:
            if pipe is not None:
                pipe.write(picture.tobytes())
