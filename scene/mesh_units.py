"""Converts between coordinates of a file and of its mesh: file = mesh * 2**MeshFile.exponent."""

from __future__ import annotations

from satcheck.core.shapes import times_power_of_two
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY, MeshFile
from satcheck.scene.common_units import scaled_mesh
from satcheck.scene.errors import MeshFileError
from satcheck.scene.planar.outline import Outline, Shape


def placing_mesh(file: MeshFile | MeshFileError, transform: Transform | None) -> Transform | None:
    """The transform for the mesh that corresponds to `transform` for file coordinates."""
    if isinstance(file, MeshFileError):
        return transform
    return scaled_mesh(transform, 2.0**file.exponent)


def placing_file(file: MeshFile, transform: Transform | None) -> Transform | None:
    """The inverse of `placing_mesh`."""
    if file.exponent == 0:
        return transform
    placement = scaled_mesh(transform, 2.0**-file.exponent)
    return None if placement == IDENTITY else placement


def shape_of_mesh(file: MeshFile, shape: Shape | None) -> Shape | None:
    """A shape of the file, in units of its mesh."""
    return _scaled(shape, -file.exponent)


def shape_of_file(file: MeshFile, shape: Shape | None) -> Shape | None:
    """The inverse of `shape_of_mesh`."""
    return _scaled(shape, file.exponent)


def _scaled(shape: Shape | None, exponent: int) -> Shape | None:
    if shape is None or exponent == 0 or isinstance(shape, Outline):
        return shape
    return times_power_of_two(shape, exponent)
