"""Poses of two rigid bodies give P and both angles, from every format that has them.

The files are laid out by hand from the formats' descriptions, and bags are written by rosbags. The
motion has P and the angles by definition; the bodies sit askew on their platforms.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

from rr_opt.cli.main import app
from rr_opt.files.issue import InvalidFileError
from rr_opt.model.experiment import Layout, Noise
from rr_opt.recordings.experiment import experiment_of, read_experiment
from rr_opt.recordings.inspection import Circumstances, inspected
from rr_opt.recordings.readers import ReadOptions, ServoLog, read_file, ros_bag
from tests.recordings.read.test_experiment import motion

SPOTS = {"rear": (1, 0.12, 0.03, 0.4), "front": (2, -0.05, -0.02, -2.0)}
"""Platform, forward and left of P, m, and the turn of the body on its platform, rad."""
TILT = Rotation.from_euler("xyz", [0.05, -0.03, 0.0])
"""How the bodies' own axes were defined: nearly, not quite, upright."""
N = 300


def poses(moved=None, noise=(0.0, 0.0)):
    """By body: places (n, 3), m, and rotations, with z up; moved: x, y, psi, phi, (n,).

    noise: of each coordinate, m, and of each angle, rad
    """
    rng = np.random.default_rng(0)
    x, y, psi, phi = motion(N)[1:] if moved is None else moved
    n, found = len(x), {}
    for name, (platform, forward, left, turn) in SPOTS.items():
        heading = psi + (phi if platform == 2 else 0)
        at = x + 1j * y + (forward + 1j * left) * np.exp(1j * heading)
        places = np.stack([at.real, at.imag, np.full(n, 0.07)], 1)
        found[name] = (
            places + noise[0] * rng.normal(size=(n, 3)),
            Rotation.from_rotvec(noise[1] * rng.normal(size=(n, 3)))
            * Rotation.from_euler("z", (heading + turn)[:, None])
            * TILT,
        )
    return found


def rows(cells, separator=","):
    return "".join(separator.join(row) + "\n" for row in cells)


def vicon(title, kind, bodies=None):
    bodies = bodies or poses()
    turns = "RX,RY,RZ,RW" if kind == "quaternion" else "RX,RY,RZ"
    unit = {"quaternion": ",,,", "deg": "deg,deg,deg", "rad": "rad,rad,rad"}[kind]
    blank = "," * (turns.count(",") + 4)
    head = (
        f"{title}\n100\n,,{blank.join(f'{one}:{one}' for one in SPOTS)}{blank[1:]}\n"
        f"Frame,Sub Frame{f',{turns},TX,TY,TZ' * 2}\n,{f',{unit},mm,mm,mm' * 2}\n"
    )
    body = [[str(k + 1), "0"] for k in range(len(bodies["rear"][0]))]
    for places, turned in bodies.values():
        size = np.degrees(1) if kind == "deg" else 1.0
        r = turned.as_quat() if kind == "quaternion" else size * turned.as_rotvec()
        for k in range(len(places)):
            body[k] += [f"{v:.8f}" for v in (*r[k], *(1000 * places[k]))]
    return head + rows(body)


def motive(order="Quaternion"):
    """With y up: the floor's first axis is the capture's z, and the second its x."""
    cyclic = Rotation.from_matrix(np.eye(3)[[1, 2, 0]])
    count = 4 if order == "Quaternion" else 3
    width = count + 3
    names = [name for name in SPOTS for _ in range(width)]
    head = [
        f"Format Version,1.23,Capture Frame Rate,100.0,Rotation Type,{order},Length Units,Meters",
        "",
        ",," + ",".join(["Rigid Body"] * len(names)),
        ",," + ",".join(names),
        ",," + ",".join(["ID"] * len(names)),
        ",," + ",".join((["Rotation"] * count + ["Position"] * 3) * 2),
        "Frame,Time (Seconds)" + (",X,Y,Z,W"[: 2 * count] + ",X,Y,Z") * 2,
    ]
    body = [[str(k), f"{k / 100:.6f}"] for k in range(N)]
    for places, upright in poses().values():
        turned = cyclic * upright * cyclic.inv()
        r = turned.as_quat() if count == 4 else turned.as_euler(order, degrees=True)
        at = cyclic.apply(places)
        for k in range(N):
            body[k] += [f"{v:.9f}" for v in (*r[k], *at[k])]
    return "\n".join(head) + "\n" + rows(body)


