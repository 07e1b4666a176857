"""Makes the bodies of a file that is read: one of all its meshes, joined, one for each node, or one
for each connected component of these."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from operator import mul
from typing import Literal

from msgspec.structs import replace

from satcheck.core import Mesh, largest_stretch
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform
from satcheck.scene.bodies import MeshFile
from satcheck.scene.document import (
    COMPONENT_MARK,
    NO_SURFACE,
    Block,
    Document,
    RawMesh,
    RawPart,
    Refusal,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.readers import File
from satcheck.scene.inspect import CRACK_WIDTH, errors_of, file_resolution, mesh_file
from satcheck.scene.issue import BLOCKING, issue

# "none": the whole file is one body.
Split = Literal["nodes", "components", "none"]
Marked = list[tuple[str, MeshFile | Primitive | Refused]]  # (end of the path, shape)

_ONLY_DEGENERATE = "only-degenerate"
CORNER = Mesh.from_bytes(
    array("d", (0, 0, 0, 1, 0, 0, 0, 1, 0)).tobytes(), array("I", (0, 1, 2)).tobytes()
)
_SHAPES = "it has exact shapes, which no mesh holds: name one part of the file"
_SPLIT = "check its nodes as bodies of their own (--split nodes), or split the file"


def inspected(file: File, read: Document, *, apart: bool) -> Document:
    """Return the document with its meshes in the items. apart: an item for each component of these.

    Components are edge-connected, after cracks are closed. They are numbered by their lowest
    corners, so that the order of the triangles in the file does not matter. Raises Refused if
    nothing can be used.
    """
    said = list(read.warnings)
    shapes = [_shapes_of(file, part, said, apart=apart) for part in read.parts]
    most = limits.ANY_BODIES + len(file.data) // limits.BYTES_OF_BODY
    limits.refuse_many(sum(len(shapes[item.number]) for item in read.items), "bodies", most)
    items = []
    for item in read.items:
        for mark, shape in shapes[item.number]:
            path = f"{item.path or ''}{mark}" or None
            placed = _placed(path, shape, item.transform, file.path)
            units = None if isinstance(shape, MeshFile) else read.units
            items.append(replace(item, shape=placed, path=path, units=units))
    usable = (item for item in items if not isinstance(item.shape, Refused))
    first = next(usable, None)
    if first is None:
        raise next(item.shape for item in items if isinstance(item.shape, Refused))
    return replace(
        read,
        parts=(),
        items=tuple(items),
        warnings=(),
        issues=tuple(issue(code, message, file=file.path) for code, message in said),
        units=first.shape.units if isinstance(first.shape, MeshFile) else first.units,
    )


def _placed(
    path: str | None,
    shape: MeshFile | Primitive | Refused,
    transform: Transform | None,
    file: str,
) -> MeshFile | Primitive | Refused:
    """The shape, unless it cannot be placed so. path: of the item. file: its path, for messages."""
    if transform is not None and not isinstance(shape, Refused):
        try:
            CORNER.transformed(transform)
        except ValueError as error:
            shape = Refused("singular-transform", f"{path}: {error}", file=file)
        except OverflowError:  # of this corner; placing the mesh reports its overflow
            pass
    return shape


def _shapes_of(file: File, part: RawPart, said: list[tuple[str, str]], *, apart: bool) -> Marked:
    """Return the shape of a part, or its components. said: of the file; this call adds to it."""
    raw = part.mesh
    where = f"mesh {part.name!r}: " if part.name else ""
    if isinstance(raw, Refusal):
        return [("", Refused(raw.code, where + raw.message, file=file.path))]
    try:
        with errors_of(file.path):
            if not isinstance(raw, RawMesh):
                return [("", raw)]
            mesh = Mesh.from_bytes(raw.vertices, raw.triangles)
            bodies = _components(file, part, raw, mesh) if apart and raw.triangles else []
            if not bodies:
                whole = mesh_file(file, raw, mesh, part.name or None, placed=bool(part.name))
                return [("", whole)]
    except Refused as error:
        return [("", Refused(error.code, where + error.message, file=file.path))]
    said += [(code, where + message) for code, message in raw.warnings]
    if flat := sum(isinstance(body, Refused) for _, body in bodies):
        message = f"{where}{flat} loose pieces of area 0 are left out"
        said.append(("degenerate-triangles", message))
    return [body for body in bodies if not isinstance(body[1], Refused)]


def _components(file: File, part: RawPart, raw: RawMesh, mesh: Mesh) -> Marked:
    """Return the components of a mesh if it has several, and an error for each of area 0; nothing
    if all are."""
    pieces = (
        mesh.welded()
        .sorted()
        .components(CRACK_WIDTH * file_resolution(raw, mesh.largest_coordinate))
    )
    if len(pieces) < 2:
        return []
    limits.refuse_many(len(pieces), "components")
    raw = replace(raw, warnings=())
    bodies: Marked = []
    flat: Marked = []
    for piece in pieces:
        mark = f"{COMPONENT_MARK}{len(bodies) + 1}"
        name = f"{part.name}{mark}"
        try:
            bodies.append((mark, mesh_file(file, raw, piece, name, placed=bool(part.name))))
        except Refused as error:
            if error.code != _ONLY_DEGENERATE:
                raise
            flat.append(("", error))
    return [*bodies, *flat] if bodies else []


def flattened(document: Document) -> RawMesh:
    """Return one mesh of all nodes.

    A mesh of lines or points only adds a warning. Raises Refused if another mesh cannot be
    used, or if all together exceed the triangle limit.
    """
    if (only := document.only_mesh) is not None:
        return only
    said = list(document.warnings)
    placed: list[tuple[RawMesh, Transform | None]] = []
    for node in document.items:
        mesh = document.parts[node.number].mesh
        if isinstance(mesh, RawMesh) and not mesh.triangles:
            mesh = Refusal(NO_SURFACE, "a mesh without triangles is left out")
        if isinstance(mesh, RawMesh):
            placed.append((mesh, node.transform))
        elif not isinstance(mesh, Refusal):
            raise Refused("unsupported-feature", _SHAPES)
        elif mesh.code == NO_SURFACE and len(document.items) > 1:
            said.append(("ignored-geometry", mesh.message))
        else:
            raise Refused(mesh.code, mesh.message)
    if not placed:
        raise Refused("empty-mesh", "empty mesh: no node has a surface")
    meshes = [mesh for mesh, _ in placed]
    held = sum(len(mesh.triangles) // 12 for mesh in {id(mesh): mesh for mesh in meshes}.values())
    most_copied = max(limits.ANY_COPIED, limits.MAX_COPIES * held)
    for most, what, count in (
        (
            min(limits.MAX_TRIANGLES, most_copied),
            "triangles",
            sum(len(mesh.triangles) // 12 for mesh in meshes),
        ),
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


def hull_of(mesh: RawMesh) -> RawMesh:
    """Return the convex hull of a mesh. Raises Refused."""
    try:
        hull = Mesh.from_bytes(mesh.vertices, mesh.triangles).convex_hull().to_mesh()
    except (OverflowError, ValueError) as error:
        raise Refused("bad-record", f"convex hull: {error}") from None
    vertices, triangles = hull.to_bytes()
    return replace(mesh, vertices=vertices, triangles=triangles)


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
