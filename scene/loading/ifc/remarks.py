"""What a user should know about an IFC file: what is no body, and what is not applied."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import Any

from satcheck.scene.loading.ifc.elements import Elements
from satcheck.scene.loading.ifc.kernel import ANGULAR_DEFLECTION, LINEAR_DEFLECTION
from satcheck.scene.words import listed

# Entities that make curved surfaces.
_CURVED = (
    "IfcConic",
    "IfcBSplineCurve",
    "IfcBSplineSurface",
    "IfcCircleProfileDef",
    "IfcEllipseProfileDef",
    "IfcRevolvedAreaSolid",
    "IfcSweptDiskSolid",
    "IfcSphere",
    "IfcRightCircularCone",
    "IfcRightCircularCylinder",
    "IfcArcIndex",
    "IfcCylindricalSurface",
    "IfcSphericalSurface",
    "IfcToroidalSurface",
    "IfcSurfaceOfRevolution",
)


def remarks_on(model: Any, elements: Elements) -> tuple[tuple[str, str], ...]:
    """(code, message) of each."""
    return tuple(_remarks(model, elements))


def _remarks(model: Any, elements: Elements) -> Iterator[tuple[str, str]]:
    left_out = [*_counts(elements.left_out), *_wholes(elements)]
    if left_out:
        yield "left-out", f"no bodies: {', '.join(left_out)}"
    if elements.without:
        names = [f"{each.is_a()} {each.GlobalId}" for each in elements.without]
        yield "no-shape", f"{len(names)} elements without a shape are not checked: {listed(names)}"
    if _all_of(model, ("IfcMapConversion",)):
        yield "left-out", "IfcMapConversion is not applied: coordinates are those of the project"
    if _all_of(model, _CURVED):
        yield (
            "faceted",
            f"curved surfaces are checked as facets, up to {LINEAR_DEFLECTION * 1000:g} mm and "
            f"{ANGULAR_DEFLECTION:g} rad off; --surface-tolerance allows for that",
        )


def _counts(classes: Counter[str]) -> list[str]:
    return [f"{count} {name}" for name, count in sorted(classes.items())]


def _wholes(elements: Elements) -> list[str]:
    counts = Counter(whole.is_a() for whole in elements.wholes)
    return [f"{each} (its parts are)" for each in _counts(counts)]


def _all_of(model: Any, names: Iterable[str]) -> bool:
    """Whether the file has an instance of one of these classes."""
    for name in names:
        try:
            if model.by_type(name):
                return True
        except RuntimeError:  # the schema lacks the class
            continue
    return False
