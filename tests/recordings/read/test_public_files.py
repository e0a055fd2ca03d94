"""Files that capture systems wrote, as their owners published them, are read as they are.

Each is the head of a public file and its first rows, cut to a few columns where it has many.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from rr_opt.files.issue import InvalidFileError
from rr_opt.recordings.readers import MarkerData, read_file

MOTIVE_MARKERS = """\
Format Version,1.23,Take Name,test,Take Notes,,Capture Frame Rate,360.000000,Export Frame Rate,\
360.000000,Capture Start Time,2023-11-28 10.27.58.765 DU.,Capture Start Frame,78593,Total Frames \
in Take,1353,Total Exported Frames,1353,Rotation Type,Quaternion,Length Units,Millimeters,\
Coordinate Space,Global

,Type,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker,Marker
,Name,Unlabeled 1036,Unlabeled 1036,Unlabeled 1036,Unlabeled 1037,Unlabeled 1037,Unlabeled 1037,\
Unlabeled 1053,Unlabeled 1053,Unlabeled 1053
,ID,"1A2A8F984BAAD11EE","1A2A8F984BAAD11EE","1A2A8F984BAAD11EE","2A2A8F984BAAD11EE",\
"2A2A8F984BAAD11EE","2A2A8F984BAAD11EE","12A2A8F984BAAD11EE","12A2A8F984BAAD11EE",\
"12A2A8F984BAAD11EE"
,,Position,Position,Position,Position,Position,Position,Position,Position,Position
Frame,Time (Seconds),X,Y,Z,X,Y,Z,X,Y,Z
0,0.000000,2659.741943,-830.793884,-2862.191650,2030.914551,35.370396,724.494568,,,
1,0.003000,2659.775635,-830.803101,-2862.214844,2031.055664,34.594387,724.334412,,,
2,0.006000,2659.761963,-830.738464,-2862.203613,2031.242554,34.496128,724.428711,,,
3,0.008000,2659.785889,-830.814453,-2862.241943,2031.239502,35.026089,724.566040,,,
"""
"""ha5dzs/optitrack-motive-file-converter, test_markers_enabled.csv: three of 18 markers."""

MOTIVE_BODY = """\
Format Version,1.23,Take Name,Take 2024-05-10 11.31.19 AM,Take Notes,,Capture Frame Rate,120.000000\
,Export Frame Rate,120.000000,Capture Start Time,2024-05-10 11.31.19.221 AM,Total Frames in Take,\
9420,Total Exported Frames,9420,Rotation Type,Quaternion,Length Units,Millimeters,Coordinate Space,\
Global

,Type{0}
,Name{1}
,ID{2}
,,{3}
Frame,Time (Seconds),{4}
0,0.000000,{5}
1,0.008333,{6}
2,0.016667,{7}
"""
"""Kronium345/optitrack-odometry-movement, optitrack_recording.csv: its body, once or twice."""
BODY = (
    ",Rigid Body" * 7,
    ",drone" * 7,
    ',"D0EC16A40EB511EFEAE2C7CD3AE76489"' * 7,
    "Rotation,Rotation,Rotation,Rotation,Position,Position,Position",
    "X,Y,Z,w,X,Y,Z",
    "-0.002073,0.008540,0.008965,-0.999921,89.155853,222.630280,-144.556259",
    "-0.002088,0.008508,0.008968,-0.999922,89.126053,222.641464,-144.575119",
    ",,,,,,",
)

TRACKER = """\
Objects
100
,,{name},,,,,,,{name}2,,,,,,
Frame,Sub Frame{axes}{axes}
,,,,,,mm,mm,mm,,,,,mm,mm,mm
1,0{0}{0}
2,0{1}{1}
"""
"""uncobruce/viconplotter, data/test_square.csv: the one object twice."""
OBJECT = (
    ",-0.001417,0.005374,-0.005212,0.999971,570.915405,-1260.010986,49.566303",
    ",-0.000965,0.005072,-0.005272,0.999973,570.935425,-1259.963135,49.471977",
)

SEGMENTS = """\
Segments
200
,,Subject01:Head,,,,,,Subject01:L_Collar,,,,,,
Frame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,RY,RZ,TX,TY,TZ
,,deg,deg,deg,mm,mm,mm,deg,deg,deg,mm,mm,mm
1,0,0.191,-1.8347,2.44866,-16.9,40.3,443.2,-5.679,73.5419,-57.3109,-12.4,29.5,324.6
2,0,0.191,-1.8347,2.44866,-16.9,40.3,443.2,,,,,,
"""
"""The head of a Nexus export that a public script repeats, two of its 22 segments in one pose."""

TRC = """\
PathFileType\t4\t(X/Y/Z)\tarm26_elbow_flex_translated.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
120\t120\t121\t3\tmm\t120\t1\t121
Frame#\tTime\tr_acromion\t\t\tr_humerus_epicondyle\t\t\tr_radius_styloid\t\t\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2\tX3\tY3\tZ3\t

