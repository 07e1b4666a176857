"""COLLADA 1.4: the meshes of the visual scene, placed by its nodes, as the file stores them.

Khronos, "COLLADA 1.4.1 specification" (2008). This reader is our own, because pycollada silently
skips elements that it does not know. To find out whether it skipped geometry takes as much code as
to read the file. If an element is unknown and could be geometry or move it, the file is refused.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck.core.transform import Transform, about, compose, cos_sin, placed
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import (
    Document,
    RawMesh,
    alone,
    fan_triangles,
    strip_triangles,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files.collada_vocabulary import look_at
from satcheck.scene.files.nodes import concatenate, flattened
from satcheck.scene.files.placing import Instance, instances, multiply, raw_scene, tidy_name
from satcheck.scene.files.polygons import triangles_of
from satcheck.scene.files.readers import File
from satcheck.scene.files.xml_tree import Element, read_elements
from satcheck.scene.units import RESCALED, unit_of
from satcheck.scene.vocabulary import UnknownNames

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Geometry = tuple[Floats, Indices]  # vertices (n, 3), triangles (m, 3)

_MOVES = {"matrix": 16, "translate": 3, "rotate": 4, "scale": 3}
_BENDS = frozenset({"lookat", "skew"})
_MESH = "instance_geometry"
_SHAPED = "instance_controller"  # by a skin or by morph targets
# Elements of a node or a visual scene that place nothing.
_NOTHING = frozenset({"asset", "extra", "evaluate_scene", "instance_camera", "instance_light"})
_BESIDE = _NOTHING.union((_MESH,), _MOVES, _BENDS)
_LINES = frozenset({"lines", "linestrips"})
_ONE_P_EACH = frozenset({"polygons", "tristrips", "trifans"})
_TRIANGLES = frozenset({"triangles", "polylist", *_ONE_P_EACH})
_WITHOUT_SURFACE = frozenset({"asset", "extra", "source", "vertices"})
_AXES = (["X", "Y", "Z"], ["", "", ""])


def read_collada(file: File) -> Document:
    """Return the visual scene of a COLLADA file; one mesh without a placement if it has one node.
    Raises Refused without a file name.

    The precision is that of float32, because the programs that write COLLADA store coordinates so.
    """
    root = read_elements(file.data)
    if root.tag != "COLLADA":
        raise Refused("not-this-format", f"not a COLLADA file: its root is <{root.tag}>")
    scene = _Document(root).read()
    return scene if len(scene.items) > 1 else alone(flattened(scene))


class _Document:
    def __init__(self, root: Element) -> None:
        self._root = root
        self._by_id: dict[tuple[str, str], list[Element]] = {}
        for element in _without_extras(root):
            if "id" in element.attributes:
                key = element.tag, element.attributes["id"]
                self._by_id.setdefault(key, []).append(element)
        self._geometries: dict[Element, Geometry] = {}
        self._carriers: dict[Element, bool] = {}
        self._warnings: dict[str, str] = {}

    def read(self) -> Document:
        units, scaling = self._units()
        scene = self._visual_scene()
        nodes = instances(
            [(scene, None)] if self._geometries_of(scene) else self._children(scene),
            children=self._children,
            has_mesh=lambda node: bool(self._geometries_of(node)),
            name=_name,
            kind="node",
        )
        if not nodes:
            raise Refused("empty-mesh", "empty mesh: the scene has no triangles")
        read = raw_scene(
            [
                Instance(self._geometries_of(node.key), multiply(scaling, node.matrix), node.path)
                for node in nodes
            ],
            lambda geometries: _name(geometries[0]),
            lambda geometries: self._joined(geometries, units),
        )
        return replace(read, warnings=(*self._warnings.items(), *self._beside()))

    def _joined(self, geometries: tuple[Element, ...], units: str) -> RawMesh:
        meshes = map(self._mesh_of, geometries)
        vertices, triangles = concatenate(
            [(p.astype("<f8").tobytes(), t.astype("<u4").tobytes(), None) for p, t in meshes]
        )
        return RawMesh(vertices, triangles, number_format="float32", units=units)

    def _beside(self) -> tuple[tuple[str, str], ...]:
        """What is not read."""
        unknown = UnknownNames()
        for element in _without_extras(self._root):
            look_at(element, unknown, is_root=element is self._root)
        warnings = list(unknown.warnings())
        if self._root.find("library_animations") is not None:
            warnings.append(("time-sampled", "the file is animated; checked as stored"))
        asset = self._root.find("asset")
        axis = asset.find("up_axis") if asset else None
        if axis is not None and axis.text.strip() != "Z_UP":  # the axis of robots
            message = f"up_axis {axis.text.strip()} turns nothing: axes stay as in the file"
            warnings.append(("up-axis", message))
        return tuple(warnings)

    def _units(self) -> tuple[str, Transform | None]:
        """Return the unit, and the scaling into it: a unit without a name becomes metres."""
        asset = self._root.find("asset")
        unit = asset.find("unit") if asset else None
        if unit is None or "meter" not in unit.attributes:
            return "meters", None
        metres = unit.number("meter")
        if metres <= 0.0:
            unit.refuse("the unit has no length")
        units = "meters" if metres == 1.0 else f"{metres} * meters"
        if unit_of(units) is not None:
            return units, None
        return RESCALED, (*(metres * entry for entry in IDENTITY[:12]), *IDENTITY[12:])

    def _visual_scene(self) -> Element:
        scene = self._root.find("scene")
        references = scene.all("instance_visual_scene") if scene else []
        if not references:
            raise Refused("empty-mesh", "empty mesh: the file instantiates no visual scene")
        if len(references) > 1:
            references[1].refuse("a second visual scene is not read", "unsupported-feature")
        return self._target(references[0], "visual_scene")

    def _target(self, element: Element, tag: str) -> Element:
        """The element of that tag that a reference points to."""
        url = element.attributes.get("url", "")
        if not url.startswith("#"):
            element.refuse(f"reference {url!r} leaves the file: refused", "outside-path")
        targets = self._by_id.get((tag, url[1:]), [])
        if len(targets) != 1:
            code = "duplicate-id" if targets else "index-out-of-range"
            element.refuse(f"{len(targets)} elements <{tag}> have the id {url[1:]!r}", code)
        return targets[0]

    def _children(self, element: Element) -> list[tuple[Element, Transform | None]]:
        """The nodes placed in a node. Transforms of nodes without triangles are not read."""
        return [
            (child, _matrix_of(child) if self._carries(child) else None)
            for child in self._placed_in(element)
        ]

    def _placed_in(self, element: Element) -> Iterator[Element]:
        for child in element.children:
            if child.tag == "node":
                yield child
            elif child.tag == "instance_node":
                yield self._target(child, "node")
            elif child.tag == _SHAPED:
                child.refuse(
                    "skins and morph targets are not read: export the mesh in its pose",
                    "unsupported-feature",
                )
            elif child.tag not in _BESIDE:
                child.refuse("could be geometry, and is not read", "unsupported-feature")

    def _carries(self, element: Element) -> bool:
        """Whether the node or one of its descendants has triangles."""
        if element not in self._carriers:
            self._carriers[element] = False  # for cycles, which are refused later
            below = [self._carries(child) for child in self._placed_in(element)]
            self._carriers[element] = bool(self._geometries_of(element)) or any(below)
        return self._carriers[element]

    def _geometries_of(self, node: Element) -> tuple[Element, ...]:
        """Those with triangles. A node with several is one body."""
        targets = (self._target(instance, "geometry") for instance in node.all(_MESH))
        return tuple(each for each in targets if len(self._mesh_of(each)[1]))

    def _mesh_of(self, geometry: Element) -> Geometry:
        if geometry not in self._geometries:
            self._geometries[geometry] = self._read_geometry(geometry)
        return self._geometries[geometry]

    def _read_geometry(self, element: Element) -> Geometry:
        mesh = element.find("mesh")
        if mesh is None:
            if element.find("spline") is None:
                element.refuse("a geometry without <mesh> is not read", "unsupported-feature")
            self._warnings["ignored-geometry"] = "lines are ignored"
            return np.empty((0, 3)), np.empty((0, 3), np.int64)
        points = _points(mesh)
        triangles = []
        for group in mesh.children:
            if group.tag in _LINES:
                self._warnings["ignored-geometry"] = "lines are ignored"
            elif group.tag in _TRIANGLES:
                triangles.append(_triangles(group, points))
            elif group.tag not in _WITHOUT_SURFACE:
                group.refuse("could be geometry, and is not read", "unsupported-feature")
        return points, np.concatenate([*triangles, np.empty((0, 3), np.int64)])


def _name(element: Element) -> str:
    given = element.attributes
    return tidy_name(given.get("name"), "") or tidy_name(given.get("id"), element.tag)


def _without_extras(root: Element) -> Iterator[Element]:
    waiting = [root]
    while waiting:
        element = waiting.pop()
        yield element
        waiting += [child for child in element.children if child.tag != "extra"]


def _matrix_of(node: Element) -> Transform:
    """The transforms of a node, the first one outermost."""
    matrix = IDENTITY
    for child in node.children:
        if child.tag in _BENDS:
            child.refuse("a transform that is not read", "unsupported-feature")
        if child.tag in _MOVES:
            matrix = compose(matrix, _move(child))
    return matrix


def _move(element: Element) -> Transform:
    values = element.text_numbers(_MOVES[element.tag])
    if element.tag == "matrix":
        if values[12:] != (0.0, 0.0, 0.0, 1.0):
            element.refuse("the last row should be 0 0 0 1")
        return values
    x, y, z, *angle = values
    if element.tag == "translate":
        return placed((1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0), (x, y, z))
    if element.tag == "scale":
        return placed((x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z), (0.0, 0.0, 0.0))
    length = math.hypot(x, y, z)
    if not any(angle):
        return IDENTITY
    if not (length > 0.0 and math.isfinite(length)):
        element.refuse("an axis of length 0")
    turn = about((x / length, y / length, z / length), cos_sin(angle[0]))
    return placed(turn, (0.0, 0.0, 0.0))


def _points(mesh: Element) -> Floats:
    """The positions that <vertices> names."""
    vertices = mesh.find("vertices")
    inputs = vertices.all("input") if vertices else []
    positions = [i for i in inputs if i.attributes.get("semantic") == "POSITION"]
    if not positions:
        return np.empty((0, 3))
    wanted = positions[0].attributes.get("source", "").lstrip("#")
    for source in mesh.all("source"):
        if source.attributes.get("id") == wanted:
            technique = source.find("technique_common")
            accessor = technique.find("accessor") if technique else None
            if accessor is not None and _makes_points(accessor):
                numbers = source.need("float_array")
                named = accessor.attributes.get("source", "").lstrip("#")
                if named not in ("", numbers.attributes.get("id", named)):
                    accessor.refuse(f"{named!r} is not the <float_array> beside it")
                return numbers.counted_floats().reshape(-1, 3)
    message = "positions should be X, Y, Z after X, Y, Z from the first number on"
    return positions[0].refuse(message, "unsupported-feature")


def _makes_points(accessor: Element) -> bool:
    given = accessor.attributes
    names = [param.attributes.get("name", "") for param in accessor.all("param")]
    layout = given.get("offset", "0").strip(), given.get("stride", "1").strip()
    return layout == ("0", "3") and names in _AXES


def _triangles(group: Element, points: Floats) -> Indices:
    """The triangles (m, 3) of a group of polygons, strips or fans."""
    for hole in group.all("ph"):
        hole.refuse("is not read", "unsupported-feature")
    inputs = [(i.attributes.get("semantic"), i.integer("offset")) for i in group.all("input")]
    offset = dict(inputs).get("VERTEX")
    if offset is None:
        if group.integer("count"):
            group.refuse("no input of vertices")
        return np.empty((0, 3), np.int64)
    stride = 1 + max(offset for _, offset in inputs)
    rows = [p.integers() for p in group.all("p")]
    numbers = [number for row in rows for number in row]
    lengths = _lengths(group, rows, stride)
    count = group.integer("count")
    if len(lengths) != count or sum(lengths) * stride != len(numbers):
        group.refuse(
            f"promises {count} polygons, {sum(lengths)} corners of {stride} numbers, "
            f"and has {len(numbers)} numbers",
            "count-mismatch",
        )
    if any(length < 3 for length in lengths):
        group.refuse("a polygon with fewer than 3 corners")
    corners = numbers[offset::stride]
    if corners and max(corners) >= len(points):
        group.refuse(f"vertex {max(corners)} of {len(points)}", "index-out-of-range")
    if group.tag in ("tristrips", "trifans"):
        split = strip_triangles if group.tag == "tristrips" else fan_triangles
        ends = np.cumsum(lengths)
        pieces = (corners[e - n : e] for e, n in zip(ends, lengths, strict=True))
        corners = [corner for piece in pieces for corner in split(piece)]
        lengths = [3] * (len(corners) // 3)
    return triangles_of(points, corners, lengths)


def _lengths(group: Element, rows: list[list[int]], stride: int) -> list[int]:
    """How many corners each polygon, strip or fan has."""
    if group.tag == "polylist":
        vcount = group.find("vcount")
        return vcount.integers() if vcount else []
    if group.tag in _ONE_P_EACH:
        return [len(row) // stride for row in rows]
    return [3] * min(group.integer("count"), sum(map(len, rows)))
