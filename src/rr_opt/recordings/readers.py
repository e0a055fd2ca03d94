"""Any file of a recording, read by what it holds."""

from __future__ import annotations

from pathlib import Path

from rr_opt.experiment.count_scale import CountScale
from rr_opt.experiment.experiment import Noise
from rr_opt.experiment.recording import Recording
from rr_opt.recordings.c3d import markers_from_c3d
from rr_opt.recordings.kind import binary_kind, text_kind
from rr_opt.recordings.markers_file import MarkerData
from rr_opt.recordings.netcdf import read_netcdf
from rr_opt.recordings.plain_csv import recording_from_csv
from rr_opt.recordings.servo_log_csv import servo_log_from_csv
from rr_opt.recordings.servo_log_file import ServoLog
from rr_opt.recordings.text import decode, read_bytes
from rr_opt.recordings.trc import markers_from_trc
from rr_opt.recordings.vicon_csv import markers_from_vicon


def read_file(
    path: str | Path, noise: Noise | None = None, scale: CountScale | None = None
) -> Recording | MarkerData | ServoLog:
    """What a file holds: motion (plain CSV, netCDF), markers (Vicon CSV, C3D, TRC), a servo's log.

    noise: of motion that does not state its own; scale: of a servo's counts. Raises
    InvalidFileError with file, line and column of what is wrong, and InputError if an extra that
    the format needs is not installed.
    """
    path = Path(path)
    content = read_bytes(path)
    binary = binary_kind(content, str(path))
    if binary == "c3d":
        return markers_from_c3d(content, str(path), path.name)
    if binary == "netcdf":
        return read_netcdf(path, noise)
    text = decode(content, str(path))
    del content
    kind = text_kind(text)
    if kind == "trc":
        return markers_from_trc(text, path.name)
    if kind == "vicon":
        return markers_from_vicon(text, path.name)
    if kind == "servo":
        return servo_log_from_csv(text, path.name, scale)
    return recording_from_csv(text, path.name, noise)