def qualisys():
    names = "\t".join(SPOTS)
    each = [*"XYZ", "Roll", "Pitch", "Yaw", "Residual", *(f"Rot[{n}]" for n in range(9))]
    titles = "\t".join(f"{name} {one}" for name in SPOTS for one in each)
    head = (
        f"NO_OF_FRAMES\t{N}\nNO_OF_CAMERAS\t4\nNO_OF_BODIES\t2\nFREQUENCY\t100\nDESCRIPTION\t--\n"
        f"DATA_INCLUDED\t6D\nBODY_NAMES\t{names}\nFrame\tTime\t{titles}\n"
    )
    body = [[str(k + 1), f"{k / 100:.5f}"] for k in range(N)]
    for places, turned in poses().values():
        angles, matrix = turned.as_euler("xyz", degrees=True), turned.as_matrix()
        for k in range(N):
            by_column = matrix[k].T.ravel()
            values = (*(1000 * places[k]), *angles[k], 0.5, *by_column)
            body[k] += [f"{v:.5f}" for v in values]
    return head + rows(body, "\t")


def bag(folder, kind, *, late=0.0, joints=True, still=None):
    """Written by rosbags: `rear` as PoseStamped, `front` as TransformStamped, a JointState.

    still: when the transform of a camera was stamped, which is repeated
    """
    pytest.importorskip("rosbags")
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if kind == "bag" else Stores.ROS2_HUMBLE)
    types = store.types
    plugin = {"mcap": StoragePlugin.MCAP, "db3": StoragePlugin.SQLITE3}.get(kind)
    path = folder / ("run.bag" if kind == "bag" else "run")
    writer = Writer1(path) if kind == "bag" else Writer(path, version=8, storage_plugin=plugin)
    serialise = store.serialize_ros1 if kind == "bag" else store.serialize_cdr
    pose, transform, joint = (
        "geometry_msgs/msg/PoseStamped",
        "geometry_msgs/msg/TransformStamped",
        "sensor_msgs/msg/JointState",
    )

    def header(t):
        seconds, rest = divmod(17 * 10**17 + round(1e9 * t), 10**9)
        stamp = types["builtin_interfaces/msg/Time"](int(seconds), int(rest))
        number = (0,) if kind == "bag" else ()
        return types["std_msgs/msg/Header"](*number, stamp=stamp, frame_id="floor")

    with writer:
        ways = {}
        for topic, name in (("/rear", pose), ("/tf_front", transform), ("/servo", joint)):
            ways[topic] = writer.add_connection(topic, name, typestore=store)
        vector, point, quaternion = (
            types[f"geometry_msgs/msg/{one}"] for one in ("Vector3", "Point", "Quaternion")
        )
        for now in (1, 10**9 + 1) if still is not None else ():
            made = types["geometry_msgs/msg/Transform"](vector(0, 0, 2), quaternion(0, 0, 0, 1))
            made = types[transform](header(still), "camera", made)
            writer.write(ways["/tf_front"], now, serialise(made, transform))
        for k in range(N):
            t, now = k / 100, 10**9 + k * 10**7
            (at, turned), (at2, turned2) = (
                ((places[k], turns[k].as_quat()) for places, turns in poses().values())
                if k == -1
                else FRAMES[k]
            )
            one = types["geometry_msgs/msg/Pose"](point(*at), quaternion(*turned))
            made = types[pose](header(t), one)
            writer.write(ways["/rear"], now, serialise(made, pose))
            two = types["geometry_msgs/msg/Transform"](vector(*at2), quaternion(*turned2))
            made = types[transform](header(t + late), "front", two)
            writer.write(ways["/tf_front"], now, serialise(made, transform))
            if joints:
                angle, nothing = np.array([motion(N)[4][k]]), np.array([])
                made = types[joint](header(t), ["hinge"], angle, nothing, nothing)
                writer.write(ways["/servo"], now, serialise(made, joint))
    return path if kind == "bag" else next(path.glob(f"*.{kind}"))


