"""The colliders of glTF nodes: KHR_physics_rigid_bodies with KHR_implicit_shapes, and
OMI_physics_body with OMI_physics_shape.

Sources: the READMEs of these extensions. Their capsules and cylinders stand along y; the height of
a capsule is that between the centres of its caps. Triggers and forces are no bodies.
"""

from __future__ import annotations

from typing import Any

from msgspec import Struct

from satcheck.core.curved.placed import curved_shape
from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, Primitive, Sphere
from satcheck.core.transform import Transform
from satcheck.scene.document import Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf_buffers import extension, integer, items, member
from satcheck.scene.files.gltf_vocabulary import KHR_BODIES, KHR_SHAPES, OMI_BODIES, OMI_SHAPES
from satcheck.scene.vocabulary import Names, UnknownNames

# Takes z to y, exactly.
UPRIGHT: Transform = (1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1)

_DATA = {"extras": "data of an application"}
_KINDS = frozenset({"box", "sphere", "capsule", "cylinder", "convex", "trimesh"})
# What each object is called, and its names.
PLACES = {
    "rigid body": Names(
        frozenset({"collider", "motion"}),
        {"trigger": "nothing touches it", "joint": "no geometry", **_DATA},
    ),
    "collider": Names(
        frozenset({"geometry", "shape"}),
        {
            "physicsMaterial": "friction",
            "collisionFilter": "pairs that it exempts are checked all the same",
            **_DATA,
        },
    ),
    "geometry": Names(frozenset({"shape", "mesh", "node", "convexHull"}), _DATA),
    "shape": Names(
        _KINDS | {"type"},
        {"name": "a name", **_DATA},
    ),
    "sizes": Names(
        frozenset({"size", "radius", "radiusBottom", "radiusTop", "height", "mesh"}), _DATA
    ),
}


class Collider(Struct, frozen=True):
    """shape: an exact shape along z, or the number of a mesh. hull: the convex hull of the mesh is
    the body. node: the number of the node whose skin and weights the mesh has; None: none."""

    shape: Primitive | int | Refusal
    hull: bool = False
    node: int | None = None


class Colliders:
    """The colliders of a document. Raises Refused for a misspelt name of a rigid body."""

    def __init__(self, document: dict[str, Any], unknown: UnknownNames) -> None:
        self._document = document
        self._nodes = items(document, "nodes")
        self._unknown = unknown
        for number in range(len(self._nodes)):
            for name, body in self._bodies(number):
                unknown.look(PLACES["rigid body"], body.keys(), name, f"node {number}")

    def any(self) -> bool:
        """Say whether a node of the file has a collider."""
        return any(map(self.has, range(len(self._nodes))))

    def has(self, number: int) -> bool:
        return any("collider" in body for _, body in self._bodies(number))

    def moves(self, number: int) -> bool:
        """Say whether the node is a rigid body, whose colliders move together."""
        return any("motion" in body for _, body in self._bodies(number))

    def of(self, number: int) -> Collider:
        """The collider of a node that has one; a Refusal if it cannot be used."""
        where = f"node {number}"
        try:
            ((name, body), *others) = [
                (name, body) for name, body in self._bodies(number) if "collider" in body
            ]
            if others:
                raise Refused("unsupported-feature", f"{where}: two colliders")
            collider = member([body["collider"]], 0, "collider")
            self._unknown.look(PLACES["collider"], collider.keys(), "collider", where)
            if name == OMI_BODIES:
                return self._shape(OMI_SHAPES, integer(collider, "shape", -1))
            geometry = member([collider.get("geometry")], 0, "geometry of a collider")
            self._unknown.look(PLACES["geometry"], geometry.keys(), "geometry", where)
            if "shape" in geometry:
                return self._shape(KHR_SHAPES, integer(geometry, "shape", -1))
            hull = geometry.get("convexHull") is True
            if "node" in geometry:
                node = integer(geometry, "node", -1)
                mesh = integer(member(self._nodes, node, "node"), "mesh", -1)
                return Collider(mesh, hull, node)
            return Collider(integer(geometry, "mesh", -1), hull)
        except Refused as error:
            return Collider(Refusal(error.code, f"{where}: {error.message}"))

    def _bodies(self, number: int) -> list[tuple[str, dict[str, Any]]]:
        node = member(self._nodes, number, "node")
        found = ((name, extension(node, name)) for name in (KHR_BODIES, OMI_BODIES))
        return [(name, body) for name, body in found if body is not None]

    def _shape(self, name: str, number: int) -> Collider:
        shapes = items(extension(self._document, name) or {}, "shapes")
        shape = member(shapes, number, "shape")
        kind = shape.get("type")
        self._unknown.look(PLACES["shape"], shape.keys(), "shape", f"shape {number}")
        if others := sorted(shape.keys() & _KINDS - {kind}):
            message = f"shape {number} is a {kind}, and has sizes of a {others[0]}"
            raise Refused("bad-record", message)
        sizes = shape.get(kind, {}) if isinstance(kind, str) else {}
        if not isinstance(sizes, dict):
            raise Refused("bad-record", f"the sizes of shape {number} are no object")
        self._unknown.look(PLACES["sizes"], sizes.keys(), "sizes", f"shape {number}")
        try:
            match kind:
                case "box":
                    size = sizes.get("size", [1.0, 1.0, 1.0])
                    return Collider(Box(tuple(map(float, size))))  # type: ignore[arg-type]
                case "sphere":
                    return Collider(Sphere(_size(sizes, "radius", 0.5)))
                case "capsule" | "cylinder":
                    return Collider(_round(kind, sizes))
                case "convex" | "trimesh":
                    return Collider(integer(sizes, "mesh", -1), kind == "convex")
        except (TypeError, ValueError) as error:
            raise Refused("bad-record", f"shape {number}: {error}") from None
        raise Refused("unsupported-feature", f"a collider of type {kind!r} is not read")


def _size(sizes: dict[str, Any], key: str, default: float) -> float:
    return float(sizes.get(key, default))


def _round(kind: str, sizes: dict[str, Any]) -> Primitive:
    if "radius" in sizes:  # of an early OMI_physics_shape, where the height has another meaning
        raise Refused("unsupported-feature", f"a {kind} with `radius` is not read")
    bottom, top = _size(sizes, "radiusBottom", 0.5), _size(sizes, "radiusTop", 0.5)
    if "height" not in sizes:  # the two vocabularies have different defaults
        raise Refused("unsupported-feature", f"a {kind} without a height is not read")
    height = _size(sizes, "height", 0.0)
    if bottom == top:
        return Capsule(bottom, height) if kind == "capsule" else Cylinder(bottom, height)
    if kind == "cylinder" and top == 0.0:
        return Cone(bottom, height)
    raise Refused("unsupported-feature", f"a {kind} of two radii is not read")


def refuse_skew(shape: Primitive, matrix: Transform | None) -> None:
    """Raise Refused if the placement makes another shape of it."""
    if isinstance(shape, Box):
        return
    try:
        curved_shape(shape, matrix)
    except ValueError as error:
        raise Refused("unsupported-feature", f"its collider: {error}") from None
