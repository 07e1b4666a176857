"""Which products of an IFC file are bodies, and which are left out.

Bodies are elements: what is built, installed or furnished. Spaces, openings, annotations, grids,
ports, structural analysis and terrain are not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from msgspec import Struct

from satcheck.scene.loading.placing import tidy_name
from satcheck.scene.plain_ids import UniqueNames

_BODIES = ("IfcElement", "IfcProxy")
# A projection adds material to its host, and the kernel does not join it.
_ADDITION = "IfcFeatureElementAddition"
_NO_BODIES = ("IfcFeatureElement", "IfcVirtualElement")
# Identifiers of representations, the best first, that show the material of an element.
_MATERIAL = ("Body", "Body-FallBack", "Facetation", "Tessellation")
_OTHER_VIEWS = frozenset(
    ("Axis", "Annotation", "Box", "Clearance", "CoG", "FootPrint", "Lighting", "Plan", "Profile",
     "Reference", "SurveyPoints")
)  # fmt: skip


class Elements(Struct, frozen=True):
    """with_shape: the bodies, by GlobalId. without: elements that have neither a shape nor parts.
    wholes: elements whose parts have the shape. left_out: class -> number of other products with
    a shape."""

    with_shape: tuple[Any, ...]
    without: tuple[Any, ...]
    wholes: tuple[Any, ...]
    left_out: Counter[str]


def elements_of(model: Any) -> Elements:
    bodies, without, wholes = [], [], []
    left_out: Counter[str] = Counter()
    for product in sorted(model.by_type("IfcProduct"), key=_order):
        if not _is_body(product):
            if product.Representation is not None or product.is_a("IfcFeatureElement"):
                left_out[product.is_a()] += 1
        elif material_of(product):
            bodies.append(product)
        elif any(True for _ in parts_of(product)):
            wholes.append(product)
        else:
            without.append(product)
    return Elements(tuple(bodies), tuple(without), tuple(wholes), left_out)


def path_names(bodies: Sequence[Any]) -> dict[int, str]:
    """The number of each instance -> its GlobalId, which a damaged file may repeat."""
    names = UniqueNames()
    return {body.id(): names.unique(tidy_name(body.GlobalId, "no GlobalId")) for body in bodies}


def material_of(product: Any) -> list[Any]:
    """The representations that together show the material of a product."""
    shape = product.Representation
    shown: dict[int, list[Any]] = {}
    for each in shape.Representations if shape is not None else ():
        if (rank := rank_of(each.RepresentationIdentifier)) is not None:
            shown.setdefault(rank, []).append(each)
    return shown[min(shown)] if shown else []


def rank_of(identifier: str | None) -> int | None:
    """Of representations of a product, those of the lowest rank are its material. None: never."""
    if identifier in _OTHER_VIEWS:
        return None
    return _MATERIAL.index(identifier) if identifier in _MATERIAL else len(_MATERIAL)


def parts_of(whole: Any) -> Iterator[Any]:
    """The parts into which IfcRelAggregates or IfcRelNests takes an element apart."""
    for relation in (*whole.IsDecomposedBy, *getattr(whole, "IsNestedBy", ())):
        yield from (part for part in relation.RelatedObjects if part.is_a("IfcElement"))


def _is_body(product: Any) -> bool:
    if not any(map(product.is_a, _BODIES)):
        return False
    return product.is_a(_ADDITION) or not any(map(product.is_a, _NO_BODIES))


def _order(product: Any) -> tuple[str, int]:
    return product.GlobalId or "", product.id()