FRAMES = list(
    zip(*(zip(places, turns.as_quat(), strict=True) for places, turns in poses().values()),
        strict=True)
)  # fmt: skip


def check(found, atol=2e-4):
    """P is where it was, and so are the angles, but for the order of the platforms."""
    read, (t, x, y, psi, phi) = found.recording, motion(N)
    np.testing.assert_allclose(read.t - read.t[0], t, atol=1e-6)
    np.testing.assert_allclose(read.values["x"], x, atol=atol)
    np.testing.assert_allclose(read.values["y"], y, atol=atol)
    for name, true in (("psi", psi), ("phi", phi)):
        apart = read.values[name] - true
        assert np.ptp(apart) < 10 * atol
    assert "P is known to" in " ".join(found.doubts)


TEXTS = {
    "Tracker": lambda: vicon("Objects", "rad"),
    "Nexus": lambda: vicon("Segments", "deg"),
    "quaternions": lambda: vicon("Objects", "quaternion"),
    "Motive": motive,
    "Motive, Euler": lambda: motive("XYZ"),
    "Qualisys": qualisys,
}


@pytest.mark.parametrize("name", TEXTS)
def test_texts(write, name):
    check(inspected(write(TEXTS[name]()), Circumstances()))


def test_a_body_is_named_once(write):
    found = called("inspect", str(write(qualisys(), "theirs.tsv")))
    told = " ".join(found.output.split())
    assert "bodies 2 on two rigid platforms" in told
    assert "one platform carries rear, the other front;" in told


@pytest.mark.parametrize("kind", ["bag", "mcap", "db3"])
def test_bags(tmp_path, kind):
    path = bag(tmp_path, kind)
    check(inspected(path, Circumstances()))
    log = read_file(path, ReadOptions(log=True))
    assert isinstance(log, ServoLog)
    np.testing.assert_allclose(log.present_angle, motion(N)[4])


@pytest.mark.parametrize("kind", ["mcap", "db3"])
def test_a_bag_is_its_folder(tmp_path, kind):
    path = bag(tmp_path, kind)
    done = called("inspect", str(path.parent), "--servo-log", str(path.parent))
    assert done.exit_code == 0, done.output
    assert "format      ROS bag" in done.stdout
    entry = f"{{file: {path.parent.name}, servo_log: {path.parent.name}, {GAIT}}}"
    text = f"{ROBOT}noise: {{position: 1 mm, angle: 3 mrad}}\nrecordings:\n- {entry}\n"
    (tmp_path / "experiment.yaml").write_text(text)
    experiment, issues = experiment_of(tmp_path)
    assert experiment is not None, issues


def test_bodies_that_are_stamped_apart_are_put_on_one_clock(tmp_path):
    path = bag(tmp_path, "mcap", late=0.004)
    read = read_file(path)
    assert read.doubts == (
        "Not time-stamped together with the body with most poses, so put on its times: 'front'.",
    )
    here, there = (read.positions[1:-1, read.labels.index(one)] for one in ("rear", "front"))
    np.testing.assert_allclose(here, poses()["rear"][0][1:-1], atol=1e-9)
    # 4 ms of 10 were added to its stamps.
    true = poses()["front"][0]
    np.testing.assert_allclose(there, (0.6 * true[1:] + 0.4 * true[:-1])[:-1], atol=1e-9)


