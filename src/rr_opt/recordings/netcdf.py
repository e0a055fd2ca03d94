"""A recording in a netCDF file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rr_opt.experiment.experiment import Noise
from rr_opt.experiment.recording import Recording
from rr_opt.outcome import InputError
from rr_opt.recordings.dataset import from_dataset, gait_of, library, to_dataset
from rr_opt.recordings.refusal import refuse
from rr_opt.robot.gait import Gait

SIGNATURE = b"\x89HDF\r\n\x1a\n"
"""How every netCDF 4 file begins, which is HDF 5."""


def is_netcdf(path: Path) -> bool:
    """Whether a file that is there begins as netCDF 4 does."""
    with path.open("rb") as file:
        return file.read(len(SIGNATURE)) == SIGNATURE


def write_netcdf(path: Path, recording: Recording, gait: Gait | None = None) -> Path:
    """Write the recording, and the gait that was commanded where it is known, as netCDF 4.

    The file is written in place: a caller that must not leave half a file writes beside it and
    renames. Raises InputError if an extra is missing.
    """
    data = to_dataset(recording, gait)
    # NaN is itself, and no number stands for it.
    plain = {name: {"_FillValue": None} for name in data.variables}
    data.to_netcdf(path, engine="h5netcdf", encoding=plain)
    return path


def read_netcdf(path: Path, noise: Noise | None = None) -> Recording:
    """The recording of a netCDF file, whoever wrote it; noise: where the file states none.

    Raises InvalidFileError if it cannot be read, InputError if it holds no recording or an extra
    is missing.
    """
    return from_dataset(_opened(path), str(path), noise)


def commanded_gait(path: Path) -> Gait | None:
    """The gait that a netCDF file says was commanded, if it says. Raises as `read_netcdf`."""
    return gait_of(_opened(path), str(path))


def _opened(path: Path) -> Any:
    xarray = library()
    try:
        with xarray.open_dataset(path, engine="h5netcdf", decode_cf=False) as opened:
            return opened.load()
    except InputError:
        raise
    except Exception as error:
        # Whatever a damaged file makes the library say.
        refuse(str(path), f"The netCDF file cannot be read: {error}. Write it once more.")
