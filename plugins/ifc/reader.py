"""Reads IFC files (STEP physical files and ifcZIP; IFC2X3, IFC4, IFC4X3) with IfcOpenShell.

A body is an element with a shape. Its path is the GlobalId, its title the class and the name. The
OpenCascade kernel makes the shapes. It runs in the child process of the readers, because it may
crash. ISO 16739 defines the entities and their relations.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from satcheck.plugins.ifc.elements import Elements, elements_of, groups_of, instances_of, path_names
from satcheck.plugins.ifc.kernel import UNITS, Shape, shapes_of
from satcheck.plugins.ifc.model import open_model
from satcheck.plugins.ifc.relations import relations_of
from satcheck.scene.document import Document, Item, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import Parts, tidy_name
from satcheck.scene.files.readers import File
from satcheck.scene.words import listed


def read_ifc(file: File) -> Document:
    """Return the bodies in metres, z up, sorted by GlobalId. Raises Refused without a file
    name."""
    model = open_model(memoryview(file.data), file.permitted.most)
    elements = elements_of(model)
    bodies = elements.bodies
    if not bodies:
        raise Refused("empty-mesh", "no element of the file has a shape")
    read = [body for body in bodies if body.id() not in elements.unread]
    shapes = {**shapes_of(model, read, file.options), **elements.unread}
    paths = path_names(bodies)
    rules, named = relations_of(model, bodies, paths, shapes)
    groups = groups_of(model, bodies)
    parts, nodes = Parts(), []
    for body in bodies:
        number, shape = body.id(), shapes[body.id()]
        mesh, matrix = (shape.mesh, shape.matrix) if isinstance(shape, Shape) else (shape, None)
        part = parts.number(paths[number], mesh)
        of_body = (*groups[number], *named.get(number, ()))
        title = f"{body.is_a()} {tidy_name(body.Name, '')}".strip()
        nodes.append(Item(part, paths[number], matrix, title, of_body))
    said = remarks_on(model, elements, shapes, file.options)
    return Document(parts.all(), tuple(nodes), tuple(said), UNITS, rules)


def remarks_on(
    model: Any,
    elements: Elements,
    shapes: Mapping[int, Shape | Refusal],
    options: Mapping[str, Any],
) -> Iterator[tuple[str, str]]:
    """(code, message) of each. shapes: of the bodies."""
    wholes = Counter(whole.is_a() for whole in elements.wholes)
    left_out = [f"{count} {name}" for name, count in sorted(elements.left_out.items())]
    left_out += [f"{count} {name} (its parts are)" for name, count in sorted(wholes.items())]
    if left_out:
        yield "left-out", f"no bodies: {', '.join(left_out)}"
    if elements.without:
        names = [f"{each.is_a()} {each.GlobalId}" for each in elements.without]
        yield "no-shape", f"{len(names)} elements without a shape are not checked: {listed(names)}"
    if instances_of(model, "IfcMapConversion"):
        yield "left-out", "IfcMapConversion is not applied: coordinates are those of the project"
    count = sum(
        isinstance(shape, Shape) and shape.mesh.surface_tolerance > 0 for shape in shapes.values()
    )
    if count:
        yield (
            "faceted",
            f"curved surfaces of {count} bodies are checked as facets, up to about "
            f"{options['chord_tolerance']:g} mm off (--read chord-tolerance)",
        )
