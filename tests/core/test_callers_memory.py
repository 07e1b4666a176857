"""What the core keeps of its caller, and what it refuses before it computes."""

from __future__ import annotations

import gc
import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Literal, TypeVar, overload

import numpy as np
import pytest

from satcheck import core

T = TypeVar("T")
CUBE = core.Mesh(
    np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)]),
    np.array(
        [
            *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]),
            *([2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
        ],
        np.uint32,
    ),
)
EMPTY = core.Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.uint32))
HALF_TURN = (0.0, 0.0, 0.6, 0.8)


def beside(k: int) -> core.PlacedGeometry:
    return core.PlacedGeometry(core.Geometry(CUBE.translated((0.5 * k, 0, 0)), True), None, None, 0)


def test_a_batch_keeps_its_bodies_when_the_caller_drops_them() -> None:
    bodies = [beside(k) for k in range(12)]
    pairs = [(a, b, 0.0, 0.0, 0.0, 0.0, True) for a, b in pairwise(bodies)]
    climbing = core.Climbing(pairs, threads=1)
    pairs.clear()
    bodies.clear()
    gc.collect()
    junk = [np.full(20_000, 7.7) for _ in range(20)]
    climbs = climbing.results()
    del junk
    assert [climb and climb.relation for climb in climbs] == ["penetrating"] * 11


class Passing(Sequence[T]):
    """Makes an item each time that it is asked, and keeps none."""

    def __init__(self, make: Callable[[], T], count: int) -> None:
        self.make, self.length, self.asked = make, count, 0

    def __len__(self) -> int:
        return self.length

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[T]: ...
    def __getitem__(self, index: int | slice) -> T | Sequence[T]:
        if isinstance(index, slice) or index >= self.length:
            raise IndexError(index)
        self.asked += 1
        return self.make()


def test_a_sequence_of_bodies_is_read_once_and_its_items_are_held() -> None:
    shapes = Passing(lambda: core.Hull(CUBE.convex_hull()), 2)
    indices = np.array([0, 1], np.uint32)
    poses = np.zeros((2, 7))
    poses[:, 6] = 1
    results = core.check_pairs(shapes, indices, indices[::-1].copy(), poses, poses, query="overlap")
    assert list(results.outcome) == [2, 2]
    assert shapes.asked == 2
    meshes = Passing(lambda: CUBE.translated((1.0, 2.0, 3.0)), 1)
    moved = core.placed_bounds(meshes, [np.eye(4).ravel().tolist()])
    assert moved == [((1.0, 2.0, 3.0), (2.0, 3.0, 4.0))]
    assert meshes.asked == 1


def test_an_empty_mesh_is_no_surface_and_no_body() -> None:
    for solid in (False, True):
        with pytest.raises(ValueError, match="without triangles"):
            core.Surface(EMPTY, solid)
        with pytest.raises(ValueError, match="empty mesh"):
            core.Geometry(EMPTY, solid)


@pytest.mark.parametrize("length", [1e160, 1e-156, 1e308, 5e-324, 1.0])
@pytest.mark.parametrize("query", ["overlap", "depth", "distance"])
def test_a_quaternion_of_any_length_turns(
    length: float, query: Literal["overlap", "depth", "distance"]
) -> None:
    box, ball = core.Box((1, 1, 1)), core.Sphere(1.0)
    pose = (100.0, 0.0, 0.0, *(c * length for c in HALF_TURN))
    for shape in (box, ball):
        result = core.check_pair(shape, shape, None, pose, query=query)
        assert result.outcome == "separated"
        if query == "distance" and length > 1e-300:
            plain = core.check_pair(shape, shape, None, (100.0, 0.0, 0.0, *HALF_TURN), query=query)
            # Each component is off by a roundoff, and so is the turn; nothing is farther than 2.
            assert result.distance == pytest.approx(plain.distance, abs=16 * 2.0**-53 * 100)


def test_a_quaternion_of_length_0_or_nan_is_refused() -> None:
    for quaternion in ((0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0)):
        with pytest.raises(ValueError, match="pose"):
            core.check_pair(core.Sphere(1.0), core.Sphere(1.0), None, (0.0, 0.0, 0.0, *quaternion))


def test_bounds_that_do_not_hold_the_mesh_are_refused() -> None:
    shared = core.Geometry(CUBE, True)
    right = core.PlacedGeometry(shared, None, CUBE.bounds, 0.0)
    wrong = core.PlacedGeometry(shared, None, ((10, 10, 10), (11, 11, 11)), 0.0)
    assert core.climb((right, right, 0.0, 0.0, 0.0, 0.0, False)).relation == "coincident"
    with pytest.raises(ValueError, match="bounds"):
        core.climb((right, wrong, 0.0, 0.0, 0.0, 0.0, False))


def test_bytes_that_are_written_later_change_no_mesh() -> None:
    vertices, triangles = CUBE.to_bytes()
    fixed = core.inspect_bytes(vertices, triangles, True)
    buffers = np.frombuffer(vertices, np.uint8).copy(), np.frombuffer(triangles, np.uint8).copy()
    written = core.inspect_bytes(buffers[0].data, buffers[1].data, True)
    for buffer in buffers:
        buffer[:] = 0
    assert written.mesh.to_bytes() == fixed.mesh.to_bytes()
