"""Which bodies have curved surfaces, for which the kernel makes facets."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from satcheck.scene.loading.ifc.elements import material_of

# Entities that make curved surfaces.
_CURVED = (
    *("IfcConic", "IfcBSplineCurve", "IfcBSplineSurface", "IfcSpiral", "IfcPolynomialCurve"),
    *("IfcCircleProfileDef", "IfcEllipseProfileDef", "IfcRoundedRectangleProfileDef"),
    *("IfcRevolvedAreaSolid", "IfcSweptDiskSolid", "IfcSurfaceOfRevolution"),
    *("IfcSphere", "IfcRightCircularCone", "IfcRightCircularCylinder"),
    *("IfcCylindricalSurface", "IfcSphericalSurface", "IfcToroidalSurface"),
)
_FACETS = ("IfcFacetedBrep", "IfcTessellatedItem")  # which the file itself has


def curved_bodies(model: Any, bodies: Sequence[Any]) -> set[int]:
    """The numbers of bodies that have a curved surface, or may have one from an opening."""
    seen = _Seen(model)
    return {body.id() for body in bodies if any(map(seen.is_curved, _representations(body)))}


def _representations(body: Any) -> Iterator[Any]:
    yield from material_of(body)
    for relation in getattr(body, "HasOpenings", ()):
        yield from material_of(relation.RelatedOpeningElement)


class _Seen:
    """Looks at each representation once."""

    def __init__(self, model: Any) -> None:
        self._model = model
        self._curved = tuple(_known(model, _CURVED))
        self._answers: dict[int, bool] = {}

    def is_curved(self, representation: Any) -> bool:
        key = representation.id()
        if key not in self._answers:
            self._answers[key] = any(map(self._is_curved_item, representation.Items))
        return self._answers[key]

    def _is_curved_item(self, item: Any) -> bool:
        if item.is_a("IfcMappedItem"):
            return self.is_curved(item.MappingSource.MappedRepresentation)
        if any(item.is_a(name) for name in _known(self._model, _FACETS)):
            return False
        return any(map(self._is_curved_instance, self._model.traverse(item)))

    def _is_curved_instance(self, instance: Any) -> bool:
        if any(map(instance.is_a, self._curved)):
            return True
        if instance.is_a("IfcProfileDef"):
            return any(_radii(instance))
        segments = getattr(instance, "Segments", None) or ()
        return any(each.is_a() == "IfcArcIndex" for each in segments)


def _radii(profile: Any) -> Iterator[float]:
    """Of rounded edges, such as those of a rolled section."""
    for name, value in profile.get_info().items():
        if name.endswith("Radius") and isinstance(value, float):
            yield value


def _known(model: Any, names: Iterable[str]) -> Iterator[str]:
    """The classes that the schema of the file has."""
    from ifcopenshell import schema_by_name

    schema = schema_by_name(model.schema_identifier)
    for name in names:
        try:
            schema.declaration_by_name(name)
        except RuntimeError:
            continue
        yield name
