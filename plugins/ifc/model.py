"""Opens an IFC file, and refuses one that its parser reads only in part.

The parser goes on without what it cannot read. A placement that is lost moves a body to the origin.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from graphlib import CycleError, TopologicalSorter
from typing import Any

from msgspec import Struct

from satcheck.plugins.ifc.elements import declared, instances_of
from satcheck.plugins.ifc.kernel import Message, logged, start_log
from satcheck.scene.access import Most
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import imported
from satcheck.scene.files.zip_guard import opened_zip, read_part

_ZIP = b"PK\x03\x04"
_FIRST = b"ISO-10303-21"
_LAST = b"END-ISO-10303-21"
_ENDS_BYTES = 4096
_WRONG_COUNT = "VAL016"  # the code of a message: an instance has too few or too many attributes
_TWICE = "Overwriting instance"
_SHAPE = "IfcProductRepresentation"
# What shapes or places a body. Damage elsewhere changes no body.
_SHAPING = (
    "IfcRepresentationItem",
    "IfcRepresentation",
    "IfcRepresentationMap",
    "IfcRepresentationContext",
    _SHAPE,
    "IfcProfileDef",
    "IfcObjectPlacement",
    "IfcNamedUnit",
    "IfcUnitAssignment",
    "IfcMeasureWithUnit",
    "IfcRelVoidsElement",
)


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


def open_model(data: memoryview, most: Most) -> Any:
    """The ifcopenshell.file. most: bytes of the model in an archive. Raises Refused."""
    content = unpacked(data, most)
    _refuse_other_content(content)
    ifcopenshell = imported("ifcopenshell", "ifc", "IFC files")
    start_log()
    try:
        model = ifcopenshell.file.from_string(_text(content))
    except RuntimeError as error:
        said = next((message.line for message in logged()), str(error))
        raise Refused("bad-record", f"the file cannot be parsed: {said}") from None
    _refuse_damage(model, logged())
    refuse_other_kinds(model)
    units = (unit for each in model.by_type("IfcUnitAssignment") for unit in each.Units)
    if not any(getattr(unit, "UnitType", None) == "LENGTHUNIT" for unit in units):
        raise Refused("bad-record", "the file states no unit of length (LENGTHUNIT)")
    _refuse_cycles(model)
    if not model.by_type("IfcGeometricRepresentationContext"):
        message = "the file has no IfcGeometricRepresentationContext, so its shapes have no meaning"
        raise Refused("bad-record", message)
    return model


def unpacked(data: memoryview, most: Most) -> bytes:
    """The text of the file; of the only IFC file in an ifcZIP. Raises Refused."""
    if bytes(data[: len(_ZIP)]) != _ZIP:
        return bytes(data)
    with opened_zip(data, "an ifcZIP file") as archive:
        names = [name for name in archive.namelist() if name.lower().endswith((".ifc", ".ifcxml"))]
        if len(names) != 1:
            message = f"an ifcZIP file holds one IFC file, not {len(names)}"
            raise Refused("bad-record" if names else "missing-resource", message)
        return read_part(archive, names[0], most)


def _refuse_other_content(content: bytes) -> None:
    start = content[:_ENDS_BYTES].lstrip(b"\xef\xbb\xbf \t\r\n")
    if start.startswith(b"<"):
        message = "ifcXML is not read: export the model as a STEP physical file (.ifc)"
        raise Refused("unsupported-feature", message)
    if not start.startswith(_FIRST):
        message = f"not an IFC file: it does not begin with {_FIRST.decode()}"
        raise Refused("not-this-format", message)
    if _LAST not in content[-_ENDS_BYTES:]:
        raise Refused("truncated", f"the file ends without {_LAST.decode()}")


def _text(content: bytes) -> str:
    """ISO 10303-21 prescribes ISO 8859-1; many programs write UTF-8."""
    try:
        return content.decode()
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _refuse_damage(model: Any, messages: Iterable[Message]) -> None:
    for message in messages:
        if message.level == "error" or message.message.startswith(_TWICE):
            raise Refused("bad-record", f"the parser reads a part of the file: {message.line}")
        if message.code == _WRONG_COUNT and _shapes(model, message):
            raise Refused("bad-record", f"a record is of another form: {message.line}")


def _shapes(model: Any, message: Message) -> bool:
    """Whether the instance that the message ends with shapes or places a body. A product does not
    if its placement and its shape are where they should be: then it lacks what follows them."""
    number = message.message.rpartition("#")[2]
    instance = model.by_id(int(number)) if number.isdecimal() else None
    if instance is None or any(map(instance.is_a, _SHAPING)):
        return True
    if not instance.is_a("IfcProduct"):
        return False
    placement, shape = instance.ObjectPlacement, instance.Representation
    return not (_is_a(placement, "IfcObjectPlacement") and _is_a(shape, _SHAPE))


def _is_a(value: Any, name: str) -> bool:
    """Whether an attribute is empty or an instance of the class."""
    return value is None or (hasattr(value, "is_a") and value.is_a(name))


def _refuse_cycles(model: Any) -> None:
    """The kernel ends its process over a placement that is relative to itself."""
    above = {
        each.id(): [each.PlacementRelTo.id()]
        for each in model.by_type("IfcLocalPlacement")
        if each.PlacementRelTo is not None
    }
    try:
        TopologicalSorter(above).prepare()
    except CycleError as error:
        message = f"placement #{error.args[1][0]} is relative to itself: a cycle"
        raise Refused("reference-cycle", message) from None


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
        values = value if self.is_list else (value,)
        return isinstance(values, tuple) and all(
            hasattr(each, "is_a") and any(map(each.is_a, self.classes)) for each in values
        )


def refuse_other_kinds(model: Any) -> None:
    """Refuse instances whose attributes are of other kinds than the schema prescribes: the parser
    keeps a number where a shape belongs, or a list where an element does. These attributes are the
    ones that this package follows. Raises Refused (`bad-record`)."""
    known: dict[str, tuple[_Attribute, ...]] = {}
    for name in _READ:
        for instance in instances_of(model, name):
            kind = instance.is_a()
            if kind not in known:
                known[kind] = tuple(_attributes(model, kind))
            for each in known[kind]:
                if not each.fits(instance[each.number]):
                    what = f"{kind} #{instance.id()}: {each.name}"
                    raise Refused("bad-record", f"{what} is not what the schema prescribes")


def _attributes(model: Any, kind: str) -> Iterator[_Attribute]:
    for number, attribute in enumerate(declared(model, kind).all_attributes()):
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
