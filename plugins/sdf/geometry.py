"""The geometry of a <collision> or <visual> of SDFormat."""

from __future__ import annotations

from collections.abc import Callable

from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, Ellipsoid, HalfSpace, Sphere
from satcheck.core.transform import Transform
from satcheck.plugins.sdf.values import number, vector
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot import kinematics
from satcheck.scene.robot.model import Geometry, MeshReference

PLANE = "plane"
HULL = "convex_hull"  # the optimization of a mesh
_EMPTY = "empty"


def shape_in(part: Element) -> Element | None:
    """The element of its shape; None: it has none."""
    geometry = part.need("geometry")
    shapes = geometry.children
    if len(shapes) > 1 or (geometry.text and not shapes):
        geometry.refuse(f"should hold one shape, not {len(shapes)}")
    return shapes[0] if shapes and shapes[0].tag != _EMPTY else None


def geometry_of(shape: Element) -> Geometry:
    """Raises RefusedElement if it cannot be checked."""
    if shape.tag not in _SHAPES:
        shape.refuse(f"no geometry that is read ({', '.join(_SHAPES)})", "unsupported-feature")
    try:
        return _SHAPES[shape.tag](shape)
    except ValueError as error:  # a size that is not positive
        shape.refuse(str(error))


def facing(shape: Element) -> Transform:
    """The rotation of a plane."""
    return kinematics.facing(vector(shape, "normal", (0.0, 0.0, 1.0)), shape)


def _mesh(shape: Element) -> MeshReference:
    if (submesh := shape.only("submesh")) is not None:
        submesh.refuse("a part of a mesh file is not read", "unsupported-feature")
    scale = vector(shape, "scale", (1.0, 1.0, 1.0))
    if 0.0 in scale:
        shape.refuse("scale 0 flattens the mesh", "singular-transform")
    # Converters of early versions leave a second <uri> with this text.
    uris = [uri for uri in shape.all("uri") if uri.text != "__default__"]
    if not uris:
        shape.refuse("<uri> is missing")
    if len(uris) > 1:
        uris[1].refuse("a second <uri> in one <mesh>")
    hull = shape.attributes.get("optimization") == HULL
    return MeshReference(uris[0].text or uris[0].refuse("is empty"), scale, hull=hull)


_SHAPES: dict[str, Callable[[Element], Geometry]] = {
    "mesh": _mesh,
    "box": lambda shape: Box(vector(shape, "size")),
    "sphere": lambda shape: Sphere(number(shape, "radius")),
    "cylinder": lambda shape: Cylinder(number(shape, "radius"), number(shape, "length")),
    "capsule": lambda shape: Capsule(number(shape, "radius"), number(shape, "length")),
    "cone": lambda shape: Cone(number(shape, "radius"), number(shape, "length")),
    "ellipsoid": lambda shape: Ellipsoid(vector(shape, "radii")),
    PLANE: lambda _: HalfSpace(),
}
