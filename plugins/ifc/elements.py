"""The products of an IFC file: which are bodies, in which groups, and which are curved.

Bodies are elements: what is built, installed or furnished. Spaces, openings, annotations, grids,
ports, structural analysis and terrain are not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from msgspec import Struct

from satcheck.scene.document import Refusal, UniqueNames
from satcheck.scene.files.placing import tidy_name

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
_ONLY_EXTENT = {"Box": "a bounding box", "Clearance": "a clearance"}


_ROOT = "IfcElement"  # the superclass of all bodies; no group
# Entities that make curved surfaces.
_CURVED = (
    *("IfcConic", "IfcBSplineCurve", "IfcBSplineSurface", "IfcSpiral", "IfcPolynomialCurve"),
    *("IfcCircleProfileDef", "IfcEllipseProfileDef", "IfcRoundedRectangleProfileDef"),
    *("IfcRevolvedAreaSolid", "IfcSweptDiskSolid", "IfcSurfaceOfRevolution"),
    *("IfcSphere", "IfcRightCircularCone", "IfcRightCircularCylinder"),
    *("IfcCylindricalSurface", "IfcSphericalSurface", "IfcToroidalSurface"),
)
_FACETS = ("IfcFacetedBrep", "IfcTessellatedItem")  # which the file itself has


class Elements(Struct, frozen=True):
    """bodies: by GlobalId. unread: the number of a body -> why its shape is not read. without:
    elements that have neither a shape nor parts. wholes: elements whose parts have the shape.
    left_out: class -> number of other products with a shape."""

    bodies: tuple[Any, ...]
    unread: Mapping[int, Refusal]
    without: tuple[Any, ...]
    wholes: tuple[Any, ...]
    left_out: Counter[str]


def elements_of(model: Any) -> Elements:
    bodies, without, wholes = [], [], []
    unread: dict[int, Refusal] = {}
    left_out: Counter[str] = Counter()
    products = model.by_type("IfcProduct")
    for product in sorted(products, key=lambda each: (each.GlobalId or "", each.id())):
        if not _is_body(product):
            if product.Representation is not None or product.is_a("IfcFeatureElement"):
                left_out[product.is_a()] += 1
        elif material_of(product):
            bodies.append(product)
        elif any(True for _ in parts_of(product)):
            wholes.append(product)
        elif (reason := _unread_shape(product)) is not None:
            bodies.append(product)
            unread[product.id()] = Refusal("unsupported-feature", reason)
        else:
            without.append(product)
    return Elements(tuple(bodies), unread, tuple(without), tuple(wholes), left_out)


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


def _unread_shape(element: Any) -> str | None:
    """How a file states that an element takes up space, without its shape; None: it does not."""
    from ifcopenshell.util.element import get_type

    shape = element.Representation
    stated = {each.RepresentationIdentifier for each in shape.Representations} if shape else set()
    for identifier, what in _ONLY_EXTENT.items():
        if identifier in stated:
            return f"it has no shape, only {what} ({identifier})"
    kind = get_type(element)
    for each in getattr(kind, "RepresentationMaps", None) or ():
        if rank_of(each.MappedRepresentation.RepresentationIdentifier) is not None:
            return f"only its type {kind.GlobalId} has a shape, and the file does not place it"
    return None


def instances_of(model: Any, name: str) -> list[Any]:
    """All instances of a class, in the order of their numbers; none if the schema lacks it."""
    try:
        return sorted(model.by_type(name), key=lambda each: int(each.id()))
    except RuntimeError:
        return []


def declared(model: Any, name: str) -> Any:
    """Return the entity of this name as the schema of the file declares it."""
    from ifcopenshell import schema_by_name

    return schema_by_name(model.schema_identifier).declaration_by_name(name).as_entity()


def parts_of(whole: Any) -> Iterator[Any]:
    """The parts into which IfcRelAggregates or IfcRelNests takes an element apart."""
    for relation in (*whole.IsDecomposedBy, *getattr(whole, "IsNestedBy", ())):
        yield from (part for part in relation.RelatedObjects if part.is_a("IfcElement"))


def _is_body(product: Any) -> bool:
    if not any(map(product.is_a, _BODIES)):
        return False
    return product.is_a(_ADDITION) or not any(map(product.is_a, _NO_BODIES))


def groups_of(model: Any, bodies: Sequence[Any]) -> dict[int, tuple[str, ...]]:
    """The number of each instance -> its groups."""
    classes: dict[str, tuple[str, ...]] = {}
    for name in {body.is_a() for body in bodies}:
        classes[name] = _classes(model, name)
    return {body.id(): (*classes[body.is_a()], *_memberships(body)) for body in bodies}


def _classes(model: Any, name: str) -> tuple[str, ...]:
    """The class and those above it, below IfcElement."""
    types = []
    declaration = declared(model, name)
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
    there = ((kind, each) for kind, each in named if each is not None)
    groups = (f"{kind}:{tidy_name(each.Name, each.GlobalId)}" for kind, each in there)
    return tuple(dict.fromkeys(groups))


def curved_bodies(model: Any, bodies: Sequence[Any]) -> set[int]:
    """The numbers of bodies that have a curved surface, or may have one from an opening."""
    # Classes of instances of the file that make curved surfaces, and of those that are facets.
    curved, facets = (
        {each.is_a() for name in names for each in instances_of(model, name)}
        for names in (_CURVED, _FACETS)
    )
    known: dict[int, bool] = {}

    def is_curved(representation: Any) -> bool:
        key = representation.id()
        if key not in known:
            known[key] = any(map(is_curved_item, representation.Items))
        return known[key]

    def is_curved_item(item: Any) -> bool:
        if item.is_a("IfcMappedItem"):
            return is_curved(item.MappingSource.MappedRepresentation)
        if item.is_a() in facets:
            return False
        return any(_is_curved(each, curved) for each in model.traverse(item))

    numbers = set()
    for body in bodies:
        cut = (relation.RelatedOpeningElement for relation in getattr(body, "HasOpenings", ()))
        if any(is_curved(shown) for each in (body, *cut) for shown in material_of(each)):
            numbers.add(body.id())
    return numbers


def _is_curved(instance: Any, curved: Collection[str]) -> bool:
    """curved: classes of instances that make curved surfaces."""
    kind = instance.is_a()
    if kind in curved:
        return True
    if kind == "IfcIndexedPolyCurve":
        return any(each.is_a() == "IfcArcIndex" for each in instance.Segments or ())
    # Rounded edges, such as those of a rolled section.
    values = instance.get_info().items() if kind.endswith("ProfileDef") else ()
    radii = (value for name, value in values if name.endswith("Radius"))
    return any(isinstance(radius, float) and radius for radius in radii)
