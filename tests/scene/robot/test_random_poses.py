"""Random poses: within limits, everywhere within them, and the same for the same seed."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

from satcheck.scene.robot import RandomPoses
from tests.scene.robot.robots import SAMPLES, joint, link, read, read_robot, robot_of

ARM, _ = read_robot(SAMPLES / "arm.urdf", "arm.urdf")


def test_the_first_poses_of_seed_0() -> None:
    """As written down once: no machine, and no version of Python, draws others."""
    assert list(RandomPoses([ARM], 2, 0)) == [
        {"turn": (2.16407,), "shoulder": (1.16079,), "elbow": (-0.476571,), "grip": (0.0485469,)},
        {"turn": (0.0708412,), "shoulder": (-0.427796,), "elbow": (1.70279,), "grip": (0.0568711,)},
    ]


def test_a_longer_list_starts_with_the_shorter_one_and_another_seed_is_another_list() -> None:
    assert list(RandomPoses([ARM], 7, 5))[:3] == list(RandomPoses([ARM], 3, 5))
    assert list(RandomPoses([ARM], 3, 6)) != list(RandomPoses([ARM], 3, 5))
    assert list(RandomPoses([ARM], 0, 0)) == []


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [("turn", -math.pi, math.pi), ("elbow", -3.0, 3.0), ("grip", 0.0, 0.1875)],
)
def test_uniform_within_the_limits(name: str, low: float, high: float) -> None:
    """Of 1600 draws a tenth of the range gets 160, with a standard deviation of 12: six of them is
    what no seed in a billion exceeds."""
    values = [pose[name][0] for pose in list(RandomPoses([ARM], 1600, 1))]
    assert low <= min(values) <= max(values) <= high
    counts = [0] * 10
    for value in values:
        counts[min(9, int(10 * (value - low) / (high - low)))] += 1
    assert all(abs(count - 160) < 72 for count in counts)


def test_rounding_does_not_leave_the_limits(tmp_path: Path) -> None:
    limit = '<limit lower="1.00000049" upper="1.00000051"/>'
    text = robot_of(link("a"), link("b"), joint("j", "a", "b", "revolute", limit))
    for pose in list(RandomPoses([read(tmp_path, text)], 20, 0)):
        assert 1.00000049 <= pose["j"][0] <= 1.00000051


@pytest.mark.parametrize("limit", [1e-11, 0.0625, 9.9999994, 30000.0, 1e7])
def test_each_value_has_six_digits(tmp_path: Path, limit: float) -> None:
    limits = f'<limit lower="{-limit}" upper="{limit}"/>'
    text = robot_of(link("a"), link("b"), joint("j", "a", "b", "revolute", limits))
    shares = random.Random(2)
    for pose in RandomPoses([read(tmp_path, text)], 3000, 2):
        value = -limit + shares.random() * (limit + limit)
        assert pose["j"] == (min(max(float(f"{value:.6g}"), -limit), limit),)


def test_what_is_fixed_stays_and_the_others_do_not_notice() -> None:
    held = list(RandomPoses([ARM], 3, 0, {"elbow": (0.5,), "grip_right": (0.0,)}))
    for pose, free in zip(held, list(RandomPoses([ARM], 3, 0)), strict=True):
        assert pose["elbow"] == (0.5,)
        assert pose["turn"] == free["turn"]
        assert pose["grip"] == free["grip"]


def test_joints_without_a_range_stay_where_they_are(tmp_path: Path) -> None:
    elements = [link(name) for name in "abc"]
    elements += [joint("j", "a", "b", "planar"), joint("k", "b", "c", "floating")]
    assert list(RandomPoses([read(tmp_path, robot_of(*elements))], 2, 0)) == [{}, {}]
