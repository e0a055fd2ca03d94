"""Folders that are right: every kind of input file and every format of recordings, small."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from types import MappingProxyType

import numpy as np

import rr_opt as rr
from rr_lab.formats import MarkerData, c3d_bytes
from rr_opt.api.files import Kind
from rr_opt.files.source import SHIPPED
from rr_opt.model.experiment import Recording
from rr_opt.recordings.readers import MarkerData as Markers
from rr_opt.recordings.readers import read_file
from tests.recordings.read import test_bodies
from tests.recordings.read.test_experiment import GAIT, HEAD, MARKERS, PLACES, motion, plain, vicon

Verb = tuple[str, ...]

LONG = {"maximize-speed", "study", "diagnose", "route"}
"""Verbs that compute for long where the input is right."""


@dataclass(frozen=True)
class Input:
    """A folder that is right, and what is tried on it once one of its files is spoiled.

    files   contents by name
    spoilt  the name of the file that is spoiled
    verbs   arguments of the command in that folder, the most telling check first
    """

    files: dict[str, bytes]
    spoilt: str
    verbs: tuple[Verb, ...]


ROBOT = (SHIPPED / "robot.yaml").read_text()
PROBLEM = HEAD.split("noise")[0] + (
    "gait: {shape: sine, amplitude: [0.1, 1], period: [1 s, 2 s], offset: 0.1}\n"
    "inertia_ratio: {bounds: [0.12, 0.6], about: joint, by: inertia}\n"
    "limits: {angle: 2.6, rate: 30 rpm, torque: 1.37, singularity: 20 mm}\ndirection: either\n"
)
STUDY = (
    "problem: problem.yaml\nvary:\n  limits.rate: {from: 10 rpm, to: 60 rpm, count: 3}\n"
    "  robot.platform2.m: [250 g, 0.3]\ntogether:\n"
    "  - {limits.torque: [1 N*m, 0.9], limits.angle: [2.6, 100 deg]}\n"
)
EXPERIMENT = (
    f"{HEAD}uncertainty: {{m: 1 %, c: 2 mm, kappa: unknown, psi_zero: 1 deg}}\n"
    f"columns: {{psi: heading, t: time}}\nrecordings:\n"
    f"- {{file: run.csv, {GAIT}, use: fit, start: running, servo_log: log.csv}}\n"
    f"- {{file: other.csv, {GAIT}, use: holdout}}\n"
)
LOG = "t,goal,present\n" + "".join(
    f"{7 + k / 125:.4f},{512 + 98 * np.sin(2 * np.pi * k / 125):.0f},{500 + k % 9}\n"
    for k in range(300)
)


def _experiment(file: str, more: str = "") -> bytes:
    return f"{HEAD}{more}recordings:\n- {{file: {file}, {GAIT}}}\n".encode()


def _recording(file: str, content: bytes | str, more: str = "", *flags: str) -> Input:
    content = content.encode() if isinstance(content, str) else content
    files = {file: content, "experiment.yaml": _experiment(file, more)}
    verbs = (
        ("lint", "."), ("inspect", file, "--no-figures", "--out", "out", *flags),
        ("diagnose", ".", "--no-page", "--out", "found"),
    )  # fmt: skip
    return Input(files, file, verbs)


def _bodies(file: str, content: bytes, more: Mapping[str, bytes] = MappingProxyType({})) -> Input:
    """A recording of rigid bodies, with where their points are on the platforms."""
    _, x, y, psi, phi = motion(test_bodies.N)
    with TemporaryDirectory() as folder:
        path = Path(folder) / file
        path.write_bytes(content)
        for name, other in more.items():
            path.with_name(name).write_bytes(other)
        read = read_file(path)
    assert isinstance(read, Markers)
    first, second = [2, 0] if read.up == "y" else [0, 1]
    lines: dict[int, list[str]] = {1: [], 2: []}
    for label, place in zip(read.labels, read.positions[0], strict=True):
        platform = test_bodies.SPOTS[label.split()[0]][0]
        heading = psi[0] + (phi[0] if platform == 2 else 0)
        at = (place[first] + 1j * place[second] - x[0] - 1j * y[0]) * np.exp(-1j * heading)
        lines[platform].append(f"{label}: [{at.real:.5f}, {at.imag:.5f}]")
    text = "".join(f"  platform{n}: {{{', '.join(each)}}}\n" for n, each in lines.items())
    made = _recording(file, content, f"markers:\n  up: {read.up}\n{text}")
    return replace(made, files={**made.files, **more})


@functools.cache
def inputs() -> dict[str, Input]:
    """By name."""
    run = plain(motion(400)).encode()
    places = MARKERS.split("\n", 1)[1].replace("\n  ", "\n").strip()
    gaits = tuple(
        (verb, "file.yaml", *more)
        for verb, *more in (
            ("simulate", "--seconds", "1", "--out", "out"),
            ("circle",),
            ("maximize-speed", "--no-figures", "--out", "found"),
        )
    )
    found = {
        "robot": Input({"file.yaml": ROBOT.encode()}, "file.yaml", (("lint", "file.yaml"), *gaits)),
        "problem": Input(
            {"file.yaml": PROBLEM.encode()}, "file.yaml", (("lint", "file.yaml"), *gaits)
        ),
        "study": Input(
            {"file.yaml": STUDY.encode(), "problem.yaml": PROBLEM.encode()},
            "file.yaml",
            (("lint", "file.yaml"), ("study", "file.yaml", "--no-figures", "--out", "found")),
        ),
        "experiment": Input(
            {
                "experiment.yaml": EXPERIMENT.encode(),
                "run.csv": run.replace(b"psi", b"heading"),
                "other.csv": plain(motion(400), noise=1.1).encode(),
                "log.csv": LOG.encode(),
            },
            "experiment.yaml",
            (
                ("lint", "."),
                ("inspect", ".", "--no-figures", "--out", "out"),
                ("diagnose", ".", "--no-page", "--out", "found"),
            ),
        ),
        "layout": Input(
            {"layout.yaml": places.encode(), "run.csv": vicon(motion(80)).encode()},
            "layout.yaml",
            (("inspect", "run.csv", "--layout", "layout.yaml", "--no-figures", "--out", "out"),),
        ),
        "log": Input(
            {"log.csv": LOG.encode(), "run.csv": run},
            "log.csv",
            (("inspect", "run.csv", "--servo-log", "log.csv", "--no-figures", "--out", "out"),),
        ),
        "result": Input(
            {"result.json": _result()},
            "result.json",
            (
                ("simulate", "result.json", "--seconds", "1", "--out", "out"),
                ("export", "result.json", "--out", "points.csv"),
            ),
        ),
    }
    found |= dict(_written())
    found |= dict(_machines())
    found["plain"] = _recording("run.csv", run)
    found["vicon"] = _recording("run.csv", vicon(motion(220)), MARKERS)
    seen = _seen()
    found["trc"] = _recording("run.trc", _trc(seen), MARKERS)
    found["motive"] = _recording("run.csv", _motive(seen), MARKERS)
    found["qualisys"] = _recording("run.tsv", _qualisys(seen), MARKERS)
    if find_spec("ezc3d"):
        found["c3d"] = _recording("run.c3d", c3d_bytes(seen), MARKERS)
    for name, text in test_bodies.TEXTS.items():
        ending = "tsv" if "Qualisys" in name else "csv"
        found[f"bodies of {name}"] = _bodies(f"run.{ending}", text().encode())
    found |= dict(_binary(run))
    return found


def _written() -> Iterator[tuple[str, Input]]:
    """What `rr-opt init` writes, with all its comments."""
    after: dict[Kind, tuple[Verb, ...]] = {
        "robot": (("circle", "file.yaml"),),
        "problem": (("maximize-speed", "file.yaml", "--no-figures", "--out", "found"),),
        "study": (("study", "file.yaml", "--no-figures", "--out", "found"),),
        "route": (("route", "file.yaml", "--no-figures", "--out", "found"),),
    }
    with TemporaryDirectory() as folder:
        for kind, verbs in after.items():
            place = Path(folder) / f"{kind}.yaml"
            rr.init(kind, place)
            files = {"file.yaml": place.read_bytes()}
            yield f"init {kind}", Input(files, "file.yaml", (("lint", "file.yaml"), *verbs))


def _machines() -> Iterator[tuple[str, Input]]:
    """Folders of other machines: the experiment file is spoiled, or a recording."""
    t = np.arange(0, 3, 0.01)
    wave, q = np.sin(2 * t), 0.3 * np.sin(2 * t - 0.4)
    tables = {
        "pendulum": {"time": t, "angle": np.degrees(q), "motor": wave},
        "servo": {"timestamp": t, "position": q, "goal_position": wave, "load": np.round(9 * wave)},
        "car": {"time": t, "x": 0.5 * t, "y": q, "psi": q, "speed": 0.5 + 0.1 * wave,
                "turn": np.sign(wave)},
    }  # fmt: skip
    noise = 1e-4 * np.sin(np.arange(t.size) ** 2)[:, None]
    for machine, columns in tables.items():
        values = np.column_stack(tuple(columns.values()))
        written, ending = (_entries, "json") if machine == "servo" else (_table, "csv")
        files = {
            f"{name}.{ending}": written(columns, (values + sign * noise).round(6)).encode()
            for name, sign in (("run", 1), ("other", -1))
        }
        text = (
            f"machine: {machine}\n{MACHINES[machine]}recordings:\n  - {{file: run.{ending}}}\n"
            f"  - {{file: other.{ending}, use: holdout}}\n"
        )
        files["experiment.yaml"] = text.encode()
        verbs = (("lint", "."), ("diagnose", ".", "--no-page", "--out", "found"))
        yield machine, Input(files, "experiment.yaml", verbs)
        yield f"{machine}, data", Input(files, f"run.{ending}", verbs)


def _table(columns: Iterable[str], values: np.ndarray) -> str:
    lines = (",".join(map(str, row)) for row in values.tolist())
    return "\n".join([",".join(columns), *lines, ""])


def _entries(columns: Iterable[str], values: np.ndarray) -> str:
    entries = [dict(zip(columns, row, strict=True)) for row in values.tolist()]
    return json.dumps({"mass": 0.5, "length": 0.1, "kp": 100, "entries": entries})


MACHINES = {
    "pendulum": "parameters: {J: 0.05, ml: 0.1, b: 0.02}\nuncertainty: {J: 5 %, ml: unknown}\n"
    "noise: {q: 0.2 deg}\ncolumns: {t: time, q: {column: angle, factor: 1 deg}, u: motor}\n",
    "servo": "parameters: {kt: 0.4, R: 4, armature: 0.002, b: 0.004, fc: 0.013}\n"
    "columns: {t: timestamp, q: position, goal: goal_position, volts: 7.4, kp: kp, m: mass, "
    "l: length}\n",
    "car": "parameters: {L: 0.1735, mf: 847 g, mr: 0.733, gain: 0.35, zero: 0, ahead: 115 mm, "
    "left: -0.01}\ncolumns: {t: time, x: x, y: y, psi: psi, vx: speed, steering: turn}\n",
}


def _seen() -> MarkerData:
    """The markers of the layout."""
    _, x, y, psi, phi = motion(220)
    spots = []
    for platform, forward, left in PLACES.values():
        turn = psi + (phi if platform == 2 else 0)
        at = x + 1j * y + (forward + 1j * left) * np.exp(1j * turn)
        spots.append(np.stack([at.real, at.imag, np.full(len(x), 0.05)], axis=1))
    return MarkerData(tuple(PLACES), np.stack(spots, axis=1), 100.0)


def _rows(seen: MarkerData, mark: str, factor: float, first: int) -> str:
    rows = factor * seen.positions.reshape(len(seen.positions), -1)
    return "".join(
        mark.join((str(k + first), f"{k / 100:.2f}", *(f"{value:.5f}" for value in row))) + "\n"
        for k, row in enumerate(rows)
    )


def _trc(seen: MarkerData) -> str:
    n, k = seen.positions.shape[:2]
    axes = "\t".join(f"{axis}{m + 1}" for m in range(k) for axis in "XYZ")
    return (
        "PathFileType\t4\t(X/Y/Z)\ttrial.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
        f"100.00\t100.00\t{n}\t{k}\tmm\n"
        "Frame#\tTime\t" + "\t\t\t".join(seen.labels) + f"\t\t\n\t\t{axes}\n\n"
    ) + _rows(seen, "\t", 1e3, 1)


def _qualisys(seen: MarkerData) -> str:
    n, k = seen.positions.shape[:2]
    names = "\t".join(f"{label} {axis}" for label in seen.labels for axis in "XYZ")
    return (
        f"NO_OF_FRAMES\t{n}\nNO_OF_MARKERS\t{k}\nFREQUENCY\t100\nDATA_INCLUDED\t3D\n"
        "MARKER_NAMES\t" + "\t".join(seen.labels) + f"\nFrame\tTime\t{names}\n"
    ) + _rows(seen, "\t", 1e3, 1)


def _motive(seen: MarkerData) -> str:
    each = [label for label in seen.labels for _ in range(3)]
    head = ("Marker",) * len(each), each, ("1",) * len(each), ("Position",) * len(each)
    return (
        "Format Version,1.23,Capture Frame Rate,100,Length Units,Meters\n\n"
        + "".join(f",,{','.join(row)}\n" for row in head)
        + "Frame,Time (Seconds)"
        + ",X,Y,Z" * len(seen.labels)
        + "\n"
    ) + _rows(seen, ",", 1.0, 0)


def _result() -> bytes:
    with TemporaryDirectory() as folder:
        rr.maximize_speed(SHIPPED / "problem.yaml").save(Path(folder), figures=False)
        return (Path(folder) / "result.json").read_bytes()


def _binary(run: bytes) -> Iterator[tuple[str, Input]]:
    """Formats that need an extra, where it is installed."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        if find_spec("h5netcdf"):
            from rr_opt.recordings.readers.netcdf import write_netcdf

            (folder / "run.csv").write_bytes(run)
            good = read_file(folder / "run.csv")
            assert isinstance(good, Recording)
            write_netcdf(folder / "run.nc", good)
            yield "netcdf", _recording("run.nc", (folder / "run.nc").read_bytes())
        if find_spec("rosbags"):
            for kind in ("bag", "mcap", "db3"):
                path = test_bodies.bag(folder / kind if kind != "bag" else folder, kind)
                beside = path.with_name("metadata.yaml")
                more = {beside.name: beside.read_bytes()} if beside.exists() else {}
                given = _bodies(path.name, path.read_bytes(), more)
                yield kind, given
                if kind == "mcap":
                    yield "metadata", replace(given, spoilt=beside.name)
