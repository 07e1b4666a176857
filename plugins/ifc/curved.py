"""Which bodies have curved surfaces, for which the kernel makes facets."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from satcheck.plugins.ifc.elements import instances_of, material_of

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
        self._curved = _classes_in(model, _CURVED)
        self._facets = _classes_in(model, _FACETS)
        self._answers: dict[int, bool] = {}

    def is_curved(self, representation: Any) -> bool:
        key = representation.id()
        if key not in self._answers:
            self._answers[key] = any(map(self._is_curved_item, representation.Items))
        return self._answers[key]

    def _is_curved_item(self, item: Any) -> bool:
        if item.is_a("IfcMappedItem"):
            return self.is_curved(item.MappingSource.MappedRepresentation)
        if item.is_a() in self._facets:
            return False
        return any(map(self._is_curved_instance, self._model.traverse(item)))

    def _is_curved_instance(self, instance: Any) -> bool:
        kind = instance.is_a()
        if kind in self._curved:
            return True
        if kind == "IfcIndexedPolyCurve":
            return any(each.is_a() == "IfcArcIndex" for each in instance.Segments or ())
        return kind.endswith("ProfileDef") and any(_radii(instance))


def _radii(profile: Any) -> Iterator[float]:
    """Of rounded edges, such as those of a rolled section."""
    for name, value in profile.get_info().items():
        if name.endswith("Radius") and isinstance(value, float):
            yield value


def _classes_in(model: Any, names: Iterable[str]) -> frozenset[str]:
    """The classes of the instances of the file that are of one of these."""
    return frozenset(each.is_a() for name in names for each in instances_of(model, name))
