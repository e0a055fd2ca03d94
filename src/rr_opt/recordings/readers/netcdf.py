"""A recording in a netCDF file, by way of an xarray Dataset, and back without loss.

Over the dimension `t`: the channels under their names, `<channel>_sigma`, `<channel>_flag`, and
`command`, the commanded angle, where it is known. Units and meanings are attributes (CF
conventions); the recording's source and doubts, and the gait that was commanded, are attributes in
JSON.
"""

from __future__ import annotations

import json
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from rr_opt.files.issue import InvalidFileError, refuse
from rr_opt.files.record import gait_from, gait_record
from rr_opt.files.yaml_text import FileData
from rr_opt.model.experiment import CHANNELS, UNITS, Flag, Noise, Recording
from rr_opt.model.gait import Gait
from rr_opt.outcome import InputError
from rr_opt.recordings.readers.text import Reader, ReadOptions
from rr_opt.recordings.warnings import notice
from rr_opt.version import __version__

if TYPE_CHECKING:
    import xarray


def numbers_of(data: xarray.Dataset, name: str, unit: str, file: str) -> Any:
    """A variable over t, as floats. Raises InputError."""
    if name not in data.variables:
        raise InputError(
            f"{file}: The variable `{name}` is missing. Expected t, x, y, psi and phi. "
            "Write a recording with `rr-opt inspect FILE --netcdf FILE`."
        )
    found = data[name]
    stated = str(found.attrs.get("units", unit))
    if found.dims != ("t",) or found.dtype.kind not in "fiu":
        raise InputError(
            f"{file}: `{name}` has {found.dtype} over {found.dims}. Expected numbers over t. "
            "Write them so."
        )
    if stated != unit:
        raise InputError(
            f"{file}: `{name}` is in {stated!r}. Expected {unit}. Convert it, and its attribute "
            "`units`."
        )
    return np.array(found.values, np.float64)


def from_json(data: xarray.Dataset, name: str, kind: type, file: str) -> Any:
    """What an attribute holds in JSON; empty if there is no such attribute."""
    text = data.attrs.get(name)
    if text is None:
        return kind()
    try:
        found = json.loads(text)
    except (TypeError, ValueError, RecursionError):
        # Many programs write an attribute `source`, in plain words.
        return {"file": file, "format": "netCDF", "written by": str(text)} if kind is dict else []
    return found if isinstance(found, kind) else kind()


_MEANINGS = {
    "x": "joint P along the floor's x axis",
    "y": "joint P along the floor's y axis",
    "psi": "heading of platform 1",
    "phi": "angle of platform 2 relative to platform 1, measured",
    "torque": "servo torque on platform 2",
}


def to_dataset(recording: Recording, gait: Gait | None = None) -> xarray.Dataset:
    """The recording and, where it is known, the gait that was commanded.

    Raises InputError if xarray is not installed.
    """
    data = library().Dataset(
        coords={"t": ("t", recording.t, {"units": "s", "long_name": "time on the command's clock"})}
    )
    for name in recording.channels:
        unit = {"units": UNITS[name]}
        meaning = {"long_name": _MEANINGS[name], "ancillary_variables": f"{name}_sigma {name}_flag"}
        sigma = {"long_name": f"standard deviation of the noise of {name}"}
        flag = {
            "long_name": f"why a value of {name} is not valid data; 0: it is valid",
            "flag_masks": np.array([flag.value for flag in Flag], np.uint8),
            "flag_meanings": " ".join(str(flag.name).lower() for flag in Flag),
        }
        data[name] = ("t", recording.values[name], unit | meaning)
        data[f"{name}_sigma"] = ("t", recording.sigma[name], unit | sigma)
        data[f"{name}_flag"] = ("t", recording.flags[name], flag)
    if gait is not None:
        meaning = {"units": "rad", "long_name": "commanded angle"}
        data["command"] = ("t", gait.angle(recording.t), meaning)
        data.attrs["gait"] = json.dumps(gait_record(gait))
    data.attrs |= {
        "Conventions": "CF-1.11",
        "title": "Recording of a Roller Racer",
        "history": f"written by rr-opt {__version__}",
        "name": recording.name,
        "source": json.dumps(dict(recording.source), ensure_ascii=False),
        "doubts": json.dumps(list(recording.doubts), ensure_ascii=False),
    }
    return data


_NO_NOISE = 1e6
"""No measurement has this much noise, in m, rad or N m."""


