"""Refuses instances whose attributes are of other kinds than the schema prescribes.

The parser keeps any value in any place: a number where a shape belongs, a list where an element
does. The readers of this folder follow the attributes that are checked here.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from msgspec import Struct

from satcheck.scene.errors import Refused

# Of these classes, and of those below them.
_READ = (
    *("IfcProduct", "IfcTypeProduct", "IfcGroup", "IfcContext", "IfcProject", "IfcUnitAssignment"),
    *("IfcObjectPlacement", "IfcProductRepresentation", "IfcRepresentation"),
    *("IfcRepresentationMap", "IfcMappedItem", "IfcRelAggregates", "IfcRelNests"),
    *("IfcRelVoidsElement", "IfcRelFillsElement", "IfcRelProjectsElement"),
    *("IfcRelConnectsElements", "IfcRelCoversBldgElements", "IfcRelConnectsPorts"),
    *("IfcRelConnectsPortToElement", "IfcRelAssignsToGroup", "IfcRelDefinesByType"),
    "IfcRelContainedInSpatialStructure",
)
_TEXTS = frozenset(("GlobalId", "RepresentationIdentifier", "RepresentationType"))
# Many programs leave it empty, and nobody reads it.
_UNREAD = frozenset(("OwnerHistory",))


class _Attribute(Struct, frozen=True):
    """classes: of the instance in it, or of those in its list; (): a text."""

    number: int
    name: str
    classes: tuple[str, ...]
    is_list: bool
    is_optional: bool

    def fits(self, value: Any) -> bool:
        if not self.classes:
            return value is None or isinstance(value, str)
        if value is None:
            return self.is_optional
        if not self.is_list:
            return self._is_one(value)
        return isinstance(value, tuple) and all(map(self._is_one, value))

    def _is_one(self, value: Any) -> bool:
        return hasattr(value, "is_a") and any(map(value.is_a, self.classes))


def refuse_other_kinds(model: Any) -> None:
    """Raises Refused (`bad-record`)."""
    known: dict[str, tuple[_Attribute, ...]] = {}
    for name in _READ:
        for instance in _instances(model, name):
            kind = instance.is_a()
            if kind not in known:
                known[kind] = tuple(_attributes(model, kind))
            for each in known[kind]:
                if not each.fits(instance[each.number]):
                    message = (
                        f"{kind} #{instance.id()}: {each.name} is not what the schema prescribes"
                    )
                    raise Refused("bad-record", message)


def _instances(model: Any, name: str) -> list[Any]:
    try:
        return list(model.by_type(name))
    except RuntimeError:  # the schema lacks the class
        return []


def _attributes(model: Any, kind: str) -> Iterator[_Attribute]:
    from ifcopenshell import schema_by_name

    declaration = schema_by_name(model.schema_identifier).declaration_by_name(kind).as_entity()
    for number, attribute in enumerate(declaration.all_attributes()):
        name, kind_of_value = attribute.name(), attribute.type_of_attribute()
        is_list = kind_of_value.as_aggregation_type() is not None
        if is_list:
            kind_of_value = kind_of_value.as_aggregation_type().type_of_element()
        named = kind_of_value.as_named_type()
        classes = tuple(_classes(named.declared_type())) if named is not None else ()
        if (classes and name not in _UNREAD) or name in _TEXTS:
            yield _Attribute(number, name, classes, is_list, attribute.optional())


def _classes(declaration: Any) -> Iterator[str]:
    """An entity, or those of a select; none for a number, a text or an enumeration."""
    if declaration.as_entity() is not None:
        yield declaration.name()
    elif declaration.as_select_type() is not None:
        for each in declaration.as_select_type().select_list():
            yield from _classes(each)