@pytest.mark.parametrize("still", [-17e8, -3600, 0])
def test_a_frame_that_is_fixed_to_another_is_no_body(tmp_path, still):
    found = inspected(bag(tmp_path, "mcap", still=still), Circumstances())
    check(found)
    assert "Not read, as they have a single time stamp: 'camera'." in found.doubts


def test_the_times_are_those_of_the_body_with_most_poses(tmp_path, monkeypatch):
    path = bag(tmp_path, "mcap")
    poses, joints = ros_bag._messages(path)
    poses["rear"] = poses["rear"][::3]
    monkeypatch.setattr(ros_bag, "_messages", lambda _: (poses, joints))
    read = read_file(path)
    np.testing.assert_allclose(read.t, np.arange(N) / 100, atol=1e-9)
    assert "'rear'" in read.doubts[-1]


def test_the_rotation_matrix_of_qualisys_is_stored_by_columns(write):
    """A row of a public recording (shiplab/dt_cv, M510A): its yaw is in its matrix."""
    row = (
        "-194.91974\t2.24150\t0.99661\t-0.65630\t0.09391\t0.05772\t4.98536\t1.00000\t0.00099\t"
        "-0.00165\t-0.00101\t0.99993\t-0.01145\t0.00164\t0.01145\t0.99993"
    )
    head = qualisys().split("\n1\t", 1)[0].replace(f"\t{N}", "\t2")
    read = read_file(write(f"{head}\n1\t0.0\t{row}\t{row}\n2\t0.01\t{row}\t{row}\n"))
    ahead = read.positions[0, 1] - read.positions[0, 0]
    assert np.degrees(np.arctan2(ahead[1], ahead[0])) == pytest.approx(0.05772, abs=2e-3)


def test_a_layout_says_where_the_bodies_are_and_the_stated_noise_is_theirs(write):
    places = ({}, {})
    for name, (platform, forward, left, turn) in SPOTS.items():
        axes = (Rotation.from_euler("z", turn) * TILT).as_matrix()
        for label, axis in ((name, None), (f"{name} x", 0), (f"{name} y", 1)):
            ahead = 0 if axis is None else np.exp(1j * np.arctan2(axes[1, axis], axes[0, axis]))
            at = forward + 1j * left + 0.1 * ahead
            places[platform - 1][label] = (at.real, at.imag)
    known = Circumstances(layout=Layout(*places), options=ReadOptions(Noise(1e-3, 4e-3)))
    found = inspected(write(vicon("Objects", "rad")), known)
    for name, true in zip(("x", "y", "psi", "phi"), motion(N)[1:], strict=True):
        np.testing.assert_allclose(found.recording.values[name], true, atol=1e-4)
    assert 0.7e-3 < np.median(found.recording.sigma["x"]) < 1e-3  # of two bodies
    assert 5e-3 < np.median(found.recording.sigma["phi"]) < 4e-3 * np.sqrt(2)


ROBOT = """robot:
  platform1: {m: 0.5, I: 0.004, c: 0.206, a: 0.02, b: 0.05, kappa: 2.0e-5}
  platform2: {m: 0.3, I: 0.002, c: 0.0641, a: 0.02, b: 0.05, kappa: 2.0e-5}
  h: 0.02
  servo: {angle_limit: 1.5, rate_limit: 30 rpm, torque_limit: 1.4}
"""
GAIT = "gait: {amplitude: 0.5, period: 1 s, offset: 0.1}"


