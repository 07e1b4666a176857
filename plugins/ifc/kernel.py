"""Makes the shapes of elements with the OpenCascade kernel of IfcOpenShell.

The kernel cuts openings, applies mapped items and unites the items of a body. It skips what it
cannot make, and says so in its log only. A body of which something is missing is refused.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from msgspec import Struct

from satcheck.core.transform import Transform
from satcheck.plugins.ifc.elements import curved_bodies, material_of, rank_of
from satcheck.plugins.ifc.failures import Failures, failures_in, logged
from satcheck.scene.document import NO_SURFACE, RawMesh, Refusal
from satcheck.scene.files.nodes import concatenate

_METRES = 1e-3  # of a millimetre
_LIBRARY = "opencascade"
# More threads need more address space, which is limited. Their number changes no shape.
_MOST_THREADS = 4
_DEFAULT_PRECISION = 1e-5  # metres, of contexts that state none
# The beginnings of types of representations without a surface.
_CURVES = ("Annotation", "Curve", "GeometricCurveSet", "GeometricSet", "Point")
_IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class Shape(Struct, frozen=True):
    """The mesh of a body as the kernel makes it.

    vertices, triangles, decimals: as in RawMesh, in metres. matrix: the placement in the world;
    None: identity. tolerance: how far its facets may be off its surfaces, metres. warnings: (code,
    message).
    """

    vertices: bytes
    triangles: bytes
    matrix: Transform | None
    decimals: int
    tolerance: float = 0.0
    warnings: tuple[tuple[str, str], ...] = ()

    def mesh(self, units: str) -> RawMesh:
        return RawMesh(
            vertices=self.vertices,
            triangles=self.triangles,
            number_format="written-digits",
            decimals=self.decimals,
            units=units,
            warnings=self.warnings,
            surface_tolerance=self.tolerance,
        )

    @property
    def key(self) -> tuple[object, ...]:
        """The same for bodies that share a mesh."""
        return self.vertices, self.triangles, self.tolerance


def shapes_of(
    model: Any, bodies: Sequence[Any], options: Mapping[str, Any]
) -> dict[int, Shape | Refusal]:
    """The number of each instance -> its shape, or why it has none."""
    shapes: dict[int, list[Shape]] = {body.id(): [] for body in bodies}
    ranks = {body.id(): rank_of(material_of(body)[0].RepresentationIdentifier) for body in bodies}
    decimals = _decimals(model)
    for element in _elements(model, bodies, options):
        if rank_of(element.context) == ranks[element.id]:
            shapes[element.id].append(_shape(element, decimals))
    failures = failures_in(model, logged(), shapes)
    curved = curved_bodies(model, bodies)
    chord = options["chord_tolerance"] * _METRES
    return {
        body.id(): _whole(body, shapes[body.id()], failures, chord if body.id() in curved else 0.0)
        for body in bodies
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


def _shape(element: Any, decimals: int) -> Shape:
    geometry = element.geometry
    return Shape(
        vertices=geometry.verts_buffer,
        triangles=geometry.faces_buffer,
        matrix=_matrix(element.transformation.matrix),
        decimals=decimals,
    )


def _matrix(columns: Sequence[float]) -> Transform | None:
    """From the 16 numbers of the kernel, column by column."""
    rows = tuple(columns[4 * column + row] for row in range(4) for column in range(4))
    return None if rows == _IDENTITY else rows


def _whole(
    body: Any, shapes: Sequence[Shape], failures: Failures, tolerance: float
) -> Shape | Refusal:
    """The shapes of all representations of a body as one, or why it has none."""
    wanted = material_of(body)
    if failure := failures.fatal.get(body.id()):
        return Refusal("reader-failed", f"the kernel makes no whole shape: {failure.line}")
    if len(shapes) < len(wanted) or not all(shape.triangles for shape in shapes):
        kinds = [each.RepresentationType or "" for each in wanted]
        if all(kind.startswith(_CURVES) for kind in kinds):
            return Refusal(NO_SURFACE, f"it has only lines or points ({', '.join(kinds)})")
        kinds = [f"#{each.id()} ({each.RepresentationType})" for each in wanted]
        return Refusal("reader-failed", f"the kernel makes no shape of {', '.join(kinds)}")
    faces = failures.faces.get(body.id(), 0)
    message = f"the kernel left out faces or their edges: {faces} messages"
    warnings = (("ignored-geometry", message),) if faces else ()
    first = shapes[0]
    vertices, triangles = concatenate([(s.vertices, s.triangles, None) for s in shapes])
    return Shape(
        bytes(vertices), bytes(triangles), first.matrix, first.decimals, tolerance, warnings
    )


def _decimals(model: Any) -> int:
    """The digits after the point that the file states as the precision of its coordinates."""
    from ifcopenshell.util.unit import calculate_unit_scale

    contexts = model.by_type("IfcGeometricRepresentationContext", include_subtypes=False)
    stated = [each.Precision for each in contexts if each.Precision]
    scale = calculate_unit_scale(model)
    finest = min(stated) * scale if stated else _DEFAULT_PRECISION
    return max(0, round(-math.log10(finest)))
