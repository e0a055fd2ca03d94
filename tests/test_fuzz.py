"""Whatever a file holds, a verb ends with 0 or 2, in time, with a message and never a traceback.

Files that are right are spoiled: pieces are put in, taken out, doubled and cut off. `make fuzz`
tries thousands of them, others each time; every day a few are tried, always the same.
"""

from __future__ import annotations

import gc
import os
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, seed, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from rr_opt.cli.main import app
from rr_opt.model.experiment import Recording
from rr_opt.recordings.readers import read_file
from tests.recordings.read.test_damaged import c3d
from tests.recordings.read.test_experiment import GAIT, HEAD, MARKERS, motion, plain, vicon

EXAMPLES = int(os.environ.get("FUZZ", "15"))
SEED = os.environ.get("SEED")
LONGEST = 20.0
"""s; a healthy run takes less than one."""


def fuzz(test):
    """Some examples, of a seed of one's own, or always the same."""
    quiet = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
    own = seed(SEED) if SEED else lambda one: one
    return own(
        settings(
            max_examples=EXAMPLES, deadline=None, derandomize=not SEED, database=None,
            suppress_health_check=quiet,
        )(test)
    )  # fmt: skip


STUDY = "problem: {gait: {period: 1 s}}\nvary: {limits.torque: [0.2, 0.3]}\n"
ROBOT = HEAD.split("noise")[0]
PROBLEM = ROBOT + "gait: {amplitude: [0.1, 1], period: 1 s}\nlimits: {rate: 30 rpm}\n"
EXPERIMENT = f"{HEAD}{MARKERS}recordings:\n- {{file: run.csv, {GAIT}}}\n"
YAML = {"experiment": EXPERIMENT, "problem": PROBLEM, "study": STUDY}
RECORDINGS = {"plain": plain(motion(400)).encode(), "vicon": vicon(motion(80)).encode()}
RECORDINGS["c3d"] = c3d()
WORDS = [
    *("0", "-1", "1e-6", "1e308", "1e-320", ".nan", ".inf", "nan", "inf", "5()", "9**9", "=1"),
    *("{}", "[]", "null", "true", "~", "&", "*", "!", "?", "|", ">", ":", "-", "#", "%", "'", '"'),
    *("30rpm", "1e9s", "/etc/passwd", "robot", "gait", "file", "rest", "holdout", "amplitude"),
]
PIECES = st.one_of(
    st.sampled_from([word.encode() for word in WORDS]),
    st.sampled_from([b"", b",", b";", b"\t", b"\n", b"\r", b" ", b"\n\n", b"\0", b"\xff", b", "]),
    st.binary(max_size=4),
)


@st.composite
def spoiled(draw, contents):
    """One of the contents with pieces put in, taken out, moved and cut off."""
    name = draw(st.sampled_from(sorted(contents)))
    given = contents[name]
    content = bytearray(given.encode() if isinstance(given, str) else given)
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(content)))
        length = draw(st.sampled_from([0, 0, 1, 4, 30]))
        kind = draw(st.integers(0, 5))
        piece = bytes(content[at : at + 40]) if kind == 0 else draw(PIECES)
        content[at : at + length] = piece
    if draw(st.integers(0, 4)) == 0:
        del content[draw(st.integers(0, len(content))) :]
    return name, bytes(content)


TIMES = st.sampled_from(["jitter", "close", "log", "random", "reverse", "huge", "twice", "tiny"])


def timed(kind: str, number: int) -> bytes:
    """A recording whose time stamps are odd."""
    rng = np.random.default_rng(number)
    moved = list(motion(300))
    t = moved[0].copy()
    moved[0] = {
        "jitter": t + rng.normal(0, 5e-3, len(t)),
        "close": np.where(rng.random(len(t)) < 0.1, np.roll(t, 1) + 1e-6, t),
        "log": np.geomspace(1e-9, 3, len(t)),
        "random": np.sort(rng.random(len(t))) ** 3,
        "reverse": t[::-1],
        "huge": np.where(rng.random(len(t)) < 0.05, 10.0 ** rng.integers(-320, 308), t),
        "twice": np.floor(t * 30) / 30,
        "tiny": t * 1e-9,
    }[kind]
    rows = np.column_stack(moved)
    return (
        "t,x,y,psi,phi\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows.tolist())
    ).encode()


def run(*arguments: object) -> None:
    """The verb ends as it should."""
    began = time.process_time()
    done = CliRunner().invoke(app, [str(one) for one in arguments])
    gc.collect()
    told = done.stdout + done.stderr
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    assert done.exit_code in (0, 2), told
    assert "Traceback" not in told
    assert done.exit_code == 0 or told.strip()
    assert time.process_time() - began < LONGEST


@pytest.fixture
def folder(tmp_path) -> Path:
    (tmp_path / "run.csv").write_bytes(RECORDINGS["plain"])
    return tmp_path


@fuzz
@given(given=spoiled(YAML))
def test_yaml(folder, given):
    name, content = given
    file = folder / f"{name}.yaml"
    file.write_bytes(content)
    run("lint", file)
    if name == "problem":
        run("simulate", file, "--seconds", "1", "--out", folder / "out")


@fuzz
@given(given=spoiled(RECORDINGS))
def test_recordings(folder, given):
    file = folder / "run.csv"
    file.write_bytes(given[1])
    (folder / "experiment.yaml").write_text(EXPERIMENT)
    run("inspect", file, "--no-figures", "--out", folder / "out")
    run("lint", folder)


@fuzz
@given(kind=TIMES, number=st.integers(0, 2**20))
def test_times(folder, kind, number):
    file = folder / "run.csv"
    file.write_bytes(timed(kind, number))
    (folder / "experiment.yaml").write_text(EXPERIMENT)
    run("inspect", file, "--no-figures", "--out", folder / "out")
    run("lint", folder)


@fuzz
@given(data=st.data())
def test_netcdf(folder, capfd, data):
    pytest.importorskip("h5netcdf")
    from rr_opt.recordings.readers.netcdf import write_netcdf

    if not (folder / "good.nc").exists():
        good = read_file(folder / "run.csv")
        assert isinstance(good, Recording)
        write_netcdf(folder / "good.nc", good)
    content = (folder / "good.nc").read_bytes()
    _, content = data.draw(spoiled({"netcdf": content}))
    (folder / "run.nc").write_bytes(content)
    run("inspect", folder / "run.nc", "--no-figures", "--out", folder / "out")
    assert "Traceback" not in capfd.readouterr().err
