"""What the core says of its parameters, and of arguments that do not fit."""

import inspect
from typing import Any

import numpy as np
import pytest

from satcheck import core
from satcheck.core import Box, Capsule, Ellipsoid, Hull, Mesh, Sphere

BOX, BALL = Box((1, 1, 1)), Sphere(1.0)
POINTS = np.zeros((3, 3))
CORNERS = np.zeros((1, 3), np.int32)
INDEX, POSES = np.zeros(1, np.uint32), np.array([[0.0, 0, 0, 0, 0, 0, 1]])


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("Mesh", "vertices triangles"),
        ("Hull", "points"),
        ("Box", "half_extents"),
        ("Sphere", "radius"),
        ("Capsule", "radius half_height"),
        ("Cylinder", "radius half_height"),
        ("Cone", "radius half_height"),
        ("Ellipsoid", "radii"),
        ("check_pair", "a b pose_a pose_b query method enough"),
        ("compare_signed_distance", "a b length pose_a pose_b"),
        ("check_pairs", "shapes index_a index_b poses_a poses_b query method threads"),
    ],
)
def test_the_signature_names_the_parameters(name: str, parameters: str) -> None:
    thing = getattr(core, name)
    assert list(inspect.signature(thing).parameters) == parameters.split()
    assert inspect.getdoc(thing)


def test_the_order_of_a_quaternion_is_stated() -> None:
    assert "qx, qy, qz, qw" in (core.check_pair.__doc__ or "")
    assert "qx, qy, qz, qw" in (core.check_pairs.__doc__ or "")


def test_the_last_number_of_a_pose_is_w() -> None:
    rod = Capsule(0.25, 2.0)
    half = 0.5**0.5
    lying = (0, 0, 0, half, 0, 0, half)  # a quarter turn about x
    assert core.check_pair(rod, BALL, lying, (0, 3, 0)).outcome == "penetrating"
    assert core.check_pair(rod, BALL, lying, (0, 0, 3)).outcome == "separated"


@pytest.mark.parametrize(
    ("callee", "arguments", "named", "words"),
    [
        (Box, (), {}, r"Box\(half_extents\): half_extents is missing"),
        (Box, (1, 2), {}, r"Box\(half_extents\): 2 arguments given"),
        (Box, (), {"size": 1}, r"Box\(half_extents\): no argument is named size"),
        (Box, ((1, 1, 1),), {"half_extents": 1}, "half_extents is given twice"),
        (Box, ((1, 2),), {}, r"Box: half_extents: three numbers expected, got \(1, 2\)"),
        (Ellipsoid, ("xyz",), {}, "Ellipsoid: radii: three numbers expected, got 'xyz'"),
        (Sphere, ("1",), {}, "Sphere: radius: a number expected, got '1'"),
        (Capsule, (1,), {}, r"Capsule\(radius, half_height\): half_height is missing"),
        (Hull, (np.zeros((3, 2)),), {}, "rows of three numbers .* got float64 of shape"),
        (Hull, (list(range(99)),), {}, "Polytope expected, got list"),
        (Mesh, ([[0, 0, 0]], CORNERS), {}, r"Mesh: vertices: .*float64 expected, got \[\[0, 0"),
        (Mesh, (POINTS.astype("f4"), CORNERS), {}, r"got float32 of shape \(3, 3\)$"),
        (Mesh, (POINTS.T, CORNERS), {}, r"float64 of shape \(3, 3\), not C-contiguous$"),
        (Mesh, (POINTS, CORNERS[:, :2].copy()), {}, r"triangles: .* int32 of shape \(1, 2\)$"),
        (Mesh, (POINTS, CORNERS.astype(float)), {}, "triangles: .*uint32 expected, got float64"),
        (core.check_pair, (1, BALL), {}, "a: a convex shape expected, got 1"),
        (core.check_pair, (BOX, None), {}, "b: a convex shape expected, got None"),
        (core.check_pair, (BOX, BALL, ["x"]), {}, r"pose_a: \(tx, ty, tz\) or .* got \['x'\]"),
        (core.check_pair, (BOX, BALL), {"query": 3}, "query: 'overlap' or .* expected, got 3"),
        (core.check_pair, (BOX,), {}, "missing 1 required positional argument: 'b'"),
        (core.compare_signed_distance, (BOX, BALL, "1"), {}, "length: a number expected"),
        (core.check_pairs, ([1], INDEX, INDEX, POSES, POSES), {}, "shapes: a sequence of convex"),
        (core.check_pairs, ([BOX], [0], INDEX, POSES, POSES), {}, r"index_a: .* got \[0\]"),
        (core.check_pairs, ([BOX], INDEX, INDEX, POSES, POSES[:, :6]), {}, r"poses_b: .*\(1, 6\)"),
        (core.check_pairs, ([BOX], INDEX, INDEX, POSES, POSES), {"threads": -1}, "threads: an int"),
    ],
)
def test_what_does_not_fit_is_said_in_words(
    callee: Any, arguments: tuple[Any, ...], named: dict[str, Any], words: str
) -> None:
    with pytest.raises(TypeError, match=words) as refused:
        callee(*arguments, **named)
    assert "incompatible" not in str(refused.value)
