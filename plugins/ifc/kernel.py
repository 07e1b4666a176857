"""Makes the shapes of elements with the OpenCascade kernel of IfcOpenShell.

The kernel cuts openings, applies mapped items and unites the items of a body. It skips what it
cannot make, and its parser what it cannot read, and only the log says so. A body of which something
is missing is refused.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

import msgspec
from msgspec import Struct

from satcheck.core.transform import Transform
from satcheck.plugins.ifc.elements import curved_bodies, material_of, rank_of
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import NO_SURFACE, RawMesh, Refusal
from satcheck.scene.files.nodes import concatenate

UNITS = "m"  # the kernel converts all lengths
_METRES = 1e-3  # of a millimetre
_LIBRARY = "opencascade"
# More threads need more address space, which is limited. Their number changes no shape.
_MOST_THREADS = 4
_DEFAULT_PRECISION = 1e-5  # metres, of contexts that state none
# The beginnings of types of representations without a surface.
_CURVES = ("Annotation", "Curve", "GeometricCurveSet", "GeometricSet", "Point")
_Made = tuple[bytes, bytes, Sequence[float]]  # vertices, triangles, matrix column by column
# Messages about faces that are left out. The mesh then has a hole, which the check of its surface
# finds: the body stays.
_LOST_FACES = frozenset(("GEO159", "GEO162", "GEO184", "GEO198"))
_OF_FACES = ("IfcFace", "IfcFaceBound", "IfcLoop")
# From an instance in a message, these lead up to the products that use it.
_ITEMS = ("IfcRepresentationItem", "IfcRepresentation", "IfcRepresentationMap", "IfcProfileDef")
_ABOVE = (*_ITEMS, "IfcProductRepresentation", "IfcObjectPlacement")
_INSTANCE = re.compile(r"#(\d+)=")


class Shape(Struct, frozen=True):
    """The mesh of a body as the kernel makes it, and its placement in the world; None: identity."""

    mesh: RawMesh
    matrix: Transform | None


def shapes_of(
    model: Any, bodies: Sequence[Any], options: Mapping[str, Any]
) -> dict[int, Shape | Refusal]:
    """The number of each instance -> its shape, or why it has none."""
    made: dict[int, list[_Made]] = {body.id(): [] for body in bodies}
    ranks = {body.id(): rank_of(material_of(body)[0].RepresentationIdentifier) for body in bodies}
    decimals = _decimals(model)
    for element in _elements(model, bodies, options):
        if rank_of(element.context) == ranks[element.id]:
            geometry, matrix = element.geometry, element.transformation.matrix
            made[element.id].append((geometry.verts_buffer, geometry.faces_buffer, matrix))
    failures = failures_in(model, logged(), made)
    curved = curved_bodies(model, bodies)
    chord = options["chord_tolerance"] * _METRES
    return {
        number: _whole(body, made[number], failures, decimals, chord if number in curved else 0.0)
        for number, body in ((body.id(), body) for body in bodies)
    }


def _elements(model: Any, bodies: Sequence[Any], options: Mapping[str, Any]) -> Iterator[Any]:
    """The shapes of the representations of the bodies, as the kernel finishes them."""
    from ifcopenshell import geom

    settings = geom.settings()
    settings.set("mesher-linear-deflection", options["chord_tolerance"] * _METRES)
    settings.set("mesher-angular-deflection", options["angular_tolerance"])
    settings.set("no-normals", True)
    settings.set("apply-default-materials", False)
    threads = min(os.cpu_count() or 1, _MOST_THREADS)
    shapes = geom.iterator(
        settings, model, threads, include=list(bodies), geometry_library=_LIBRARY
    )
    more = shapes.initialize()
    while more:
        yield shapes.get()
        more = shapes.next()


def _whole(
    body: Any, made: Sequence[_Made], failures: Failures, decimals: int, tolerance: float
) -> Shape | Refusal:
    """The shapes of all representations of a body as one, or why it has none. tolerance: how far
    its facets may be off its surfaces, metres."""
    wanted = material_of(body)
    if failure := failures.fatal.get(body.id()):
        return Refusal("reader-failed", f"the kernel makes no whole shape: {failure.line}")
    if len(made) < len(wanted) or not all(triangles for _, triangles, _ in made):
        kinds = [each.RepresentationType or "" for each in wanted]
        if all(kind.startswith(_CURVES) for kind in kinds):
            return Refusal(NO_SURFACE, f"it has only lines or points ({', '.join(kinds)})")
        kinds = [f"#{each.id()} ({each.RepresentationType})" for each in wanted]
        return Refusal("reader-failed", f"the kernel makes no shape of {', '.join(kinds)}")
    faces = failures.faces.get(body.id(), 0)
    message = f"the kernel left out faces or their edges: {faces} messages"
    warnings = (("ignored-geometry", message),) if faces else ()
    vertices, triangles = concatenate([(*each[:2], None) for each in made])
    mesh = RawMesh(
        bytes(vertices),
        bytes(triangles),
        "written-digits",
        decimals,
        units=UNITS,
        warnings=warnings,
        surface_tolerance=tolerance,
    )
    columns = made[0][2]
    rows = tuple(columns[4 * column + row] for row in range(4) for column in range(4))
    return Shape(mesh, None if rows == IDENTITY else rows)


def _decimals(model: Any) -> int:
    """The digits after the point that the file states as the precision of its coordinates."""
    from ifcopenshell.util.unit import calculate_unit_scale

    contexts = model.by_type("IfcGeometricRepresentationContext", include_subtypes=False)
    stated = [each.Precision for each in contexts if each.Precision]
    scale = calculate_unit_scale(model)
    finest = min(stated) * scale if stated else _DEFAULT_PRECISION
    return max(0, round(-math.log10(finest)))


class Failures(Struct, frozen=True):
    """Number of a body -> the first message about something that its shape lacks. faces: number of
    a body -> the number of messages about faces that it lacks."""

    fatal: Mapping[int, Message]
    faces: Mapping[int, int]


def failures_in(model: Any, messages: Iterable[Message], bodies: Collection[int]) -> Failures:
    """bodies: their numbers."""
    fatal: dict[int, Message] = {}
    faces: dict[int, int] = {}
    for message in messages:
        is_error, about = message.level == "error", message.instance_number
        of_face = about is not None and any(map(model.by_id(about).is_a, _OF_FACES))
        if message.code in _LOST_FACES or (is_error and of_face):
            for number in _concerned(model, message, bodies):
                faces[number] = faces.get(number, 0) + 1
        elif is_error:
            for number in _concerned(model, message, bodies):
                fatal.setdefault(number, message)
    return Failures(fatal, faces)


def _concerned(model: Any, message: Message, bodies: Collection[int]) -> Collection[int]:
    """The bodies that the message is about; all, if it names none."""
    if message.product_number is not None:
        return {message.product_number} & set(bodies)
    if message.instance_number is None:
        return bodies
    return _users(model, message.instance_number) & set(bodies)


def _users(model: Any, number: int) -> set[int]:
    """The products whose shape or place depends on the instance."""
    users, seen, waiting = set(), {number}, [model.by_id(number)]
    while waiting:
        instance = waiting.pop()
        if instance.is_a("IfcProduct"):
            users.add(instance.id())
        elif any(map(instance.is_a, _ABOVE)):
            above = [each for each in model.get_inverse(instance) if each.id() not in seen]
            seen.update(each.id() for each in above)
            waiting += above
    return users


class Message(Struct, frozen=True):
    """level: "error", "warning" or "notice". code: of the message, such as "GEO192"; "" if it has
    none. product, instance: as in the file, "#12=IfcWall(...)"."""

    level: str
    message: str
    code: str = ""
    product: str = ""
    instance: str = ""

    @property
    def product_number(self) -> int | None:
        return _number(self.product)

    @property
    def instance_number(self) -> int | None:
        return _number(self.instance)

    @property
    def line(self) -> str:
        """The message, and the entity that it is about."""
        entity = self.instance.partition("(")[0].partition("=")
        about = f"{entity[2]} {entity[0]}" if entity[1] else ""
        return " ".join(f"{self.message} {about}".split())


def start_log() -> None:
    """From now on the log is for `logged`, and empty."""
    from ifcopenshell import get_log
    from ifcopenshell.ifcopenshell_wrapper import set_log_format_json

    set_log_format_json()
    get_log()


def logged() -> Iterator[Message]:
    """The messages since the last call that are no notices."""
    from ifcopenshell import get_log

    for line in get_log().splitlines():
        if message := _message(line):
            yield message


def _message(line: str) -> Message | None:
    try:
        message = msgspec.json.decode(line, type=Message)
    except msgspec.DecodeError:  # a line break within a message
        return Message("error", line) if line.strip() else None
    return None if message.level == "notice" else message


def _number(entity: str) -> int | None:
    match = _INSTANCE.match(entity)
    return int(match[1]) if match else None
