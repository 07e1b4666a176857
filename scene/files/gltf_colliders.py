"""The colliders of glTF nodes: KHR_physics_rigid_bodies with KHR_implicit_shapes, and
OMI_physics_body with OMI_physics_shape.

Sources: the READMEs of these extensions. Their capsules and cylinders stand along y; the height of
a capsule is that between the centres of its caps. Triggers and forces are no bodies.
"""

from __future__ import annotations

from typing import Any

from msgspec import UNSET, Struct, UnsetType

from satcheck.core.curved.placed import curved_shape
from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, Primitive, Sphere
from satcheck.core.transform import Transform
from satcheck.scene.document import Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf_document import (
    KHR_BODIES,
    KHR_SHAPES,
    NONE,
    OMI_BODIES,
    OMI_SHAPES,
    Count,
    GltfDocument,
    Number,
    Vector,
    checked,
)
from satcheck.scene.files.gltf_meshes import Shape
from satcheck.scene.vocabulary import Names, UnknownNames

# Takes z to y, exactly.
UPRIGHT: Transform = (1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1)

_BODIES = (KHR_BODIES, OMI_BODIES)
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
    "shape": Names(_KINDS | {"type"}, {"name": "a name", **_DATA}),
    "sizes": Names(
        frozenset({"size", "radius", "radiusBottom", "radiusTop", "height", "mesh"}), _DATA
    ),
}


class _Given(Struct, frozen=True, rename="camel"):
    """What these objects state. The two vocabularies have different defaults for the height."""

    geometry: dict[str, Any] = {}
    shape: Count = NONE
    mesh: Count = NONE
    node: Count = NONE
    convex_hull: bool = False
    type: str = ""
    size: Vector = (1.0, 1.0, 1.0)
    radius: Number | UnsetType = UNSET
    radius_bottom: Number = 0.5
    radius_top: Number = 0.5
    height: Number | UnsetType = UNSET


class Collider(Struct, frozen=True):
    """shape: an exact shape along z, or a mesh. hull: the convex hull of the mesh is the body."""

    shape: Primitive | Shape | Refusal
    hull: bool = False


class Colliders:
    """The colliders of a document. Raises Refused for a misspelt name of a rigid body."""

    def __init__(self, document: GltfDocument, unknown: UnknownNames) -> None:
        self._document = document
        self._unknown = unknown
        self._bodies: dict[int, dict[str, dict[str, Any]]] = {}
        for number, node in enumerate(document.nodes):
            for name in _BODIES:
                if name in node.extensions:
                    body = node.extensions[name]
                    unknown.look(PLACES["rigid body"], body.keys(), name, f"node {number}")
                    self._bodies.setdefault(number, {})[name] = body

    def __bool__(self) -> bool:
        return any(map(self.has, self._bodies))

    def has(self, number: int) -> bool:
        return any("collider" in body for body in self._bodies.get(number, {}).values())

    def moves(self, number: int) -> bool:
        """Say whether the node is a rigid body, whose colliders move together."""
        return any("motion" in body for body in self._bodies.get(number, {}).values())

    def of(self, number: int) -> Collider:
        """The collider of a node that has one; a Refusal if it cannot be used."""
        where = f"node {number}"
        bodies = self._bodies[number]
        try:
            (name, *others) = [name for name, body in bodies.items() if "collider" in body]
            if others:
                raise Refused("unsupported-feature", f"{where}: two colliders")
            collider = self._read(bodies[name]["collider"], "collider", where)
            if name == OMI_BODIES:
                return self._shape(OMI_SHAPES, collider.shape)
            geometry = self._read(collider.geometry, "geometry", where)
            if geometry.shape != NONE:
                return self._shape(KHR_SHAPES, geometry.shape)
            shape = Shape(geometry.mesh)
            if geometry.node != NONE:
                shape = Shape.of(self._document.nodes[geometry.node])
            return Collider(shape, geometry.convex_hull)
        except Refused as error:
            return Collider(Refusal(error.code, error.message))

    def _read(self, given: Any, kind: str, where: str) -> _Given:
        names = checked(given, dict[str, Any], f"{where}: {kind}")
        self._unknown.look(PLACES[kind], names.keys(), kind, where)
        return checked(given, _Given, f"{where}: {kind}")

    def _shape(self, name: str, number: int) -> Collider:
        where = f"shape {number}"
        stated = self._document.stated.extensions.get(name, {})
        shapes = checked(stated.get("shapes", []), list[Any], name)
        if not 0 <= number < len(shapes):
            message = f"{where} does not exist, there are {len(shapes)}"
            raise Refused("index-out-of-range", message)
        kind = self._read(shapes[number], "shape", where).type
        if others := sorted(shapes[number].keys() & _KINDS - {kind}):
            message = f"{where} of type {kind!r} has sizes of a {others[0]}"
            raise Refused("bad-record", message)
        sizes = self._read(shapes[number].get(kind, {}), "sizes", where)
        try:
            match kind:
                case "box":
                    return Collider(Box(sizes.size))  # type: ignore[arg-type]
                case "sphere":
                    return Collider(Sphere(0.5 if sizes.radius is UNSET else sizes.radius))
                case "capsule" | "cylinder":
                    return Collider(_round(kind, sizes))
                case "convex" | "trimesh":
                    return Collider(Shape(sizes.mesh), kind == "convex")
        except ValueError as error:
            raise Refused("bad-record", f"{where}: {error}") from None
        raise Refused("unsupported-feature", f"a collider of type {kind!r} is not read")


def _round(kind: str, sizes: _Given) -> Primitive:
    if sizes.radius is not UNSET:  # of early OMI_physics_shape: the height has another meaning
        raise Refused("unsupported-feature", f"a {kind} with `radius` is not read")
    bottom, top, height = sizes.radius_bottom, sizes.radius_top, sizes.height
    if height is UNSET:
        raise Refused("unsupported-feature", f"a {kind} without a height is not read")
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
