"""The mesh file that stands for a primitive shape."""

from __future__ import annotations

import pytest

from satcheck.core.shapes import Box, Capsule, Cylinder, Primitive, Sphere
from satcheck.scene import Refused
from satcheck.scene.inspect import shape_file


def test_a_box_is_a_file_of_its_own():
    file = shape_file(Box((1.0, 2.0, 3.0)), "cell.toml")
    assert (file.path, file.format, file.units, file.issues) == ("cell.toml", "shape", None, ())
    assert file.health.solid
    assert file.resolution == 1.5 * 2.0**-49


def test_the_hash_is_that_of_the_sizes():
    first, same, other = (
        shape_file(Box(size), path)
        for size, path in (((1.0, 2.0, 3.0), "a"), ((1, 2, 3), "b"), ((1.0, 2.0, 4.0), "a"))
    )
    assert first.sha256 == same.sha256 != other.sha256
    assert len(first.sha256) == 64


@pytest.mark.parametrize(
    "shape",
    [
        Box((1e46, 1.0, 1.0)),
        Box((1.0, 1.0, 5e-324)),
        Sphere(1e-46),
        Cylinder(1.0, 1e300),
        Capsule(1e45, 1e45),
    ],
)
def test_sizes_out_of_range_are_refused(shape: Primitive) -> None:
    with pytest.raises(Refused, match="out of range") as caught:
        shape_file(shape, "cell.toml")
    assert (caught.value.code, caught.value.file) == ("out-of-range", "cell.toml")


@pytest.mark.parametrize("size", [1e-45, 1e45])
def test_sizes_at_the_ends_of_the_range(size: float) -> None:
    file = shape_file(Box((size, size, size)), "cell.toml")
    assert file.mesh.bounds == ((-size / 2,) * 3, (size / 2,) * 3)
    assert file.health.volume == pytest.approx(size**3)


def test_the_mesh_of_a_curved_shape_is_within_it():
    low, high = shape_file(Sphere(2.0), "cell.toml").mesh.bounds
    assert (low, high) == ((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0))
