"""`columns` maps names, units and counts of foreign files; what it cannot map is refused."""

import re

import numpy as np
import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.model.experiment import Column
from rr_opt.recordings.experiment import experiment_of, read_experiment
from rr_opt.recordings.readers import ReadOptions, ServoLog, read_file
from rr_opt.recordings.readers.plain_csv import columns_from
from tests.recordings.read.test_experiment import GAIT, HEAD, motion, plain

FOREIGN = """\
Time (ms);pos x;pos y;yaw;joint;load
0;1000;2000;90;0.1;65535
10;1001;2000;91;0.2;3
20;1002;2000;92;0.3;32768
"""
COLUMNS = {
    "t": Column("time (ms)", 1e-3),
    "x": Column("pos x", 1e-3),
    "y": Column("Pos Y", 1e-3),
    "psi": Column("yaw", np.pi / 180),
    "phi": Column("joint"),
    "torque": Column("load", 1.13e-3, 16),
}


def test_names_units_and_counts(write):
    run = read_file(write(FOREIGN), ReadOptions(columns=COLUMNS))
    np.testing.assert_allclose(run.t, [0, 0.01, 0.02])
    np.testing.assert_allclose(run.values["x"], [1, 1.001, 1.002])
    np.testing.assert_allclose(run.values["psi"], np.radians([90, 91, 92]))
    np.testing.assert_allclose(run.values["torque"], 1.13e-3 * np.array([-1, 3, -32768]))
    assert [doubt.code for doubt in run.doubts] == ["file.signed"]


def test_a_column_that_is_called_as_the_channel_gives_way_to_the_one_that_is_named(write):
    text = "t,x,y,psi,theta,phi\n0,1,2,9,3,4\n0.01,1,2,9,3,4\n"
    run = read_file(write(text), ReadOptions(columns={"psi": Column("theta")}))
    assert run.values["psi"].tolist() == [3, 3]
    assert run.doubts == ("Columns not read: 'psi, as named'.",)
    # A file that has its own name for it is read too.
    assert read_file(write(plain(motion())), ReadOptions(columns=COLUMNS)).values["psi"].any()


def test_a_servo_log_may_have_other_names_too(write):
    columns = {"goal": Column("cmd"), "t": Column("clock")}
    log = read_file(write("clock,cmd\n0,512\n0.004,513\n"), ReadOptions(columns=columns))
    assert isinstance(log, ServoLog)
    assert log.goal is not None
    assert log.goal.tolist() == [512, 513]


def test_a_header_may_have_units(write):
    text = (
        "t [ms],x [mm],y,psi [deg],phi (rad),torque [N m]\n0,1000,2,90,0.1,1\n10,1001,2,91,0.2,1\n"
    )
    run = read_file(write(text))
    np.testing.assert_allclose(run.t, [0, 0.01])
    np.testing.assert_allclose(run.values["x"], [1, 1.001])
    np.testing.assert_allclose(run.values["psi"], np.radians([90, 91]))
    np.testing.assert_allclose(run.values["phi"], [0.1, 0.2])
    with pytest.raises(InvalidFileError, match="The unit of `x`: Read '1 kg', a mass"):
        read_file(write(text.replace("mm", "kg")))


def test_a_column_by_another_name_keeps_its_unit(write):
    text = "time [ms],x,y,yaw [deg],phi\n0,1,2,90,0.1\n10,1,2,91,0.2\n"
    for file, yaw in (
        (text, "yaw"),
        (text, "yaw [deg]"),
        (text.replace(" [deg]", ""), "yaw [deg]"),
    ):
        columns = columns_from({"t": "time", "psi": yaw})
        run = read_file(write(file), ReadOptions(columns=columns))
        np.testing.assert_allclose(run.t, [0, 0.01])
        np.testing.assert_allclose(run.values["psi"], np.radians([90, 91]))


