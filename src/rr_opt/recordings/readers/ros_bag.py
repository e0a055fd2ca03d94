"""ROS bags: poses of two bodies from ROS 1 (.bag) and ROS 2 (.mcap, .db3), and joint states.

Of a ROS 2 bag its folder is named, or a file in it, beside `metadata.yaml`. Poses are
`PoseStamped` (a body is a topic), `TransformStamped` and `TFMessage` (a body is a child frame), by
the stamps in their headers. Those with a single stamp are not read. Bodies that were not stamped
together are put on the times of the one with most poses by a straight line and the shortest turn
between the two poses about each; what has no pose within one and a half steps stays missing. A
`JointState` is the servo's own log.
"""

from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.outcome import InputError
from rr_opt.recordings.readers.marker_rows import MarkerData, marker_data, matrices
from rr_opt.recordings.readers.plain_csv import ServoLog
from rr_opt.recordings.readers.text import Reader, ReadOptions
from rr_opt.recordings.time_axis import LACKING, in_order, rate_of, time_step
from rr_opt.recordings.warnings import Notice, notice

_STARTS = (b"#ROSBAG V2.0", b"\x89MCAP0\r\n", b"SQLite format 3\x00")
_MOST = 5_000_000
"""Most messages that are read."""


def sniff(content: bytes) -> bool:
    """Whether a file begins as those of ROS bags do."""
    return content.startswith(_STARTS)


def read(file: str, _: bytes, options: ReadOptions) -> MarkerData | ServoLog:
    """The poses of a bag; as a servo's log, or without poses, the angle of its first joint.

    Raises InvalidFileError.
    """
    poses, joints = _messages(Path(file))
    if poses and not (options.log and joints):
        return _poses(file, poses)
    if joints:
        return _log(file, joints)
    refuse(
        file,
        "Read a bag without poses and joint states. Expected PoseStamped, TransformStamped, "
        "TFMessage or JointState. Record their topics too.",
    )


