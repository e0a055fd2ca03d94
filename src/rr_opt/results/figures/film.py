"""Pictures to a film: GIF by pillow, MP4 by the program ffmpeg."""

import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import IO, Literal

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from rr_opt.documents.archive import whole
from rr_opt.model.robot import Robot
from rr_opt.motion.steady_cycle import Trajectory
from rr_opt.outcome import InputError, RollerRacerError
from rr_opt.results.figures.motion import frames

Film = Literal["gif", "mp4"]

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
    path: Path,
    robot: Robot,
    trajectory: Trajectory,
    kind: Film,
    progress: Callable[[str], None] = lambda _: None,
) -> Path:
    """Write the film, in real time; a motion too long for that is shown faster."""
    check_film(kind)
    rate = _RATE[kind]
    count = min(max(round(rate * float(trajectory.t[-1])), 1), _MOST_FRAMES)
    chosen = np.linspace(0, len(trajectory.t) - 1, count + 1).round().astype(int)

    def counted() -> Iterator[NDArray]:
        for number, picture in enumerate(frames(robot, trajectory, chosen), 1):
            progress(f"film, frame {number} of {len(chosen)}")
            yield picture

    with whole(path) as temporary:
        if kind == "gif":
            last = next(frames(robot, trajectory, chosen[-1:]))
            _gif(temporary, counted(), rate, last)
        else:
            _mp4(temporary, counted(), rate)
    return path


def _gif(path: Path, pictures: Iterator[NDArray], rate: int, fullest: NDArray) -> None:
    """One palette, of the fullest picture: colours then stay the same from frame to frame."""
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
    # A pipe that breaks is ffmpeg giving up: its own words say why.
    with suppress(BrokenPipeError):
        for picture in pictures:
            if pipe is not None:
                pipe.write(picture.tobytes())
