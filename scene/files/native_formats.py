"""Reads OBJ, STL, PLY and OFF with the strict C++ readers, in this process."""

from __future__ import annotations

from msgspec.structs import replace

from satcheck._native import readers
from satcheck.scene.document import Document, Item, RawMesh, RawPart, UniqueNames, alone
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.files.placing import tidy_name
from satcheck.scene.files.readers import File

_READERS = {
    "obj": readers.read_obj,
    "stl": readers.read_stl,
    "ply": readers.read_ply,
    "off": readers.read_off,
}


def read_native(file: File) -> Document:
    """Return the meshes of a file. Only OBJ has several: an object (`o`) is a node. Raises
    Refused with line or byte."""
    outcome = _READERS[file.format](bytes(file.data))
    if isinstance(outcome, readers.ReadError):
        raise Refused(outcome.code, f"{_place(outcome)}{outcome.message}")
    whole = RawMesh(
        vertices=outcome.vertices,
        triangles=outcome.triangles,
        number_format=outcome.number_format,
        decimals=outcome.decimals,
        significant=outcome.significant,
        rounding=outcome.rounding,
        warnings=outcome.warnings,
    )
    objects = [] if file.whole else outcome.objects()
    if outcome.several_groups and len(objects) < 2 and not file.whole:
        what = "solids" if file.format == "stl" else "groups (g)"
        said = "left-out", f"{what} are no bodies: all of the file is one"
        whole = replace(whole, warnings=(*whole.warnings, said))
    return _of_objects(whole, objects) if len(objects) > 1 else alone(whole)


def _of_objects(whole: RawMesh, objects: list[tuple[bytes, readers.MeshData]]) -> Document:
    limits.refuse_many(len(objects), "objects")
    names = UniqueNames()
    parts = []
    for number, (name, mesh) in enumerate(objects, 1):
        path = names.unique(tidy_name(name.decode(errors="replace"), f"object{number}"))
        own = replace(whole, vertices=mesh.vertices, triangles=mesh.triangles, warnings=())
        parts.append(RawPart(path, own))
    nodes = (Item(number, part.name) for number, part in enumerate(parts))
    return Document(tuple(parts), tuple(nodes), whole.warnings)


def _place(error: readers.ReadError) -> str:
    if error.line >= 0:
        return f"line {error.line}: "
    if error.offset >= 0:
        return f"byte {error.offset}: "
    return ""
