"""A trajectory as a file: CSV with a header row, or netCDF with units."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

from rr_opt.documents.archive import whole
from rr_opt.documents.document import csv_text
from rr_opt.motion.rollout import Trajectory
from rr_opt.outcome import InputError
from rr_opt.version import __version__

_COLUMNS = {
    "t": ("s", "time"),
    "x": ("m", "joint P along the floor's x axis"),
    "y": ("m", "joint P along the floor's y axis"),
    "psi": ("rad", "heading of platform 1"),
    "phi": ("rad", "angle of platform 2 relative to platform 1"),
    "v": ("m/s", "speed of axle 1 along platform 1"),
    "torque": ("N m", "servo torque on platform 2"),
}


def trajectory_csv(trajectory: Trajectory) -> str:
    """t,x,y,psi,phi,v,torque in SI units under a header row."""
    names = [field.name for field in fields(Trajectory)]
    columns = (getattr(trajectory, name).tolist() for name in names)
    return csv_text(names, zip(*columns, strict=True))


def netcdf_writer() -> Any:
    """The module xarray. Raises InputError if it, h5netcdf or h5py is not installed."""
    try:
        import h5netcdf  # noqa: F401
        import h5py  # noqa: F401  # pyright: ignore[reportMissingImports]
        import xarray
    except ImportError:
        raise InputError(
            "netCDF files need xarray, h5netcdf and h5py, which are not all installed. "
            "Run `pip install 'rr-opt[netcdf]'`, or write CSV with --format csv."
        ) from None
    return xarray


def write_netcdf(path: Path, trajectory: Trajectory) -> Path:
    """Write the same as netCDF variables over t, with their units and meanings."""
    data = netcdf_writer().Dataset(
        {name: ("t", getattr(trajectory, name)) for name in _COLUMNS if name != "t"},
        coords={"t": trajectory.t},
        attrs={"title": "Roller Racer trajectory", "source": f"rr-opt {__version__}"},
    )
    for name, (unit, meaning) in _COLUMNS.items():
        data[name].attrs.update(units=unit, long_name=meaning)
    return write_dataset(path, data)


def write_dataset(path: Path, data: Any) -> Path:
    """Write a dataset of xarray, whole."""
    with whole(path) as temporary:
        data.to_netcdf(temporary, engine="h5netcdf")
    return path
