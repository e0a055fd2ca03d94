"""What a variable or an attribute of a dataset holds, checked."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from rr_opt.outcome import InputError

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
            f"{file}: `{name}` holds {found.dtype} over {found.dims}. Expected numbers over t. "
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
