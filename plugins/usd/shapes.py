"""The shapes of USD that have sizes: curved ones as exact shapes with their axis along z, flat ones
as triangles."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf

from satcheck.core.curved.placed import curved_shape
from satcheck.core.rounding import ORTHOGONALITY
from satcheck.core.shape_mesh import mesh_around, mesh_of, sag_of
from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, HalfSpace, Primitive, Sphere
from satcheck.core.transform import Transform
from satcheck.plugins.usd.walk import type_of
from satcheck.scene.document import RawMesh
from satcheck.scene.errors import Refused

# Many programs write rotations and scales as float32. A placement this close to one of a shape is
# one; a share of the size of the shape.
FLOAT32_NOISE = 1e-6

_SEGMENTS = 128  # of a circle, where facets stand for a shape: 0.1 % of its radius off


# Rows for row vectors: exact quarter turns that take z to the axis.
_TURNS = {
    "X": Gf.Matrix4d(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1),
    "Y": Gf.Matrix4d(0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1),
    "Z": Gf.Matrix4d(1.0),
}


def shape_of(
    prim: Any, time: Any, unit: str, *, endless: bool
) -> tuple[Primitive | RawMesh, Any] | None:
    """(the shape, the turn to its axis as a matrix for row vectors); None: it is no such shape.

    endless: a plane is a half space. Raises Refused for sizes that make no shape, for two different
    radii, and for an axis other than X, Y and Z.
    """
    size = partial(_number, prim, time)
    try:
        match type_of(prim):
            case "Sphere":
                return Sphere(size("radius")), _TURNS["Z"]
            case "Cube":
                return _flat(mesh_of(Box((size("size"),) * 3)).to_bytes(), unit)
            case "Plane" if not endless:
                return _flat(_quad(prim, time), unit)
            case "Plane":
                shape: Primitive = HalfSpace()
            case "Cylinder":
                shape = Cylinder(size("radius"), size("height"))
            case "Cone":
                shape = Cone(size("radius"), size("height"))
            case "Capsule":
                shape = Capsule(size("radius"), size("height"))
            case "Cylinder_1" | "Capsule_1":
                shape = _of_two_radii(prim, size)
            case _:
                return None
    except ValueError as error:
        raise Refused("bad-record", f"{type_of(prim)}: {error}") from None
    return shape, _TURNS[_axis(prim, time)]


def _flat(faces: tuple[bytes, bytes], unit: str) -> tuple[RawMesh, Any]:
    """Triangles are exact. Their precision is that of float32, in which most files scale them."""
    return RawMesh(*faces, "float32", units=unit), _TURNS["Z"]


def _axis(prim: Any, time: Any) -> str:
    axis = str(prim.GetAttribute("axis").Get(time))
    if axis not in _TURNS:
        raise Refused("bad-record", f"{type_of(prim)}: axis is {axis!r}, not X, Y or Z")
    return axis


def _of_two_radii(prim: Any, size: Any) -> Primitive:
    form = Cylinder if type_of(prim) == "Cylinder_1" else Capsule
    bottom, top = size("radiusBottom"), size("radiusTop")
    if bottom == top:
        return form(bottom, size("height"))
    if form is Cylinder and top == 0:
        return Cone(bottom, size("height"))
    message = f"a {form.__name__.lower()} of two radii: convert it to a Mesh"
    raise Refused("unsupported-feature", message)


def _quad(plane: Any, time: Any) -> tuple[bytes, bytes]:
    """The extents along the axes follow the schema of UsdGeomPlane."""
    half = [_number(plane, time, name) / 2 for name in ("width", "length")]
    along = {"X": (2, 1), "Y": (0, 2), "Z": (0, 1)}[_axis(plane, time)]
    corners = np.zeros((4, 3), "<f8")
    for axis, extent, signs in zip(along, half, ((-1, 1, 1, -1), (-1, -1, 1, 1)), strict=True):
        corners[:, axis] = np.multiply(signs, extent)
    return corners.tobytes(), np.array([0, 1, 2, 0, 2, 3], "<u4").tobytes()


def _number(prim: Any, time: Any, name: str) -> float:
    value = prim.GetAttribute(name).Get(time)
    if not isinstance(value, float | int):
        raise Refused("bad-record", f"{type_of(prim)}: {name} is no number")
    return float(value)


def placed_shape(shape: Primitive, matrix: Transform) -> Transform:
    """The placement without the rounding of float32, which would skew the shape.

    matrix: row-major 4x4 for column vectors. The nearest rotation replaces one that is off by
    rounding, and scales that differ by rounding become equal. Raises ValueError if the image is no
    shape of this kind.
    """
    columns = np.array(matrix).reshape(4, 4)[:3, :3]
    scales = np.linalg.norm(columns, axis=0)
    if not (np.isfinite(scales).all() and scales.min() > 0):
        return matrix  # refused where bodies are placed
    axes = columns / scales
    skew = np.abs(axes.T @ axes - np.eye(3)).max()
    if skew > FLOAT32_NOISE:
        kind = type(shape).__name__.lower()
        raise ValueError(f"a {kind} sheared is no {kind}")
    if skew > ORTHOGONALITY / 2:
        left, _, right = np.linalg.svd(axes)
        axes = left @ right
    even = scales.copy()
    if _are_even(scales):
        even[:] = scales.mean()
    elif not isinstance(shape, Sphere) and _are_even(scales[:2]):
        even[:2] = scales[:2].mean()
    if skew > ORTHOGONALITY / 2 or (even != scales).any():
        placed = np.array(matrix).reshape(4, 4)
        placed[:3, :3] = axes * even
        matrix = tuple(placed.ravel().tolist())
    curved_shape(shape, matrix)
    return matrix


def _are_even(scales: NDArray[np.float64]) -> bool:
    return bool(scales.max() - scales.min() <= FLOAT32_NOISE * scales.max())


def facets_around(shape: Primitive, unit: str) -> RawMesh:
    """A mesh that contains the shape, with its distance from it as surface tolerance. So bodies
    that are apart from it are apart from the shape."""
    mesh = mesh_around(shape, _SEGMENTS)
    inner = np.asarray(mesh_of(shape, _SEGMENTS).vertices)
    off = np.linalg.norm(np.asarray(mesh.vertices) - inner, axis=1).max() + sag_of(shape, _SEGMENTS)
    vertices, triangles = mesh.to_bytes()
    return RawMesh(vertices, triangles, "float32", units=unit, surface_tolerance=float(off))
