"""Makes the bodies of a file that is read: one of all of it, one for each node, or one for each
connected component of these."""

from __future__ import annotations

from array import array
from typing import Literal

from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.core.shapes import Primitive
from satcheck.scene.bodies import MeshFile
from satcheck.scene.document import Document, Item
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.flatten import flattened
from satcheck.scene.files.raw_mesh import RawMesh, RawNode, RawPart, RawScene, Refusal
from satcheck.scene.files.readers import File, reader_named
from satcheck.scene.health import CRACK_WIDTH
from satcheck.scene.inspect import errors_of, mesh_file, resolution_of
from satcheck.scene.issue import issue
from satcheck.scene.paths import name_of
from satcheck.scene.plain_ids import COMPONENT_MARK

# "none": the whole file is one body.
Split = Literal["nodes", "components", "none"]
Marked = list[tuple[str, MeshFile | Primitive | Refused]]  # (end of the path, shape)

_ONLY_DEGENERATE = "only-degenerate"
CORNER = Mesh.from_bytes(
    array("d", (0, 0, 0, 1, 0, 0, 0, 1, 0)).tobytes(), array("I", (0, 1, 2)).tobytes()
)


def document_of(file: File, scene: RawScene, split: Split) -> Document:
    """Return the bodies of a file.

    Components are edge-connected, after cracks are closed. They are numbered by their lowest
    corners, so that the order of the triangles in the file does not matter. Raises Refused if
    nothing can be used.
    """
    reader = reader_named(file.format)
    whole = Document(
        path=file.path,
        name=name_of(file.path)[0] or file.path,
        kind="scene" if reader is not None and reader.kind == "document" else "mesh",
        items=(),
    )
    if split == "none":
        return _with(whole, Item(mesh_file(file, flattened(scene))))
    said = list(scene.warnings)
    shapes = [_shapes_of(file, part, said, apart=split == "components") for part in scene.parts]
    _refuse_too_many(sum(len(shapes[node.part]) for node in scene.nodes))
    items = [
        _placed(f"{node.path or ''}{mark}" or None, shape, node, scene.units, file.path)
        for node in scene.nodes
        for mark, shape in shapes[node.part]
    ]
    errors = [item.shape for item in items if isinstance(item.shape, Refused)]
    if len(errors) == len(items):
        raise errors[0]
    issues = tuple(issue(code, message, file=file.path) for code, message in said)
    return replace(_with(whole, *items), issues=issues, pairs=scene.rules, joints=scene.joints)


def _with(document: Document, *items: Item) -> Document:
    """The document of these items, in the unit of the first one that can be used."""
    usable = (item for item in items if not isinstance(item.shape, Refused))
    units = next((_units(item) for item in usable), None)
    return replace(document, items=items, units=units)


def _units(item: Item) -> str | None:
    return item.shape.units if isinstance(item.shape, MeshFile) else item.units


def _refuse_too_many(bodies: int) -> None:
    if bodies > limits.MAX_PLACEMENTS:
        message = f"{bodies} bodies exceed {limits.MAX_PLACEMENTS}: split the file"
        raise Refused("too-large", message)


def _placed(
    path: str | None,
    shape: MeshFile | Primitive | Refused,
    raw: RawNode,
    units: str | None,
    file: str,
) -> Item:
    """path: of the item. units: of exact shapes. file: its path, for messages."""
    if raw.matrix is not None and not isinstance(shape, Refused):
        try:
            CORNER.transformed(raw.matrix)
        except ValueError as error:
            shape = Refused("singular-transform", f"{path}: {error}", file=file)
        except OverflowError:  # of this corner; placing the mesh reports its overflow
            pass
    own = None if isinstance(shape, MeshFile | Refused) else units
    link = raw.link
    return Item(shape, path, raw.matrix, raw.title, raw.groups, raw.static, link, units=own)


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
            bodies = _components(file, part, raw, mesh) if apart else []
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
    pieces = mesh.welded().sorted().components(CRACK_WIDTH * resolution_of(raw, mesh))
    if len(pieces) < 2:
        return []
    _refuse_too_many(len(pieces))
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
