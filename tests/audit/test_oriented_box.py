"""The carried box holds the carried corners, for turned, mirrored and scaled bodies."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import pytest

from satcheck.audit import oriented_box

TURN = (0.36, -0.48, 0.8, 0.8, 0.6, 0.0, -0.48, 0.64, 0.6)


@dataclass
class FakeMesh:
    bounds: tuple = ((-1.0, 0.0, 2.0), (3.0, 0.5, 2.5))


@dataclass
class FakeFile:
    mesh: FakeMesh = field(default_factory=FakeMesh)


@dataclass
class FakeBody:
    transform: tuple | None
    file: FakeFile = field(default_factory=FakeFile)


class FakeBox:
    def __init__(self, half):
        self.half = half


@pytest.fixture(autouse=True)
def _fake_box(monkeypatch):
    monkeypatch.setattr(oriented_box.core, "Box", FakeBox)


def transform(columns_scale, shift, mirror=False):
    rotation = [list(TURN[3 * row : 3 * row + 3]) for row in range(3)]
    for row in range(3):
        for axis in range(3):
            rotation[row][axis] *= columns_scale[axis]
        if mirror:
            rotation[row][1] *= -1
    rows = [c for row in range(3) for c in (*rotation[row], shift[row])]
    return (*rows, 0.0, 0.0, 0.0, 1.0)


def apply(matrix, point):
    return [
        sum(matrix[4 * row + k] * point[k] for k in range(3)) + matrix[4 * row + 3]
        for row in range(3)
    ]


def into_frame(pose, point):
    """The point in the frame of the pose: rotated back by its quaternion."""
    x, y, z, w = pose[3:]
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    off = [point[k] - pose[k] for k in range(3)]
    return [sum(rows[k][axis] * off[k] for k in range(3)) for axis in range(3)]


@pytest.mark.parametrize("mirror", [False, True])
@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 3)])
@pytest.mark.parametrize("shift", [(0, 0, 0), (1e6, -3, 5)])
def test_carried_corners_lie_in_the_box_and_fill_it(mirror, scale, shift):
    matrix = transform(scale, shift, mirror)
    box, pose = oriented_box.oriented_box(FakeBody(matrix), 0.0).posed
    low, high = FakeMesh().bounds
    corners = [
        into_frame(pose, apply(matrix, corner))
        for corner in itertools.product(*zip(low, high, strict=True))
    ]
    for axis in range(3):
        reach = max(abs(corner[axis]) for corner in corners)
        assert box.half[axis] == pytest.approx(reach, abs=1e-8)
        assert reach <= box.half[axis] + 1e-16 * math.hypot(*shift)


def test_the_box_is_padded():
    matrix = transform((1, 1, 1), (0, 0, 0))
    plain, padded = (
        oriented_box.oriented_box(FakeBody(matrix), pad).posed[0].half for pad in (0.0, 0.5)
    )
    assert [q - p for p, q in zip(plain, padded, strict=True)] == pytest.approx([0.5] * 3)


STILL = oriented_box.IDENTITY
MOVED = (1.0, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1)
SHEAR = (1.0, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)


@pytest.mark.parametrize(
    ("matrix", "why"), [(STILL, "neither body is turned"), (MOVED, "neither"), (SHEAR, "shears")]
)
def test_some_boxes_say_nothing_new(matrix, why):
    one = oriented_box.oriented_box(FakeBody(matrix), 0.0)
    other = oriented_box.oriented_box(FakeBody(None), 0.0)
    assert (one.posed is None) == (why == "shears")
    assert why in oriented_box.nothing_new(one, other)