def test_what_is_missing_is_guessed(write):
    with pytest.raises(InvalidFileError) as caught:
        read_file(write("time,x_m,y_m,yaw,theta2,phi_rad\n0,1,2,3,4,5\n1,1,2,3,4,5\n"))
    told = str(caught.value)
    assert "write `columns: {t: time, x: x_m, y: y_m, psi: yaw, phi: phi_rad}`" in told
    assert '--columns "t=time,x=x_m,y=y_m,psi=yaw,phi=phi_rad"' in told
    with pytest.raises(InvalidFileError, match="psi=yaw,phi=theta"):
        read_file(write("time,x_m,y_m,theta,yaw\n0,1,2,3,4\n1,1,2,3,4\n"))


def test_advice_repeats_the_columns_that_were_named(write):
    text = "clock,x_mm,y_mm,yaw,servo\n0,1000,2,90,0.1\n10,1001,2,91,0.2\n"
    given = {"t": Column("clock", 1e-3, unit="ms"), "phi": Column("servo")}
    with pytest.raises(InvalidFileError) as caught:
        read_file(write(text), ReadOptions(columns=given))
    told = str(caught.value)
    assert '--columns "t=clock [ms],x=x_mm [mm],y=y_mm [mm],psi=yaw,phi=servo"' in told
    assert "{t: {column: clock, factor: 1 ms}, x: {column: x_mm, factor: 1 mm}," in told
    counts = given | {"phi": Column("servo", 1.5e-3, 16)}
    with pytest.raises(InvalidFileError) as caught:
        read_file(write(text), ReadOptions(columns=counts))
    told = str(caught.value)
    assert "phi: {column: servo, factor: 0.0015, bits: 16}}`" in told
    assert "--columns" not in told  # an option says no counts


def test_a_guess_keeps_the_unit_that_the_name_ends_with(write):
    file = write("time_ms,x_mm,y_mm,yaw_deg,phi_rad\n0,1000,2,90,0.1\n10,1001,2,91,0.2\n")
    with pytest.raises(InvalidFileError) as caught:
        read_file(file)
    told = str(caught.value)
    assert "x: {column: x_mm, factor: 1 mm}" in told
    assert "phi: phi_rad}" in told
    option = re.search('--columns "(.*?)"', told)
    assert option
    given = dict(pair.split("=") for pair in option[1].split(","))
    run = read_file(file, ReadOptions(columns=columns_from(given)))
    np.testing.assert_allclose(run.t, [0, 0.01])
    np.testing.assert_allclose(run.values["x"], [1, 1.001])
    np.testing.assert_allclose(run.values["psi"], np.radians([90, 91]))


def test_an_experiment_file_says_them(write, tmp_path):
    text = plain(motion()).replace("t,x,y,psi,phi", "time,x,y,theta,angle")
    write(text, "one.csv")
    columns = "columns: {t: time, psi: {column: theta, factor: 1 rad}, phi: {column: angle}}\n"
    runs = f"recordings:\n- {{file: one.csv, {GAIT}}}\n"
    write(HEAD + columns + runs, "experiment.yaml")
    (run,) = read_experiment(tmp_path).runs
    np.testing.assert_allclose(run.recording.values["psi"], motion()[3], atol=0.02)
    for wrong, said in (
        ("{psy: theta}", "Read the key 'psy'"),
        ("{psi: 3}", "Expected the name of a column"),
        ("{psi: {column: theta, factor: 1 m}}", "'1 m', a length"),
        ("{psi: {column: theta, bits: 0}}", "a whole number from 2 to 64"),
        ("{psi: {column: theta, scale: 2}}", "Read the key 'scale'"),
        ("7", "Read 7"),
    ):
        write(f"{HEAD}columns: {wrong}\n{runs}", "experiment.yaml")
        assert any(said in str(issue) for issue in experiment_of(tmp_path)[1]), wrong


@pytest.mark.parametrize("columns", ["{psi: theta}", "{psy: theta}", "theta", ""])
def test_a_mistake_elsewhere_adds_none_to_recordings_with_columns(write, tmp_path, columns):
    write(plain(motion()).replace("psi", "theta"), "one.csv")
    text = f"{HEAD}speed: 1\ncolumns: {columns}\nrecordings:\n- {{file: one.csv, {GAIT}}}\n"
    write(text, "experiment.yaml")
    _, issues = experiment_of(tmp_path)
    assert {one.file.rpartition("/")[2] for one in issues} == {"experiment.yaml"}
