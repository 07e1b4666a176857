"""How far the rounding of coordinates may move a vertex, in the file and in the world."""

from __future__ import annotations

import math
import sys
from fractions import Fraction
from itertools import product
from random import Random

import pytest

from satcheck.core import largest_placed, largest_stretch
from satcheck.scene import Body, load_scene
from satcheck.scene.document import RawMesh
from satcheck.scene.inspect import (
    FLOAT32_STEP,
    FLOAT64_STEP,
    VERTEX,
    file_resolution,
    placement_step,
)
from tests.fits.files import Placing
from tests.scene import files, graphs
from tests.scene.loading import loaded


def raw(number_format, decimals=0, significant=0, rounding=0.0):
    return RawMesh(b"", b"", number_format, decimals, significant, rounding=rounding)


@pytest.mark.parametrize(
    ("mesh", "largest", "resolution"),
    [
        (raw("float32"), 8.0, 2.0**-20),
        (raw("float64"), 8.0, 2.0**-46),
        (raw("written-digits", decimals=1), 8.0, 2.0**-20),  # never coarser than float32
        (raw("written-digits", decimals=9), 8.0, VERTEX * 0.5e-9 + 2.0**-46),
        (raw("written-digits", decimals=30), 8.0, 2.0**-46),  # never finer than float64
        (raw("written-digits", significant=7), 8.0, VERTEX * 0.5e-6 + 2.0**-46),
        (raw("written-digits", significant=7), 0.9, VERTEX * 0.5e-7 + 0.9 * 2.0**-49),
        (raw("written-digits", decimals=9, significant=3), 8.0, VERTEX * 0.5e-9 + 2.0**-46),
        (raw("written-digits", decimals=3), 0.0, 0.0),
        (raw("float32", rounding=0.25), 8.0, VERTEX * 0.25),
        (raw("float32", rounding=2.0**-30), 8.0, 2.0**-20),
    ],
)
def test_file_resolution(mesh, largest, resolution):
    assert file_resolution(mesh, largest) == pytest.approx(resolution, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(
    ("number_format", "by_file", "step"),
    [
        ("float32", True, FLOAT32_STEP),
        ("float32", False, FLOAT64_STEP),
        ("written-digits", True, FLOAT64_STEP),
    ],
)
def test_placements_are_known_as_finely_as_the_file_stores_coordinates(
    number_format, by_file, step
):
    assert placement_step(raw(number_format), by_file=by_file) == step


def test_a_node_far_out_is_known_no_finer_than_float32_there(tmp_path):
    """As if the file stored the placed coordinates."""
    nodes = [{"mesh": 0, "translation": [1000, 0, 0]}]
    path = tmp_path / "a.glb"
    path.write_bytes(graphs.glb(nodes))
    (body,) = load_scene([path]).bodies
    (flat,) = load_scene([path], split="none").bodies
    assert flat.resolution_world == 1001 * FLOAT32_STEP
    assert body.resolution_world == 1001 * FLOAT32_STEP + FLOAT32_STEP


def test_noise_with_an_exponent_does_not_promise_its_decimals(tmp_path):
    noisy = files.obj().replace(b"v 0 0 0\n", b"v -4.37114e-08 0 0\n")
    assert loaded(tmp_path, "a.obj", noisy).resolution == 2.0**-23


def test_formats(tmp_path):
    assert loaded(tmp_path, "a.stl", files.binary_stl()).resolution == 2.0**-23
    assert loaded(tmp_path, "a.glb", files.glb()).resolution == 2.0**-23
    assert loaded(tmp_path, "a.ply", files.binary_ply()).resolution == 2.0**-23
    assert loaded(tmp_path, "b.ply", files.binary_ply(double=True)).resolution == 2.0**-49
    digits = files.obj().replace(b"v 1 1 1\n", b"v 1.000000000 1 1\n")
    assert loaded(tmp_path, "a.obj", digits).resolution == VERTEX * 0.5e-9 + 2.0**-49
    model = files.object_3mf(1).replace('x="1"', 'x="1.00000000"')
    assert loaded(tmp_path, "a.3mf", files.threemf(model)).resolution == VERTEX * 0.5e-8 + 2.0**-49


def needle_out(far):
    """The cube with one corner pulled far out."""
    return [(far, far, -far) if point == (1, 1, 1) else point for point in files.CUBE_POINTS]


def test_a_far_vertex_that_makes_the_precision_coarse_is_named(tmp_path):
    file = loaded(tmp_path, "a.ply", files.binary_ply(needle_out(4096.0)))
    assert file.resolution == 4096 * FLOAT32_STEP
    ((code, message),) = ((issue.code, issue.message) for issue in file.issues)
    assert code == "far-vertex"
    assert "the vertex (4096, 4096, -4096) makes the precision 0.000488" in message
    assert "beyond 1" in message
    digits = files.obj(needle_out(4096.0))
    assert [issue.code for issue in loaded(tmp_path, "a.obj", digits).issues] == ["far-vertex"]


def test_no_vertex_is_named_that_costs_little(tmp_path):
    for name, content in (
        ("a.ply", files.binary_ply(needle_out(15.0))),
        ("b.ply", files.binary_ply(needle_out(4096.0), double=True)),
        ("c.ply", files.integer_ply("ascii", needle_out(4096))),
        ("d.ply", files.binary_ply([(x + 4096.0, y, z) for x, y, z in files.CUBE_POINTS])),
    ):
        assert loaded(tmp_path, name, content).issues == ()


def test_placing_a_body_in_float64_moves_no_vertex_farther():
    """Its own origin lies within its box. Some vertex moves farther than half of the spacing."""
    rng, farthest = Random(0), 0.0
    for _ in range(300):
        x, y, z, u, v, w = (rng.uniform(-3.0, 3.0) for _ in range(6))
        shift = rng.choice([0.0, 1.0, 30.0])
        place = Placing((x, y, z), (shift * u, shift * v, shift * w))
        body = [tuple(rng.uniform(0.1, 3.0) * c for c in p) for p in product((-1, 1), repeat=3)]
        largest = max(abs(c) for p in body for c in place.of(p))
        rows = [[*map(Fraction, row)] for row in place.matrix]
        for p in body:
            errors = (
                float(at - sum(m * Fraction(c) for m, c in zip(row, p, strict=True)) - Fraction(t))
                for at, row, t in zip(map(Fraction, place.of(p)), rows, place.shift, strict=True)
            )
            farthest = max(farthest, math.hypot(*errors) / largest)
    assert 2.0**-53 < farthest <= file_resolution(raw("float64"), 1.0)


def test_rounding_to_decimals_moves_no_vertex_farther():
    """A vertex halfway between the written numbers of all three coordinates."""
    vertex = (0.1234565, 0.2345675, 0.9876545)
    written = tuple(float(f"{c:.6f}") for c in vertex)
    resolution = file_resolution(raw("written-digits", decimals=6), 100.0)
    assert 0.5e-6 * 1.7 < math.dist(vertex, written) <= resolution


@pytest.mark.parametrize("kind", ["ascii", "binary_little_endian"])
def test_integers_of_ply_are_off_by_half_the_diagonal_of_a_unit(tmp_path, kind):
    points = [(100 * x, 100 * y, 100 * z) for x, y, z in files.CUBE_POINTS]
    assert loaded(tmp_path, "a.ply", files.integer_ply(kind, points)).resolution == VERTEX * 0.5


@pytest.mark.parametrize(
    ("linear", "stretch"),
    [
        ((1, 0, 0, 0, 1, 0, 0, 0, 1), 1),
        ((0, -1, 0, 1, 0, 0, 0, 0, 1), 1),
        ((2, 0, 0, 0, -3, 0, 0, 0, 0.5), 3),
        ((1, 1, 0, 0, 1, 0, 0, 0, 1), (1 + math.sqrt(5)) / 2),  # a shear
    ],
)
def test_largest_stretch(linear, stretch):
    a, b, c = linear[:3], linear[3:6], linear[6:]
    transform = (*a, 7.0, *b, 8.0, *c, 9.0, 0.0, 0.0, 0.0, 1.0)
    assert largest_stretch(transform) == pytest.approx(stretch, rel=1e-14)


@pytest.mark.parametrize("scale", [2.0**-1000, 2.0**-400, 2.0**400, 2.0**1000])
def test_the_stretch_is_that_of_any_scale(scale):
    plain = (1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    scaled = (*(scale * entry for entry in plain[:12]), *plain[12:])
    assert largest_stretch(scaled) == scale * largest_stretch(plain)


def test_a_stretch_beyond_all_numbers_is_none():
    large = sys.float_info.max
    transform = (large, large, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    with pytest.raises(OverflowError, match="stretches lengths out of range"):
        largest_stretch(transform)


def test_the_largest_coordinate_of_what_is_placed():
    transform = (1, -2, 0.5, 7, 0, 3, 0, -50, 0, 0, 1, 0, 0, 0, 0, 1)
    assert largest_placed(transform, 4.0) == 3 * 4 + 50
    assert largest_placed(transform, 400.0) == 3.5 * 400 + 7


def test_world_resolution_adds_the_rounding_of_the_placement(tmp_path):
    file = loaded(tmp_path, "a.stl", files.binary_stl())
    assert Body("a", "a", file).resolution_world == 2.0**-23
    far = (2.0, 0.0, 0.0, 1e9, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    expected = 2.0 * 2.0**-23 + (1e9 + 2) * 2.0**-49
    assert Body("a", "a", file, far).resolution_world == pytest.approx(expected, rel=1e-12, abs=0.0)
