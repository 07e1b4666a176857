"""Position, rotation and scale -> transform, held against rotations written down by hand."""

from __future__ import annotations

import math

import pytest

from satcheck.core.transform import quaternion_matrix
from satcheck.scene.scene_file.document import Body, euler_matrix, quaternion_of_euler
from satcheck.scene.scene_file.form import converted
from satcheck.scene.table import Wrong

HALF = math.sqrt(0.5)
# A product of three cosines and sines, each within an ulp of its value.
ROUNDING = 8 * 2.0**-53


def placed(**keys):
    return converted({"id": "a", "mesh": "a.obj", **keys}, Body).placement()


def apply(transform, point):
    x, y, z = point
    rows = (transform[4 * k : 4 * k + 4] for k in range(3))
    return tuple(a * x + b * y + c * z + t for a, b, c, t in rows)


def test_nothing_said_is_as_in_the_file():
    assert placed() is None
    assert placed(groups=["g"]) is None


def test_position_alone():
    assert apply(placed(position=[1, 2.5, -3]), (1, 1, 1)) == (2.0, 3.5, -2.0)


@pytest.mark.parametrize(
    ("euler", "image"),
    [
        ([90, 0, 0], (1, -3, 2)),
        ([0, 90, 0], (3, 2, -1)),
        ([0, 0, 90], (-2, 1, 3)),
        ([90, 90, 0], (2, -3, -1)),  # x first: (1, -3, 2), then y: (2, -3, -1)
        ([90, 0, 90], (3, 1, 2)),
        ([-270, 360, 540], (-1, 3, 2)),
    ],
)
def test_quarter_turns_are_exact_and_about_fixed_axes(euler, image):
    assert apply(placed(euler=euler), (1, 2, 3)) == image


def test_scaled_then_turned_then_moved():
    made = placed(scale=[2, 3, 4], euler=[0, 0, 90], position=[10, 0, 0])
    assert apply(made, (1, 1, 1)) == (7, 2, 4)
    assert apply(placed(scale=-2), (1, 2, 3)) == (-2, -4, -6)


@pytest.mark.parametrize("length", [1.0, 2.0, 1e-200, 1e200])
def test_a_quaternion_of_any_length_is_w_x_y_z(length):
    turned = placed(quaternion=[HALF * length, 0, 0, HALF * length])
    assert apply(turned, (1, 2, 3)) == pytest.approx((-2, 1, 3), abs=ROUNDING)
    assert apply(placed(quaternion=[0, length, 0, 0]), (1, 2, 3)) == (1, -2, -3)


@pytest.mark.parametrize("euler", [(10, 20, 30), (-170, 85, 3.5), (0, 90, 45), (720, -90, 1)])
def test_euler_angles_and_their_quaternion_are_one_rotation(euler):
    matrix = euler_matrix(euler)
    x, y, z, w = quaternion_of_euler(euler)
    assert quaternion_matrix(x, y, z, w) == pytest.approx(matrix, abs=ROUNDING)
    columns = [matrix[k::3] for k in range(3)]
    for i, a in enumerate(columns):
        for j, b in enumerate(columns):
            product = sum(p * q for p, q in zip(a, b, strict=True))
            assert product == pytest.approx(float(i == j), abs=ROUNDING)


def test_a_matrix_is_taken_as_it_is():
    rows = [[0, -1, 0, 1.5], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
    assert placed(matrix=rows) == tuple(float(v) for row in rows for v in row)


IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
WRONG = {
    "two numbers": ({"position": [1, 2]}, "a list of 3 expected, not a list of 2"),
    "no list": ({"position": 1}, "a list expected, not 1"),
    "text": ({"position": [1, "2", 3]}, "a number expected, not '2'"),
    "bool": ({"euler": [1, True, 3]}, "a number expected, not true"),
    "nan": ({"position": [1, math.nan, 3]}, "a finite number expected"),
    "huge": ({"position": [1, 10**400, 3]}, "a finite number expected"),
    "quaternion of three": ({"quaternion": [1, 0, 0]}, "a list of 4 expected, not a list of 3"),
    "quaternion of zero": ({"quaternion": [0, 0, 0, 0]}, "a quaternion must not be zero"),
    "two turns": ({"quaternion": [1, 0, 0, 0], "euler": [0, 0, 0]}, "remove this key"),
    "matrix and position": ({"matrix": IDENTITY, "position": [0, 0, 0]}, "remove this key"),
    "matrix and scale": ({"matrix": IDENTITY, "scale": 2}, "remove this key"),
    "3x4": ({"matrix": IDENTITY[:3]}, "a list of 4 expected, not a list of 3"),
    "projective": ({"matrix": [*IDENTITY[:3], [0, 0, 1, 1]]}, "the last row"),
    "flat": ({"matrix": [*IDENTITY[:2], [1, 1, 0, 0], IDENTITY[3]]}, "flattens space"),
    "zero row": ({"matrix": [*IDENTITY[:2], [0, 0, 0, 0], IDENTITY[3]]}, "scales by 0"),
    "scale 0": ({"scale": 0}, "a scale must not be 0"),
    "scale 0 along y": ({"scale": [1, 0, 1]}, "a scale must not be 0"),
    "two scales": ({"scale": [1, 2]}, "a list of at least 3 expected, not a list of 2"),
    "scale nan": ({"scale": math.nan}, "a finite number expected, not nan"),
    "needle": ({"scale": [1e-30, 1, 1], "euler": [0, 0, 45]}, "flattens space"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_places_nothing_is_refused(name):
    values, message = WRONG[name]
    with pytest.raises(Wrong) as caught:
        placed(**values)
    assert message in caught.value.message
    assert caught.value.keys[0] in values
