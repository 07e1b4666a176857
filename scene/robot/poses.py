"""Reads poses of robots, draws random ones, and combines named states.

A JSON file holds {"joint": value, ...}, one pose, or a list of such objects. A value is a number
(radians; metres for a prismatic joint), or a list of numbers: [x, y, angle] for a planar joint, [x,
y, z, roll, pitch, yaw] for a floating one. A CSV table has a column for each joint.
"""

from __future__ import annotations

import csv
import json
import math
import random
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from satcheck.core.errors import SatcheckError
from satcheck.scene.opening import read_whole
from satcheck.scene.robot.kinematics import Numbers
from satcheck.scene.robot.model import Joint, Robot, Values
from satcheck.scene.words import why_unreadable

Pose = Mapping[str, Values]
# Significant digits of a random value. A user can then read and retype a pose; the rounded pose is
# the one that is checked.
_DIGITS = 6
# Values of other sizes are rounded one by one, and so is a value this close to the middle of two
# rounded ones, in units of the last digit: more than the rounding of its product with a power.
_PLAIN = (1e-9, 1e5)
_NEAR_MIDDLE = 1e-6
_POWERS = np.array([float(f"1e{k}") for k in range(23)])  # exact in float64
# Poses that are drawn at a time where they are taken one by one.
_DRAWN = 1024


def read_poses(given: str) -> list[Pose] | Pose:
    """Return the poses of a JSON file, or of a JSON text that starts with { or [: a list of poses
    or one pose, as in the text.

    Raises SatcheckError (`bad-pose`, or a code about the file).
    """
    text, file = (given, None) if given.lstrip()[:1] in ("{", "[") else (_text(given), given)
    try:
        document = json.loads(text, object_pairs_hook=_once)
    except json.JSONDecodeError as error:
        raise _bad(f"line {error.lineno}: not well-formed JSON: {error.msg}", file) from None
    except (RecursionError, ValueError) as error:
        raise _bad(why_unreadable(error), file) from None
    if isinstance(document, dict):
        return _pose(document, "the pose", file)
    if not isinstance(document, list) or not document:
        raise _bad('should be an object {"joint": value} or a list of such', file)
    return [_pose(pose, f"pose {k}", file) for k, pose in enumerate(document, 1)]


def read_path(file: str) -> list[Pose]:
    """Return the poses of a JSON or CSV file, or of a JSON text; `time` is a joint of each.

    Raises SatcheckError (`bad-pose`, or a code about the file).
    """
    if file.lower().endswith(".csv"):
        return _read_table(file)
    poses = read_poses(file)
    if isinstance(poses, Mapping):
        raise SatcheckError("bad-pose", "a path is a list of poses: [{...}, {...}]", file=file)
    return poses


