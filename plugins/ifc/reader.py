"""Reads IFC files (STEP physical files and ifcZIP; IFC2X3, IFC4, IFC4X3) with IfcOpenShell.

A body is an element with a shape. Its path is the GlobalId, its title the class and the name. The
OpenCascade kernel makes the shapes. It runs in the child process of the readers, because it may
crash. ISO 16739 defines the entities and their relations.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from satcheck.plugins.ifc.elements import elements_of, path_names
from satcheck.plugins.ifc.groups import groups_of
from satcheck.plugins.ifc.kernel import Shape, shapes_of
from satcheck.plugins.ifc.model import UNITS, open_model
from satcheck.plugins.ifc.relations import relations_of
from satcheck.plugins.ifc.remarks import remarks_on
from satcheck.scene.errors import Refused
from satcheck.scene.loading.placing import tidy_name
from satcheck.scene.loading.raw_mesh import RawNode, RawPart, RawScene, Refusal
from satcheck.scene.loading.readers import File

_LONGEST_NAME = 60


def read_ifc(file: File) -> RawScene:
    """Return the bodies in metres, z up, sorted by GlobalId. Raises Refused without a file
    name."""
    model = open_model(memoryview(file.data))
    elements = elements_of(model)
    bodies = elements.bodies
    if not bodies:
        raise Refused("empty-mesh", "no element of the file has a shape")
    read = [body for body in bodies if body.id() not in elements.unread]
    shapes = {**shapes_of(model, read, file.options), **elements.unread}
    paths = path_names(bodies)
    relations = relations_of(model, bodies, paths, shapes)
    groups = groups_of(model, bodies)
    parts, places = _parts(bodies, shapes, paths)
    nodes = (
        RawNode(
            path=paths[body.id()],
            part=places[body.id()],
            matrix=getattr(shapes[body.id()], "matrix", None),
            title=_title(body),
            groups=(*groups[body.id()], *relations.groups.get(body.id(), ())),
        )
        for body in bodies
    )
    return RawScene(
        parts,
        tuple(nodes),
        remarks_on(model, elements, shapes, file.options),
        UNITS,
        relations.rules,
    )


def _parts(
    bodies: Sequence[Any], shapes: Mapping[int, Shape | Refusal], paths: Mapping[int, str]
) -> tuple[tuple[RawPart, ...], dict[int, int]]:
    """(the parts, the number of the part of each body). Bodies with the same mesh share a part,
    which has the path of the first of them."""
    parts: list[RawPart] = []
    known: dict[object, int] = {}
    places = {}
    for body in bodies:
        shape = shapes[body.id()]
        key = shape if isinstance(shape, Refusal) else shape.key
        if isinstance(shape, Refusal) or key not in known:
            known[key] = len(parts)
            mesh = shape if isinstance(shape, Refusal) else shape.mesh(UNITS)
            parts.append(RawPart(paths[body.id()], mesh))
        places[body.id()] = known[key]
    return tuple(parts), places


def _title(body: Any) -> str:
    name = tidy_name(body.Name, "")
    return f"{body.is_a()} {name}".strip()