1\t0\t-13.05452443\t839.50547557\t169.5054756\t-12.55937962\t502.5856204\t199.9856204\t-13.12468341\
\t266.4303173\t251.4203173\t
2\t0.008333333\t-12.96064763\t839.59935237\t169.5993524\t-12.56732433\t502.5776757\t199.9776757\
\t-12.86702479\t266.3996197\t251.3825496\t
"""
"""opensim-org/opensim-models, arm26_elbow_flex.trc."""

QUALISYS = """\
NO_OF_FRAMES\t2000
NO_OF_CAMERAS\t10
NO_OF_MARKERS\t2
FREQUENCY\t100
NO_OF_ANALOG\t0
ANALOG_FREQUENCY\t0
DESCRIPTION\t--
TIME_STAMP\t2026-01-19, 10:19:43.755\t2063631.96175450
DATA_INCLUDED\t3D
MARKER_NAMES\tNew 0000\tNew 0002
TRAJECTORY_TYPES\tMeasured\tMeasured
Frame\tTime\tNew 0000 X\tNew 0000 Y\tNew 0000 Z\tNew 0002 X\tNew 0002 Y\tNew 0002 Z\t
1\t0.00000\t819.834\t277.770\t22.421\t694.169\t-183.362\t97.003
2\t0.01000\t819.835\t277.770\t22.420\t694.163\t-183.351\t96.985
3\t0.02000\t819.851\t277.778\t22.400\t694.176\t-183.368\t96.978
"""
"""reiv27/biomechanics, data/Measurement1.tsv: two of 15 markers."""


def test_qualisys_markers(write):
    data = read_file(write(QUALISYS))
    assert isinstance(data, MarkerData)
    assert data.labels == ("New 0000", "New 0002")
    assert data.rate == 100
    np.testing.assert_allclose(data.t, [0.0, 0.01, 0.02])
    np.testing.assert_allclose(data.positions[2, 1], [0.694176, -0.183368, 0.096978])


def test_motive_markers(write):
    data = read_file(write(MOTIVE_MARKERS))
    assert isinstance(data, MarkerData)
    assert data.labels == ("Unlabeled 1036", "Unlabeled 1037", "Unlabeled 1053")
    assert (data.rate, data.up) == (360, "y")
    np.testing.assert_allclose(data.positions[3, 1], [2.031239502, 0.035026089, 0.724566040])
    assert np.isnan(data.positions[:, 2]).all()


def test_motive_bodies(write):
    with pytest.raises(InvalidFileError, match=r"Read the rigid body 'drone'\. Expected two"):
        read_file(write(MOTIVE_BODY.format(*BODY)))
    first, *others = BODY
    twice = [first * 2, others[0] + others[0].replace("drone", "other"), others[1] * 2]
    twice += [f"{one},{one}" for one in others[2:]]
    data = read_file(write(MOTIVE_BODY.format(*twice)))
    assert {*data.labels} == {"drone", "drone x", "drone z", "other", "other x", "other z"}
    at = {label: data.positions[:, k] for k, label in enumerate(data.labels)}
    np.testing.assert_allclose(at["drone"][0], [0.089155853, 0.222630280, -0.144556259])
    # A turn about y, which is up: w is negative, so it is the other way round.
    turned = 2 * np.arctan2(0.008540, -0.999921)
    ahead = (at["drone z"] - at["drone"])[0]
    assert np.arctan2(ahead[0], ahead[2]) == pytest.approx(
        np.remainder(turned + np.pi, 2 * np.pi) - np.pi, abs=1e-3
    )
    assert np.isnan(at["drone"][2]).all()


def test_vicon_tracker_objects(write):
    name = "Global Angle (Quaternion) Turtlebot UMBmark:Turtlebot UMBmark"
    axes = ",RX,RY,RZ,RW,TX,TY,TZ"
    data = read_file(write(TRACKER.format(*OBJECT, name=name, axes=axes)))
    at = {label: data.positions[:, k] for k, label in enumerate(data.labels)}
    assert data.rate == 100
    (label,) = {one for one in at if one.endswith("Turtlebot UMBmark")}
    np.testing.assert_allclose(at[label][0], [0.570915405, -1.260010986, 0.049566303])
    ahead = (at[f"{label} x"] - at[label])[0]
    assert np.arctan2(ahead[1], ahead[0]) == pytest.approx(2 * -0.005212, abs=1e-4)


def test_vicon_nexus_segments(write):
    data = read_file(write(SEGMENTS))
    assert data.rate == 200
    at = {label: data.positions[:, k] for k, label in enumerate(data.labels)}
    assert {"Head", "Head x", "Head y", "L_Collar"} < set(at)
    np.testing.assert_allclose(at["Head"][0], [-0.0169, 0.0403, 0.4432])
    ahead = (at["Head x"] - at["Head"])[0]
    assert np.degrees(np.arctan2(ahead[1], ahead[0])) == pytest.approx(2.449, abs=0.01)
    # The rotation is a vector, 93 degrees long, and not angles about three axes.
    turned = Rotation.from_rotvec([-5.679, 73.5419, -57.3109], degrees=True).as_matrix()
    ahead = (at["L_Collar y"] - at["L_Collar"])[0]
    assert np.arctan2(ahead[1], ahead[0]) == pytest.approx(np.arctan2(turned[1, 1], turned[0, 1]))
    assert np.isnan(at["L_Collar"][1]).all()


def test_trc(write):
    data = read_file(write(TRC, "arm26.trc"))
    assert data.labels == ("r_acromion", "r_humerus_epicondyle", "r_radius_styloid")
    np.testing.assert_allclose(data.positions[1, 2], [-0.01286702479, 0.2663996197, 0.2513825496])
