"""3DXML 4: an assembly of tessellated parts in a zip archive, as CATIA and SolidWorks write it.

Dassault Systemes, "3D XML user's guide, version 4.3" (2009). This reader is our own: trimesh
confuses parts of the same name, adds coarser levels of detail to the finest one, and silently skips
parts of other formats. Lengths are millimetres.
"""

from __future__ import annotations

import zipfile

from satcheck.core.transform import Transform
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.placing import instances, raw_scene, tidy_name
from satcheck.scene.loading.raw_mesh import RawMesh, RawScene, Refusal
from satcheck.scene.loading.written_mesh import WrittenMesh, fan_triangles, strip_triangles
from satcheck.scene.loading.xml_tree import Element, read_elements
from satcheck.scene.loading.zip_guard import open_part, opened_zip

_URN = "urn:3DXML:"
_UNITS = "millimeter"
_PASSED_OVER = frozenset(  # without area, or for display only
    ("Edges", "SurfaceAttributes", "LineAttributes", "PointAttributes", "PolygonalLOD")
)


def read_3dxml(data: memoryview) -> RawScene:
    """The parts that the product structure places. Raises MeshFileError without a file name."""
    with opened_zip(data, "a 3DXML file") as archive:
        return _Assembly(archive).read()


class _Assembly:
    """References by their ids. A part is a reference without children."""

    def __init__(self, archive: zipfile.ZipFile) -> None:
        self._archive = archive
        self._children: dict[str, list[tuple[str, Transform | None]]] = {}
        self._names: dict[str, str] = {}
        self._parts: dict[str, Element] = {}

    def read(self) -> RawScene:
        root_file = self._document("Manifest.xml").need("Root").text
        document = self._document(root_file)
        structure = document.need("ProductStructure")
        root = structure.attribute("root")
        self._read_structure(structure)
        _refuse_moved_views(document, root)
        nodes = instances(
            [(root, None)],
            children=self._children_of,
            has_mesh=lambda key: key in self._parts,
            name=lambda key: self._names.get(key, key),
            kind="part",
        )
        if not nodes:
            raise MeshFileError("empty-mesh", "empty mesh: the product has no part")
        return raw_scene(nodes, lambda key: self._names[key], self._part)

    def _document(self, name: str) -> Element:
        if name not in self._archive.namelist():
            raise MeshFileError("missing-resource", f"the archive has no part {name!r}")
        try:
            with open_part(self._archive, name) as stream:
                return read_elements(stream)
        except MeshFileError as error:
            raise MeshFileError(error.code, f"{name}, {error.message}") from None

    def _read_structure(self, structure: Element) -> None:
        for element in structure.all("Reference3D"):
            id_ = element.attribute("id")
            self._children.setdefault(id_, [])
            self._names[id_] = tidy_name(element.attributes.get("name"), f"part{id_}")
        for element in structure.all("ReferenceRep"):
            id_ = element.attribute("id")
            if id_ in self._names:
                element.refuse(f"a second reference {id_!r}")
            self._parts[id_] = element
            self._children[id_] = []
            self._names[id_] = tidy_name(element.attributes.get("name"), f"shape{id_}")
        for element in (*structure.all("Instance3D"), *structure.all("InstanceRep")):
            above, below = (_reference(element.need(tag)) for tag in _ENDS)
            if above not in self._children or below not in self._children:
                element.refuse(f"refers to {above!r} and {below!r}", "index-out-of-range")
            self._children[above].append((below, _matrix(element.find("RelativeMatrix"))))

    def _children_of(self, key: str) -> list[tuple[str, Transform | None]]:
        if key not in self._children:
            raise MeshFileError("index-out-of-range", f"the product refers to unknown {key!r}")
        return self._children[key]

    def _part(self, key: str) -> RawMesh | Refusal:
        reference = self._parts[key]
        try:
            form = reference.attribute("format")
            if form != "TESSELLATED":
                reference.refuse(f"format {form!r} is not read", "unsupported-feature")
            name = reference.attribute("associatedFile").removeprefix(_URN)
            mesh = WrittenMesh()
            document = self._document(name)
            for root in document.all("Root"):
                _add_shape(root, mesh)
            if not mesh.triangles:
                document.refuse("the part has no triangles", "empty-mesh")
            return mesh.raw(_UNITS)
        except MeshFileError as error:
            return Refusal(error.code, error.message)


_ENDS = ("IsAggregatedBy", "IsInstanceOf")


def _reference(element: Element) -> str:
    """The id in `5`, `urn:3DXML:Reference:loc:5` or `urn:3DXML:Product.3dxml#5`."""
    return element.text.rpartition("#")[2].rpartition(":")[2]


def _matrix(element: Element | None) -> Transform | None:
    """A row-major 4x4 matrix from three columns and the translation."""
    if element is None:
        return None
    values = element.floats(element.text.split())
    if len(values) != 12:
        element.refuse(f"{len(values)} numbers, not 12")
    rows = [(*values[axis::3],) for axis in range(3)]
    return (*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0)


def _refuse_moved_views(document: Element, root: str) -> None:
    """Refuses default views that move occurrences. A view of the root rotates the whole product and
    is not applied, like an up axis."""
    for element in document.below():
        if element.tag == "DefaultViewProperty" and element.find("RelativePosition"):
            path = [_reference(id_) for id_ in element.below() if id_.tag == "id"]
            if path != [root]:
                element.refuse("a view that moves a part is not read", "unsupported-feature")


def _add_shape(shape: Element, mesh: WrittenMesh) -> None:
    kind = shape.attributes.get("type", "").rpartition(":")[2]
    if kind == "BagRepType":
        for child in shape.all("Rep"):
            _add_shape(child, mesh)
    elif kind == "PolygonalRepType":
        _add_polygons(shape, mesh)
    else:
        shape.refuse(f"type {kind!r} is not read", "unsupported-feature")


def _add_polygons(shape: Element, mesh: WrittenMesh) -> None:
    known = _PASSED_OVER | {"Faces", "VertexBuffer"}
    for child in shape.children:
        if child.tag not in known:
            child.refuse("could be geometry, and is not read", "unsupported-feature")
    groups = shape.all("Faces")
    if not groups:
        if lod := shape.find("PolygonalLOD"):
            lod.refuse("a shape of coarser levels alone is not read", "unsupported-feature")
        return
    positions = shape.need("VertexBuffer").need("Positions")
    words = positions.words(positions.text, 3)
    corners = [
        corner
        for group in groups
        for face in group.all("Face")
        for corner in _corners(face, len(words) // 3)
    ]
    mesh.add(words, positions.floats(words), corners)


def _corners(face: Element, count: int) -> list[int]:
    """The corners of all triangles of a face, three each."""
    given = face.attributes
    corners = face.indices(given.get("triangles", ""), count, 3)
    for strip in given.get("strips", "").split(","):
        corners += strip_triangles(face.indices(strip, count))
    for fan in given.get("fans", "").split(","):
        corners += fan_triangles(face.indices(fan, count))
    if not corners:
        face.refuse("a face without triangles, strips and fans", "unsupported-feature")
    return corners