def _messages(path: Path) -> tuple[dict[str, list[Any]], dict[str, list[Any]]]:
    """Rows of stamp, ns, place and quaternion by body; of stamp and position by joint."""
    try:
        from rosbags.highlevel import AnyReader
        from rosbags.typesys import Stores, get_typestore
    except ImportError:
        raise InputError(
            "ROS bags need rosbags, which is not installed. Run `pip install 'rr-opt[ros]'`, or "
            "use CSV."
        ) from None
    bag = path if path.read_bytes().startswith(_STARTS[0]) else path.absolute().parent
    poses: dict[str, list[Any]] = {}
    joints: dict[str, list[Any]] = {}
    try:
        with AnyReader([bag], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            for number, (connection, _, raw) in enumerate(reader.messages()):
                kind = connection.msgtype.rpartition("/")[2]
                if number >= _MOST or kind not in _KINDS:
                    continue
                message: Any = reader.deserialize(raw, connection.msgtype)
                for one in message.transforms if kind == "TFMessage" else [message]:
                    stamp = one.header.stamp
                    t = stamp.sec * 10**9 + stamp.nanosec
                    if kind == "JointState":
                        for name, angle in zip(one.name, one.position, strict=False):
                            joints.setdefault(name, []).append((t, float(angle)))
                        continue
                    posed = kind == "PoseStamped"
                    name = connection.topic if posed else one.child_frame_id
                    part = one.pose if posed else one.transform
                    at, turn = (
                        (part.position, part.orientation)
                        if posed
                        else (part.translation, part.rotation)
                    )
                    row = (t, at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w)
                    poses.setdefault(name.strip("/"), []).append(row)
    except Exception as error:
        # Any error that a damaged bag causes in the library.
        why = str(error).splitlines()[0] if str(error) else type(error).__name__
        refuse(
            str(path),
            f"The bag cannot be read: {why}. Expected a ROS 1 bag, or a file of a ROS 2 bag beside "
            "its metadata.yaml. Name that file, or record it again.",
        )
    return poses, joints


_KINDS = ("PoseStamped", "TransformStamped", "TFMessage", "JointState")


def _ordered(rows: list[Any], start: int) -> tuple[Array, Array, tuple[Notice, ...]]:
    """Times from the start, ns, in s, and the values of rows, in order."""
    # A float does not hold the nanoseconds since 1970.
    t = 1e-9 * np.array([row[0] - start for row in rows], float)
    values = np.array([row[1:] for row in rows], float)
    order = in_order(t, values, np.arange(1, len(t) + 1))
    return t[order.rows], values[order.rows], order.doubts


def _poses(file: str, poses: dict[str, list[Any]]) -> MarkerData:
    # A frame that is fixed to another one is published once, at any time.
    still = [name for name, rows in poses.items() if len({row[0] for row in rows}) < 2]
    moving = {name: rows for name, rows in poses.items() if name not in still}
    if not moving:
        refuse(file, "Read fewer than two poses of a body. Expected a recording. Record it again.")
    start = min(row[0] for rows in moving.values() for row in rows)
    bodies = {name: _ordered(rows, start) for name, rows in moving.items()}
    t, _, doubts = max(bodies.values(), key=lambda body: len(body[0]))
    if still:
        doubts = (*doubts, notice("bodies.still", names=shown(", ".join(still))))
    positions, rotations, moved = [], [], []
    for name, (own, values, _) in bodies.items():
        pose = values[:, :3], matrices(values[:, None, 3:], "quaternion")[:, 0]
        if not np.array_equal(own, t):
            pose = _at(t, own, *pose)
            moved.append(name)
        positions.append(pose[0])
        rotations.append(pose[1])
    if moved:
        doubts = (*doubts, notice("bodies.apart", names=shown(", ".join(moved))))
    frame = np.arange(1, len(t) + 1)
    return marker_data(
        {"file": file, "format": READER.format},
        labels=list(bodies),
        positions=np.stack(positions, 1),
        rotations=np.stack(rotations, 1),
        unit="m",
        unit_place=("the bag", None),
        frame=frame,
        lines=frame,
        t=t,
        rate=rate_of(t, file),
        doubts=doubts,
    )


def _at(t: Array, own: Array, at: Array, turned: Array) -> tuple[Array, Array]:
    """Places and rotations at t (n,), of those at `own` (m,); NaN where none is near."""
    from scipy.spatial.transform import Rotation, Slerp

    known = np.isfinite(turned).all(axis=(1, 2))
    own, at, turned = own[known], at[known], turned[known]
    places, rotations = np.full((len(t), 3), np.nan), np.full((len(t), 3, 3), np.nan)
    if len(own) < 2:
        return places, rotations
    after = np.clip(np.searchsorted(own, t), 1, len(own) - 1)
    near = (t >= own[0]) & (t <= own[-1])
    near &= own[after] - own[after - 1] <= LACKING * time_step(own)
    for axis in range(3):
        places[near, axis] = np.interp(t[near], own, at[:, axis])
    if near.any():
        rotations[near] = Slerp(own, Rotation.from_matrix(turned))(t[near]).as_matrix()
    return places, rotations


def _log(file: str, joints: dict[str, list[Any]]) -> ServoLog:
    name, rows = next(iter(joints.items()))
    t, values, doubts = _ordered(rows, min(row[0] for row in rows))
    angle = values[:, 0]
    rate = rate_of(t, file)
    others = list(joints)[1:]
    if others:
        doubts = (*doubts, notice("file.variables", names=shown(", ".join(others))))
    steps = np.diff(np.unique(np.round(angle[np.isfinite(angle)], 9)))
    source = {"file": file, "format": READER.format, "joint": name, "clock": "t = 0 at its start"}
    return ServoLog(
        Path(file).name, t, None, None, None, angle,
        float(np.median(steps)) if len(steps) else 1e-6, rate, MappingProxyType(source), doubts,
    )  # fmt: skip


READER = Reader("ROS bag", sniff, read, binary=True)