def _text(path: str) -> str:
    try:
        return read_whole(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise SatcheckError("bad-encoding", "the file of poses is not UTF-8", file=path) from None
    except SatcheckError as error:
        hint = ""
        if error.code == "file-not-found":
            hint = ': give a file of poses (JSON, or CSV of a path), or values, {"joint": value}; '
            hint += "--state takes names of states"
        raise SatcheckError(error.code, error.message + hint, file=path) from None


def _once(members: list[tuple[str, Any]]) -> dict[str, Any]:
    values = dict(members)
    if len(values) < len(members):
        raise ValueError("a joint is named twice in one pose")
    return values


def _pose(document: Any, what: str, file: str | None) -> Pose:
    if not isinstance(document, dict):
        raise _bad(f'{what} should be an object {{"joint": value}}', file)
    return {name: _values(name, value, what, file) for name, value in document.items()}


def _values(name: str, value: Any, what: str, file: str | None) -> Values:
    numbers = value if isinstance(value, list) else [value]
    if not numbers or not all(type(number) in (int, float) for number in numbers):
        raise _bad(f"{what}: joint {name!r} should be a number or a list of numbers", file)
    try:
        values = tuple(float(number) for number in numbers)
    except OverflowError:
        values = (math.inf,)
    if not all(map(math.isfinite, values)):
        raise _bad(f"{what}: joint {name!r} is not finite", file)
    return values


def _bad(message: str, file: str | None) -> SatcheckError:
    return SatcheckError("bad-pose", message if file else f"--pose: {message}", file=file)


def _read_table(file: str) -> list[Pose]:
    text = _text(file)
    head = text.partition("\n")[0]
    separator = next((mark for mark in (",", ";", "\t") if mark in head), ",")
    rows = csv.reader(text.splitlines(), delimiter=separator, skipinitialspace=True)
    lines = [(number, [cell.strip() for cell in row]) for number, row in enumerate(rows, 1)]
    filled = [(number, row) for number, row in lines if any(row)]
    if len(filled) < 3:
        message = "a path needs a line with the names of joints, and two lines of values below it"
        raise _bad(message, file)
    first, names = filled[0]
    if len(set(names)) < len(names) or not all(names):
        raise _bad(f"line {first}: a column has no name, or two have one", file)
    return [_row(names, row, f"line {number}", file) for number, row in filled[1:]]


def _row(names: Sequence[str], row: Sequence[str], where: str, file: str) -> Pose:
    if len(row) != len(names):
        raise _bad(f"{where}: {len(row)} values for {len(names)} columns", file)
    pose = {}
    for name, cell in zip(names, row, strict=True):
        try:
            value = float(cell)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise _bad(f"{where}: {name}: {cell!r} is no finite number", file)
        pose[name] = (value,)
    return pose


class RandomPoses(Sequence[Pose]):
    """`count` random poses, uniform within the limits. A rotating joint without limits is in
    [-pi, pi].

    Each value is rounded to six significant digits. A longer list starts with the poses of a
    shorter one. The poses are the same on every machine and version of Python. Joints in `fixed`
    keep those values. Sliding joints without limits, planar and floating joints stay at 0. Mimics
    follow their leaders. The poses are drawn again each time they are visited, so that they need
    no memory.
    """

    def __init__(
        self, robots: Sequence[Robot], count: int, seed: int, fixed: Pose | None = None
    ) -> None:
        joints = (joint for robot in robots for joint in robot.joints)
        self._drawn = [joint for joint in joints if joint.free and joint.freedoms == 1]
        self._count, self._seed = count, seed
        self.fixed = dict(fixed or {})

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[Pose]:
        for first, values in self.batches(_DRAWN):
            for row in range(min(_DRAWN, self._count - first)):
                yield pose_at(values, row)

    def __getitem__(self, number: Any) -> Any:
        return list(self)[number]

    def batches(self, size: int) -> Iterator[tuple[int, dict[str, Numbers]]]:
        """Yield (the number of the first pose, from 0; values of the fixed joints and of those that
        are drawn)."""
        # Random.random() is the one method whose sequence Python promises to keep. numpy continues
        # the same generator faster.
        _, state, _ = random.Random(self._seed).getstate()
        draw = np.random.RandomState()
        draw.set_state(("MT19937", np.array(state[:-1], np.uint32), state[-1], 0, 0.0))
        held = {name: values_of(own) for name, own in self.fixed.items()}
        for first in range(0, self._count, size):
            shares = draw.random_sample((min(size, self._count - first), len(self._drawn)))
            drawn = {
                joint.name: _between(*_range(joint), share)
                for joint, share in zip(self._drawn, shares.T, strict=True)
            }
            yield first, drawn | held


def values_of(numbers: Values) -> Numbers:
    """Return the value of a joint that is the same in all poses."""
    return np.array(numbers, float).reshape(-1, 1)


def pose_at(values: Mapping[str, Numbers], row: int) -> dict[str, Values]:
    """Return one of many poses."""
    return {
        name: tuple(own[:, row if own.shape[1] > 1 else 0].tolist()) for name, own in values.items()
    }


def _range(joint: Joint) -> tuple[float, float]:
    if joint.limits is not None:
        return joint.limits.lower, joint.limits.upper
    still = joint.neutral[0]
    return (still, still) if joint.kind == "prismatic" else (-math.pi, math.pi)


def _between(low: float, high: float, shares: Numbers) -> Numbers:
    return np.clip([_rounded(low + shares * (high - low))], low, high)


def _rounded(values: Numbers) -> Numbers:
    """Return the float64 of float(f"{value:.6g}") for each value: the quotient of an integer of six
    digits and a power of ten, both exact, which is rounded once."""
    sizes = np.abs(values)
    plain = (sizes >= _PLAIN[0]) & (sizes < _PLAIN[1])
    power = _POWERS[_DIGITS - 1 - np.floor(np.log10(np.where(plain, sizes, 1.0))).astype(int)]
    scaled = sizes * power
    rounded: Numbers = np.copysign(np.rint(scaled) / power, values)
    for row in np.flatnonzero(~plain | (np.abs(scaled % 1.0 - 0.5) < _NEAR_MIDDLE)):
        rounded[row] = float(f"{float(values[row]):.{_DIGITS}g}")
    return rounded
