"""diagnosis.json says everything that was found, in SI, and is strict JSON for every verdict."""

import json

import numpy as np
import pytest

from rr_opt.documents.archive import strict_json

VERDICTS = ("consistent", "parameters", "missing_physics", "unexplained")

CHANNELS = (
    "actuation",
    "constraint_axle1",
    "constraint_axle2",
    "rolling",
    "yaw",
    "mass",
    "floor",
    "measurement",
    "none",
)


@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_verdict_has_all_keys(every, verdict):
    reported = json.loads(strict_json(every[verdict].record()))
    assert reported["verdict"] == verdict
    assert set(reported["location"]) == {"channel", "where", "evidence"}
    assert reported["location"]["channel"] in CHANNELS
    for evidence in reported["location"]["evidence"]:
        assert {"test", "statistic", "p_value"} <= set(evidence)
    for key in ("summary", "candidates", "indistinguishable", "next_experiment", "seconds"):
        assert key in reported
    assert reported["input_sha256"] == "ab" * 32
    assert bool(reported["effects"]) == (verdict in ("parameters", "missing_physics"))


def test_an_effect_has_values_with_intervals(missing):
    (effect,) = missing.record()["effects"]
    assert effect["name"] == "coulomb_friction"
    assert effect["parameters"]["force1"] == {
        "value": 0.0152,
        "ci95": [0.0141, 0.0163],
        "unit": "N",
    }
    assert effect["removes"] == 0.97


def test_a_wrong_parameter_has_its_value_directly_and_under_parameters(wrong_values):
    (effect,) = wrong_values.record()["effects"]
    assert effect["name"] == "kappa1"
    assert effect["value"] == effect["parameters"]["kappa1"]["value"] == 2.1e-5
    assert effect["ci95"] == effect["parameters"]["kappa1"]["ci95"] == [1.8e-5, 2.4e-5]


def test_misfits_are_reported_by_recording_and_channel(missing):
    fit = missing.record()["fit"]
    assert fit["heldout_recordings"] == ["run02.csv", "run04.csv"]
    # By hand, from the residuals of the runs that were fitted.
    fitted = np.concatenate([missing.found.nominal[k].residuals.ravel() for k in (0, 2)])
    by_hand = np.linalg.norm(fitted[~np.isnan(fitted)]) / (~np.isnan(fitted)).sum() ** 0.5
    assert fit["fitted_rms_before"] == pytest.approx(by_hand)
    assert fit["heldout_rms_before"] == 8.1
    second = fit["recordings"][1]
    assert (second["file"], second["use"]) == ("run02.csv", "holdout")
    assert second["channels"]["x"]["before"] > 5
    assert second["channels"]["x"]["after"] < 1.1


def test_candidates_are_ranked(missing):
    ranked = missing.record()["candidates"]
    assert [one["score_above_best"] for one in ranked] == [0, 900, 2000]
    assert [one["rms_beyond_noise"] for one in ranked] == [0.02, None, 8.0]
    assert [one["accepted"] for one in ranked] == [True, False, False]


def test_what_remains_is_reported(missing, unexplained):
    assert missing.record()["remainder"] == {
        "size": "none",
        "rms": 0.05,
        "share": 0.01,
        "depends_on": "",
        "matters": "It places the robot to within 0.4 mm.",
    }
    left = unexplained.record()["remainder"]
    assert (left["size"], left["share"]) == ("large", 0.97)
    assert left["depends_on"] == "a force along the wheels that depends on the speed"
