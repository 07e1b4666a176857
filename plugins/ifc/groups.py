"""The groups of an element: its classes, its storey, its type and its systems, for rules."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from satcheck.scene.loading.placing import tidy_name

_ROOT = "IfcElement"  # the superclass of all bodies; no group


def groups_of(model: Any, bodies: Sequence[Any]) -> dict[int, tuple[str, ...]]:
    """The number of each instance -> its groups."""
    classes: dict[str, tuple[str, ...]] = {}
    for name in {body.is_a() for body in bodies}:
        classes[name] = _classes(model, name)
    return {body.id(): (*classes[body.is_a()], *_memberships(body)) for body in bodies}


def _classes(model: Any, name: str) -> tuple[str, ...]:
    """The class and those above it, below IfcElement."""
    from ifcopenshell import schema_by_name

    types = []
    declaration = schema_by_name(model.schema_identifier).declaration_by_name(name).as_entity()
    while declaration is not None and declaration.name() != _ROOT:
        types.append(declaration.name())
        declaration = declaration.supertype()
    return tuple(types) if declaration is not None else (name,)


def _memberships(body: Any) -> tuple[str, ...]:
    from ifcopenshell.util.element import get_container, get_type
    from ifcopenshell.util.system import get_element_systems

    named = (
        ("storey", get_container(body, ifc_class="IfcBuildingStorey")),
        ("type", get_type(body)),
        *(("system", system) for system in get_element_systems(body)),
    )
    groups = (f"{kind}:{_name(thing)}" for kind, thing in named if thing is not None)
    return tuple(dict.fromkeys(groups))


def _name(thing: Any) -> str:
    return tidy_name(thing.Name, thing.GlobalId)
