"""Joins the meshes of a file, each at its placement, into one."""

from __future__ import annotations

from array import array
from collections.abc import Sequence

from satcheck.core import Mesh, largest_stretch
from satcheck.core.transform import Transform
from satcheck.scene.errors import MeshFileError
from satcheck.scene.issue import BLOCKING
from satcheck.scene.loading import limits
from satcheck.scene.loading.raw_mesh import NO_SURFACE, Block, RawMesh, RawScene, Refusal

_SHAPES = "it has exact shapes, which no mesh holds: name one part of the file"
_SPLIT = "check its nodes as bodies of their own (--split nodes), or split the file"


def flattened(scene: RawScene) -> RawMesh:
    """One mesh of all nodes.

    A mesh of lines or points only adds a warning. Raises MeshFileError if another mesh cannot be
    used, or if all together exceed the triangle limit.
    """
    warnings = list(scene.warnings)
    placed = []
    for node in scene.nodes:
        mesh = scene.parts[node.part].mesh
        if isinstance(mesh, RawMesh):
            placed.append((mesh, node.matrix))
        elif not isinstance(mesh, Refusal):
            raise MeshFileError("unsupported-feature", _SHAPES)
        elif mesh.code == NO_SURFACE:
            warnings.append(("ignored-geometry", mesh.message))
        else:
            raise MeshFileError(mesh.code, mesh.message)
    total = sum(len(mesh.triangles) // 12 for mesh, _ in placed)
    if total > limits.MAX_TRIANGLES:
        raise MeshFileError(
            "too-large",
            f"{total} triangles in all instances exceed {limits.MAX_TRIANGLES}: {_SPLIT}",
        )
    corners = sum(len(mesh.vertices) // 24 for mesh, _ in placed)
    if corners > limits.MAX_VERTICES:
        raise MeshFileError(
            "too-large",
            f"{corners} vertices in all instances exceed {limits.MAX_VERTICES}: {_SPLIT}",
        )
    meshes = [mesh for mesh, _ in placed]
    vertices, triangles = concatenate(
        [(mesh.vertices, mesh.triangles, matrix) for mesh, matrix in placed]
    )
    for mesh in meshes:
        warnings += mesh.warnings
    return RawMesh(
        vertices=vertices,
        triangles=triangles,
        number_format=meshes[0].number_format,
        decimals=max(mesh.decimals for mesh in meshes),
        significant=max(mesh.significant for mesh in meshes),
        units=meshes[0].units,
        warnings=_once(warnings),
        surface_tolerance=max(mesh.surface_tolerance * _stretch(matrix) for mesh, matrix in placed),
        rounding=max(mesh.rounding * _stretch(matrix) for mesh, matrix in placed),
    )


def _once(warnings: Sequence[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Return the last warning of each code, but all that block a pass."""
    kept = {(code, said if code in BLOCKING else ""): (code, said) for code, said in warnings}
    return tuple(kept.values())


def _stretch(matrix: Transform | None) -> float:
    return 1.0 if matrix is None else largest_stretch(matrix)


def concatenate(parts: Sequence[tuple[Block, Block, Transform | None]]) -> tuple[Block, Block]:
    """(vertices, triangles) of all parts, each transformed by its matrix.

    parts: float64 vertices and uint32 triangles as in RawMesh. A mirroring matrix flips the
    winding.
    """
    if len(parts) == 1 and parts[0][2] is None:
        return parts[0][:2]
    all_vertices, all_triangles = bytearray(), array("I")
    for vertices, triangles, matrix in parts:
        if matrix is not None:
            vertices, triangles = _placed(vertices, triangles, matrix)
        before = len(all_vertices) // 24
        corners = array("I", bytes(triangles))
        all_triangles.extend((corner + before for corner in corners) if before else corners)
        all_vertices += vertices
    return bytes(all_vertices), all_triangles.tobytes()


def _placed(vertices: Block, triangles: Block, matrix: Transform) -> tuple[Block, Block]:
    try:
        return Mesh.from_bytes(vertices, triangles).transformed(matrix).to_bytes()
    except ValueError as error:
        raise MeshFileError("singular-transform", f"a part cannot be placed: {error}") from None
    except OverflowError as error:
        raise MeshFileError("out-of-range", f"a part cannot be placed: {error}") from None