def from_dataset(data: xarray.Dataset, file: str, noise: Noise | None = None) -> Recording:
    """The recording of a dataset that `to_dataset` made, or of any with t, x, y, psi and phi.

    noise: standard deviations where the dataset has none; without it they are NaN. Raises
    InputError, naming `file`, if a variable is missing, or is not over t or in SI units.
    """
    t = numbers_of(data, "t", "s", file)
    if len(t) < 2 or not (np.diff(t) > 0).all():
        raise InputError(
            f"{file}: t has {len(t)} values. Expected at least 2, each above the last. Sort them, "
            "and delete duplicates."
        )
    channels = [*CHANNELS, *(["torque"] if "torque" in data else [])]
    values, sigma, flags = {}, {}, {}
    for name in channels:
        values[name] = numbers_of(data, name, UNITS[name], file)
        missing = np.isnan(values[name])
        if f"{name}_sigma" in data:
            sigma[name] = numbers_of(data, f"{name}_sigma", UNITS[name], file)
            if ((sigma[name] < 0) | (sigma[name] > _NO_NOISE)).any():
                raise InputError(
                    f"{file}: {name}_sigma ranges from {np.nanmin(sigma[name]):.3g} to "
                    f"{np.nanmax(sigma[name]):.3g}. Expected standard deviations of noise. Write "
                    "the file again."
                )
        else:
            sigma[name] = np.full(len(t), noise.of(name) if noise else np.nan)
        flags[name] = np.where(missing, Flag.MISSING, 0).astype(np.uint8)
        if f"{name}_flag" in data:
            flags[name] |= numbers_of(data, f"{name}_flag", "1", file).astype(np.uint8)
    known = [f"{one}{end}" for one in channels for end in ("", "_sigma", "_flag")]
    others = [str(name) for name in data.variables if name not in ("t", "command", *known)]
    doubts = from_json(data, "doubts", list, file)
    doubts += [notice("file.variables", names=", ".join(others))] if others else []
    source = {"file": file, "format": "netCDF"}
    if "source" in data.attrs:
        source = from_json(data, "source", dict, file)
    return Recording(
        str(data.attrs.get("name", file)),
        t,
        MappingProxyType(values),
        MappingProxyType(sigma),
        MappingProxyType(flags),
        MappingProxyType({str(key): str(value) for key, value in source.items()}),
        tuple(str(one) for one in doubts),
    )


def gait_of(data: xarray.Dataset, file: str) -> Gait | None:
    """The gait that was commanded, if the dataset says. Raises InvalidFileError if it is wrong."""
    record = from_json(data, "gait", dict, file)
    if not record:
        return None
    gait, issues = gait_from(FileData(file, record, {}))
    if gait is None:
        raise InvalidFileError(issues)
    return gait


def library() -> Any:
    """The module xarray. Raises InputError if it, h5netcdf or h5py is not installed."""
    try:
        import h5netcdf  # noqa: F401 - an extra
        import xarray
    except ImportError:
        raise InputError(
            "netCDF files need xarray and h5netcdf, which are not both installed. "
            "Run `pip install 'rr-opt[netcdf]'`, or use CSV."
        ) from None
    return xarray


SIGNATURE = b"\x89HDF\r\n\x1a\n"
"""How every netCDF 4 file begins, which is HDF 5."""
_NETCDF3 = (b"CDF\x01", b"CDF\x02", b"CDF\x05")


_LARGEST = 500_000_000
"""A compressed file of a few bytes can state any number of values; bytes."""


def write_netcdf(path: Path, recording: Recording, gait: Gait | None = None) -> Path:
    """Write the recording, and the gait that was commanded where it is known, as netCDF 4.

    The file is written in place: a caller that must not leave half a file writes beside it and
    renames. Raises InputError if an extra is missing.
    """
    data = to_dataset(recording, gait)
    # NaN is stored as itself, without a fill value.
    plain = {name: {"_FillValue": None} for name in data.variables}
    data.to_netcdf(path, engine="h5netcdf", encoding=plain)
    return path


def sniff(content: bytes) -> bool:
    """Whether a file begins as netCDF does, 4 or older."""
    return content.startswith((SIGNATURE, *_NETCDF3))


def read(file: str, content: bytes, options: ReadOptions) -> Recording:
    """The recording of a netCDF file, whoever wrote it. Raises InputError without the extra."""
    if not content.startswith(SIGNATURE):
        refuse(file, "This is netCDF 3. Expected netCDF 4. Convert it with `nccopy -k nc4`.")
    return from_dataset(_opened(Path(file)), file, options.noise)


def commanded_gait(path: Path) -> Gait | None:
    """The gait that a netCDF file says was commanded; None if it does not say, or is no netCDF.

    Raises as `read`.
    """
    with path.open("rb") as file:
        if file.read(len(SIGNATURE)) != SIGNATURE:
            return None
    return gait_of(_opened(path), str(path))


def _opened(path: Path) -> Any:
    xarray = library()
    import h5py

    try:
        # h5netcdf prints a traceback when it throws away a file that it could not open.
        with h5py.File(path) as file:
            file.visititems(lambda *_: None)
        with xarray.open_dataset(path, engine="h5netcdf", decode_cf=False) as opened:
            if opened.nbytes > _LARGEST:
                refuse(str(path), f"The file has {opened.nbytes / 1e9:.3g} GB of numbers. "
                       f"Expected at most {_LARGEST / 1e9:g} GB. Cut the recording.")  # fmt: skip
            return opened.load()
    except InputError:
        raise
    except Exception as error:
        # Any error that a damaged file causes in the library.
        refuse(str(path), f"The netCDF file cannot be read: {error}. Write it again.")


READER = Reader("netCDF", sniff, read, binary=True)