@pytest.mark.parametrize("name", ["Nexus", "Motive", "Qualisys", "mcap"])
def test_an_experiment_learns_from_its_recordings_where_the_bodies_are(write, tmp_path, name):
    files = []
    for stem in ("one", "two"):
        folder = tmp_path / stem
        folder.mkdir()
        file = bag(folder, name) if name == "mcap" else write(TEXTS[name](), f"{stem}.txt")
        files.append(file.relative_to(tmp_path))
    one, two = files
    recordings = f"- {{file: {one}, {GAIT}}}\n- {{file: {two}, {GAIT}, use: holdout}}\n"
    text = f"{ROBOT}noise: {{position: 1 mm, angle: 3 mrad}}\nrecordings:\n{recordings}"
    write(text, "experiment.yaml")
    experiment, issues = experiment_of(tmp_path)
    assert experiment is not None
    for run in experiment.runs:
        for channel, true in zip(("x", "y", "psi", "phi"), motion(N)[1:], strict=True):
            np.testing.assert_allclose(run.recording.values[channel], true, atol=2e-3)
    learnt = [issue.message for issue in issues if "was estimated" in issue.message]
    assert len(learnt) == 1
    assert "platform 1 carries rear," in learnt[0]
    assert experiment.uncertainty["psi_zero"].sigma > 0.05
    stated = text.replace("noise:", "uncertainty: {psi_zero: 2 mrad}\nnoise:")
    write(stated, "experiment.yaml")
    assert read_experiment(tmp_path).uncertainty["psi_zero"].sigma == pytest.approx(2e-3)


def test_segments_of_two_bodies_are_linted_inspected_and_diagnosed(tmp_path):
    """The laboratory drives, and what an experiment's file says of P is nothing."""
    runs = ("0.3, 1 s, 0, rest", "0.6, 1.2 s, 10 deg", "0.4, 0.9 s, 5 deg, holdout")
    gaits = [word for run in runs for word in ("--gait", run)]
    place, noise = tmp_path / "lab", (5e-4, 2e-3)
    least = ("--noise", "0.1 um, 0.1 urad", "--seconds", "6", "--engine", "planar")
    assert called("record", *gaits, *least, "--out", str(place)).exit_code == 0
    for file in place.glob("run*.csv"):
        moved = np.loadtxt(file, delimiter=",", skiprows=1).T[1:5]
        file.write_text(vicon("Segments", "rad", poses(moved, noise)))
    text = (place / "experiment.yaml").read_text()
    stated = re.sub(r"noise: .*", "noise: {position: 0.5 mm, angle: 2 mrad}", text)
    exact = re.sub(r'"c1": [^,]*', '"c1": 0', stated)
    (place / "experiment.yaml").write_text(exact)
    for verb in ("lint", "inspect", "diagnose"):
        out = () if verb == "lint" else ("--out", str(tmp_path / verb))
        found = called(verb, str(place), *out)
        assert found.exit_code == 0, found.output
        assert "P is known to" in " ".join(found.output.split()), found.output
    assert "consistent: The model explains the recordings" in found.output
    corrected = called("lint", str(tmp_path / "diagnose" / "robot-corrected.yaml"))
    assert corrected.exit_code == 0, corrected.output  # the zeros are the capture's
    uncertainty = read_experiment(place).uncertainty
    assert 1e-6 < uncertainty["c1"].sigma < 1e-3  # as well as P is known
    assert 2e-3 < uncertainty["c2"].sigma < 2.1e-3


def called(*words):
    return CliRunner().invoke(app, words)


def test_one_body_alone_and_a_bag_without_poses_are_refused(write, tmp_path):
    text = qualisys().replace("BODY_NAMES\trear\tfront", "BODY_NAMES\trear")
    cut = [line if "\t" not in line or line[0].isalpha() else "\t".join(line.split("\t")[:18])
           for line in text.splitlines()]  # fmt: skip
    with pytest.raises(InvalidFileError, match=r"Read the rigid body 'rear'\. Expected two"):
        read_file(write("\n".join(cut) + "\n"))
    for kind in ("mcap", "bag"):
        path = bag(tmp_path, kind)
        content = path.read_bytes()
        path.write_bytes(content[: len(content) // 2])
        with pytest.raises(InvalidFileError, match="The bag cannot be read"):
            read_file(path)
    assert isinstance(path, Path)
