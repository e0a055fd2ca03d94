"""Wheel friction is given as kappa or as k, once, and the wheel radius where it matters."""

from __future__ import annotations

import pytest

from rr_opt.files.lint import lint_file
from rr_opt.files.robot_file import read_robot


def errors(path) -> dict[str, str]:
    return {issue.path: issue.message for issue in lint_file(path) if issue.level == "error"}


def test_k_is_kappa_over_h_squared(write, robot_text):
    robot = read_robot(write(robot_text.replace("kappa: 2.0e-5", "k: 0.155")))
    assert robot.k1 == robot.k2 == pytest.approx(0.155)
    assert robot.platform1.kappa == pytest.approx(0.155 * 0.020**2)


def test_without_h_the_floor_friction_stays_as_given(write, robot_text):
    text = robot_text.replace("kappa: 2.0e-5", "k: 0.155").replace("h: 0.020\n", "")
    robot = read_robot(write(text))
    assert robot.h == 0.020
    assert robot.k1 == pytest.approx(0.155)


def test_both_are_refused(write, robot_text):
    path = write(robot_text.replace("kappa: 2.0e-5", "kappa: 2.0e-5, k: 0.05", 1))
    assert errors(path) == {
        "platform1.k": "Both kappa and k are given, and k = kappa/h^2. Keep one of them."
    }


def test_neither_is_refused(write, robot_text):
    path = write(robot_text.replace(", kappa: 2.0e-5", "", 1))
    assert errors(path) == {
        "platform1.kappa": "The wheel friction is missing. Expected kappa (N m s) or k = kappa/h^2 "
        "(N s/m). Add one of them."
    }


def test_an_empty_one_is_refused(write, robot_text):
    assert "Read nothing." in errors(write(robot_text.replace("2.0e-5", "", 1)))["platform1.kappa"]


def test_kappa_needs_h(write, robot_text):
    path = write(robot_text.replace("h: 0.020\n", ""))
    assert errors(path) == {
        "h": "The wheel radius (m) is missing. platform1.kappa needs it. Add for example h: 20 mm."
    }


def test_physics_needs_h(write, robot_text):
    text = robot_text.replace("kappa: 2.0e-5", "k: 0.155").replace("h: 0.020\n", "")
    path = write(text + "physics: [{name: wheel_inertia, J: 1e-6}]\n")
    assert "`physics` needs it" in errors(path)["h"]
