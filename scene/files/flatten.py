"""Joins the meshes of a file, each at its placement, into one."""

from __future__ import annotations

from collections.abc import Sequence
from operator import mul

from satcheck.core import Mesh, largest_stretch
from satcheck.core.transform import Transform
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.raw_mesh import (
    NO_SURFACE,
    Block,
    RawMesh,
    RawNode,
    RawScene,
    Refusal,
)
from satcheck.scene.issue import BLOCKING

_SHAPES = "it has exact shapes, which no mesh holds: name one part of the file"
_SPLIT = "check its nodes as bodies of their own (--split nodes), or split the file"


def flattened(scene: RawScene) -> RawMesh:
    """Return one mesh of all nodes.

    A mesh of lines or points only adds a warning. Raises Refused if another mesh cannot be
    used, or if all together exceed the triangle limit.
    """
    if scene.nodes == (RawNode(None, 0),) and not scene.warnings:
        only = scene.parts[0].mesh
        if isinstance(only, RawMesh):
            return only
    said = list(scene.warnings)
    placed: list[tuple[RawMesh, Transform | None]] = []
    for node in scene.nodes:
        mesh = scene.parts[node.part].mesh
        if isinstance(mesh, RawMesh):
            placed.append((mesh, node.matrix))
        elif not isinstance(mesh, Refusal):
            raise Refused("unsupported-feature", _SHAPES)
        elif mesh.code == NO_SURFACE and len(scene.nodes) > 1:
            said.append(("ignored-geometry", mesh.message))
        else:
            raise Refused(mesh.code, mesh.message)
    if not placed:
        raise Refused("empty-mesh", "empty mesh: no node has a surface")
    meshes = [mesh for mesh, _ in placed]
    for most, what, count in (
        (limits.MAX_TRIANGLES, "triangles", sum(len(mesh.triangles) // 12 for mesh in meshes)),
        (limits.MAX_VERTICES, "vertices", sum(len(mesh.vertices) // 24 for mesh in meshes)),
    ):
        if count > most:
            message = f"{count} {what} in all instances exceed {most}: {_SPLIT}"
            raise Refused("too-large", message)
    vertices, triangles = concatenate(
        [(mesh.vertices, mesh.triangles, matrix) for mesh, matrix in placed]
    )
    said += [warning for mesh in meshes for warning in mesh.warnings]
    # The last warning of each code, but all that block a pass.
    once = {(code, text if code in BLOCKING else ""): (code, text) for code, text in said}
    stretches = [1.0 if matrix is None else largest_stretch(matrix) for _, matrix in placed]
    return RawMesh(
        vertices=vertices,
        triangles=triangles,
        number_format=meshes[0].number_format,
        decimals=max(mesh.decimals for mesh in meshes),
        significant=max(mesh.significant for mesh in meshes),
        units=meshes[0].units,
        warnings=tuple(once.values()),
        surface_tolerance=max(map(mul, stretches, (m.surface_tolerance for m in meshes))),
        rounding=max(map(mul, stretches, (mesh.rounding for mesh in meshes))),
    )


def concatenate(parts: Sequence[tuple[Block, Block, Transform | None]]) -> tuple[Block, Block]:
    """Return (vertices, triangles) of all parts, each transformed by its matrix.

    parts: float64 vertices and uint32 triangles as in RawMesh. A mirroring matrix flips the
    winding.
    """
    if len(parts) == 1 and parts[0][2] is None:
        return parts[0][:2]
    if not parts:
        return b"", b""
    import numpy as np

    vertices, triangles, before = [], [], 0
    for points, corners, matrix in parts:
        mesh = Mesh.from_bytes(points, corners)
        try:
            mesh = mesh if matrix is None else mesh.transformed(matrix)
        except (OverflowError, ValueError) as error:
            code = "out-of-range" if isinstance(error, OverflowError) else "singular-transform"
            raise Refused(code, f"a part cannot be placed: {error}") from None
        vertices.append(mesh.vertices)
        triangles.append(mesh.triangles + np.uint32(before))
        before += mesh.vertex_count
    return np.concatenate(vertices).data.cast("B"), np.concatenate(triangles).data.cast("B")
