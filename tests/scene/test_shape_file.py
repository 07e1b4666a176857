"""The mesh file that stands for a primitive shape."""

from __future__ import annotations

import math

import pytest

from satcheck.core.shapes import Box, Sphere
from satcheck.scene import MeshFileError
from satcheck.scene.shape_file import shape_file


def test_a_box_is_a_file_of_its_own():
    file = shape_file(Box((1.0, 2.0, 3.0)), "cell.toml")
    assert (file.path, file.format, file.units, file.issues) == ("cell.toml", "shape", None, ())
    assert file.health.solid
    assert file.resolution == 1.5 * 2.0**-53


def test_the_hash_is_that_of_the_sizes():
    first, same, other = (
        shape_file(Box(size), path)
        for size, path in (((1.0, 2.0, 3.0), "a"), ((1, 2, 3), "b"), ((1.0, 2.0, 4.0), "a"))
    )
    assert first.sha256 == same.sha256 != other.sha256
    assert len(first.sha256) == 64


@pytest.mark.parametrize("size", [(1e290, 1e290, 1e290), (1e-290, 1e-290, 1e-290)])
def test_sizes_beyond_what_is_decided_exactly_are_refused(size):
    with pytest.raises(MeshFileError) as caught:
        shape_file(Box(size), "cell.toml")
    assert (caught.value.code, caught.value.file) == ("out-of-range", "cell.toml")


@pytest.mark.parametrize("exponent", [-400, -160, 160, 400])
def test_a_mesh_that_the_core_can_hold(exponent):
    file = shape_file(Box((2.0**exponent, 2.0**exponent, 2.0**exponent)), "cell.toml")
    assert abs(file.exponent - exponent) <= 1
    (low, _, _), (high, _, _) = file.mesh.bounds
    assert math.ldexp(high - low, file.exponent) == 2.0**exponent
    volume = file.health.volume
    assert volume == 2.0 ** (3 * exponent) if abs(exponent) < 300 else math.isnan(volume)


def test_the_mesh_of_a_curved_shape_is_within_it():
    low, high = shape_file(Sphere(2.0), "cell.toml").mesh.bounds
    assert (low, high) == ((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0))
