"""A recording that went to netCDF and back is the same to the last bit."""

from __future__ import annotations

import gc
import json
from types import MappingProxyType

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rr_opt.model.experiment import CHANNELS, Noise, Recording
from rr_opt.model.gait import FourierGait, SineGait
from rr_opt.outcome import InputError
from rr_opt.recordings.readers import ReadOptions, read_file
from rr_opt.recordings.readers.netcdf import from_dataset, gait_of, to_dataset, write_netcdf

h5py = pytest.importorskip("h5py")
xarray = pytest.importorskip("xarray")

WORDS = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=12)
NUMBERS = st.floats(allow_nan=False, width=64)


@st.composite
def recordings(draw):
    n = draw(st.integers(2, 6))
    channels = (*CHANNELS, "torque") if draw(st.booleans()) else CHANNELS
    t = draw(st.lists(st.floats(-1e6, 1e6), min_size=n, max_size=n, unique=True))
    by_channel = {}
    for name in channels:
        flags = np.array(draw(st.lists(st.integers(0, 15), min_size=n, max_size=n)), np.uint8)
        values = np.array(draw(st.lists(NUMBERS, min_size=n, max_size=n)))
        # A value that is not there is flagged so; one that is there may be too.
        values[(flags & 1 == 1) & draw(st.booleans())] = np.nan
        noise = st.floats(0, 1e6) | st.just(np.nan)
        sigma = np.array(draw(st.lists(noise, min_size=n, max_size=n)))
        by_channel[name] = (values, sigma, flags)
    return Recording(
        draw(WORDS),
        np.sort(t),
        *(
            MappingProxyType({name: parts[at] for name, parts in by_channel.items()})
            for at in range(3)
        ),
        MappingProxyType(draw(st.dictionaries(WORDS, WORDS, max_size=3))),
        tuple(draw(st.lists(WORDS, max_size=3))),
    )


def same(a: Recording, b: Recording) -> bool:
    arrays = zip(
        [a.t, *a.values.values(), *a.sigma.values(), *a.flags.values()],
        [b.t, *b.values.values(), *b.sigma.values(), *b.flags.values()],
        strict=True,
    )
    return (
        (a.name, a.channels, a.doubts) == (b.name, b.channels, b.doubts)
        and dict(a.source) == dict(b.source)
        and all(x.dtype == y.dtype and x.tobytes() == y.tobytes() for x, y in arrays)
    )


@settings(
    deadline=None, max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(recording=recordings())
def test_nothing_is_lost(tmp_path, recording):
    path = write_netcdf(tmp_path / "run.nc", recording)
    assert same(read_file(path), recording)


@pytest.fixture
def run(write):
    return read_file(
        write("t,x,y,psi,phi\n0,1,2,3,4\n0.1,,2,3,4\n0.2,1,2,3,4\n"), ReadOptions(Noise(1e-3, 3e-3))
    )


@pytest.mark.parametrize(
    "gait", [SineGait(0.5, 1.2, 0.1), FourierGait(1.0, 0.1, (0.5, 0.1), (0.0, 0.2))]
)
def test_the_command_goes_with_it(tmp_path, run, gait):
    path = write_netcdf(tmp_path / "run.nc", run, gait)
    with h5py.File(path) as file:
        np.testing.assert_array_equal(file["command"][:], gait.angle(run.t))
    with xarray.open_dataset(path) as data:
        assert gait_of(data, "run.nc") == gait
    assert gait_of(to_dataset(run), "run.nc") is None


def test_another_program_finds_values_units_and_flags(tmp_path, run):
    """h5py knows nothing of xarray nor of this package."""
    with h5py.File(write_netcdf(tmp_path / "run.nc", run)) as file:
        assert file["t"][:].tolist() == [0.0, 0.1, 0.2]
        np.testing.assert_array_equal(file["x"][:], [1, np.nan, 1])
        units = {name: str(file[name].attrs["units"]) for name in ("t", *CHANNELS, "x_sigma")}
        assert units == {
            "t": "s", "x": "m", "y": "m", "psi": "rad", "phi": "rad", "x_sigma": "m",
        }  # fmt: skip
        assert file["psi_sigma"][:].tolist() == [3e-3] * 3
        assert file["x_flag"][:].tolist() == [0, 1, 0]
        assert file["x_flag"].attrs["flag_meanings"] == "missing outlier out_of_order"
        assert json.loads(file.attrs["source"])["format"] == "plain CSV"


def test_a_file_of_another_program_will_do(tmp_path):
    n = 4
    data = xarray.Dataset({one: ("t", np.arange(n) + 0.5) for one in CHANNELS})
    data["v"] = ("t", np.ones(n))
    data = data.assign_coords(t=np.arange(n) / 10)
    data.attrs["source"] = "rr-opt 1.0"
    data.to_netcdf(tmp_path / "run.nc", engine="h5netcdf")
    run = read_file(tmp_path / "run.nc", ReadOptions(Noise(1e-3, 3e-3)))
    assert run.values["phi"].tolist() == [0.5, 1.5, 2.5, 3.5]
    assert run.sigma["phi"].tolist() == [3e-3] * n
    assert run.doubts == ("Variables not read: v.",)
    assert run.source["written by"] == "rr-opt 1.0"


WRONG = {
    "no phi": (lambda data: data.drop_vars("phi"), "The variable `phi` is missing"),
    "millimetres": (lambda data: data.assign(x=data.x.assign_attrs(units="mm")), "`x` is in 'mm'"),
    "text": (lambda data: data.assign(x=("t", ["a", "b", "c"])), "Expected numbers over t"),
    "over time": (lambda data: data.rename(t="time"), "The variable `t` is missing"),
    "backwards": (lambda data: data.isel(t=[2, 1, 0]), "each above the last"),
    "one row": (lambda data: data.isel(t=[0]), "t has 1 values"),
    "no sigma": (lambda data: data.assign(x_sigma=data.x_sigma * 1e306), "x_sigma ranges from"),
    "NaN": (lambda data: data.assign_coords(t=[0, np.nan, 1]), "each above the last"),
}


@pytest.mark.parametrize("case", WRONG)
def test_refused(run, case):
    change, message = WRONG[case]
    with pytest.raises(InputError, match=message) as caught:
        from_dataset(change(to_dataset(run)), "run.nc")
    assert str(caught.value).startswith("run.nc: ")


@pytest.mark.parametrize("part", [0.05, 0.5, 0.95])
def test_half_a_file(tmp_path, run, part):
    path = write_netcdf(tmp_path / "run.nc", run)
    content = path.read_bytes()
    path.write_bytes(content[: int(part * len(content))])
    with pytest.raises(InputError):
        read_file(path)


def test_netcdf_3(write):
    with pytest.raises(InputError, match="netCDF 3"):
        read_file(write(b"CDF\x01" + bytes(40)))


def test_a_damaged_file_is_an_error_and_nothing_else_is_printed(tmp_path, capfd):
    (tmp_path / "a.csv").write_text("t,x,y,psi,phi\n0,1,2,3,4\n0.01,1,2,3,4\n")
    made = read_file(tmp_path / "a.csv")
    path = write_netcdf(tmp_path / "a.nc", made)
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    told = []
    for _ in range(60):
        at = int(rng.integers(len(whole)))
        path.write_bytes(whole[:at] + rng.bytes(8) + whole[at + 8 :])
        try:
            read_file(path)
        except InputError as error:
            told.append(str(error))
        gc.collect()
    assert len(told) > 10
    assert capfd.readouterr() == ("", "")
