"""Which volumes of a 3MF project are no material, as the configs of slicers state.

PrusaSlicer and SuperSlicer write Metadata/Slic3r_PE_model.config, with volumes as ranges of
triangles of an object; SuperSlicer has further names for it. Bambu Studio and OrcaSlicer write
Metadata/model_settings.config, with parts that are components of an object.
"""

from __future__ import annotations

from msgspec import Struct

from satcheck.scene.errors import Refused
from satcheck.scene.loading.unknown_names import refuse_misspelt
from satcheck.scene.loading.xml_tree import Element
from satcheck.scene.vocabulary import Names

CONFIGS = "metadata/*model*.config"  # in lower case
HOLES = "metadata/*drain_holes*"
# The parts of a package that place or exempt bodies; the others are the programs' own.
SIDE_FILES = Names(
    frozenset({"_rels/.rels", "metadata/slic3r_pe_model.config", "metadata/model_settings.config"}),
    {
        CONFIGS: "read",
        **dict.fromkeys(
            (f"metadata/{name}.config" for name in ("slic3r_pe", "project_settings", "slice_info")),
            "printing",
        ),
        "*/_rels/*": "of other parts",
    },
)
# What is read in a config; slicers write many other names there.
_ELEMENTS = Names(frozenset({"object", "volume", "part", "metadata"}))
_ATTRIBUTES = Names(frozenset({"id", "firstid", "lastid", "subtype", "key", "value"}))
_KEYS = Names(frozenset({"volume_type", "modifier"}))
_SOLID = frozenset({"ModelPart", "normal_part"})
_NEGATIVE = frozenset({"NegativeVolume", "negative_part"})
_SETTINGS = frozenset(
    {
        *("ParameterModifier", "SupportBlocker", "SupportEnforcer"),
        *("modifier_part", "support_blocker", "support_enforcer"),
    }
)


class Volume(Struct, frozen=True):
    """A volume of an object that is no material. triangles: its first and last one; part: the id of
    its component; of these one is None. negative: it is taken away from the object."""

    owner: str
    triangles: tuple[int, int] | None
    part: str | None
    negative: bool


def volumes(config: Element) -> list[Volume]:
    """Return the volumes that are no material. Raises Refused for an unknown kind or a misspelt
    name."""
    if config.tag != "config":
        config.refuse("the outermost element of the config of a slicer should be <config>")
    _refuse_misspelt(config)
    return [
        volume
        for owner in config.all("object")
        for element in owner.children
        if element.tag in ("volume", "part") and (volume := _volume(owner, element)) is not None
    ]


def _refuse_misspelt(element: Element) -> None:
    place = f"config of a slicer, line {element.line}: <{element.tag}>"
    refuse_misspelt(_ATTRIBUTES, element.attributes, place)
    refuse_misspelt(_ELEMENTS, [child.tag for child in element.children], place)
    if element.tag == "metadata":
        refuse_misspelt(_KEYS, [element.attributes.get("key", "")], place)
    for child in element.children:
        if child.tag in _ELEMENTS.read:
            _refuse_misspelt(child)


def _volume(owner: Element, element: Element) -> Volume | None:
    kind = element.attributes.get("subtype") or _kind(element)
    if kind in _SOLID:
        return None
    if kind not in _NEGATIVE | _SETTINGS:
        message = f"line {element.line}: a volume of the kind {kind!r} is not known"
        raise Refused("unsupported-feature", f"config of a slicer: {message}")
    id_ = owner.attribute("id")
    if element.tag == "part":
        return Volume(id_, None, element.attribute("id"), kind in _NEGATIVE)
    triangles = element.integer("firstid"), element.integer("lastid")
    return Volume(id_, triangles, None, kind in _NEGATIVE)


def _kind(element: Element) -> str:
    """Return what the keys of a volume say; older versions have `modifier` alone."""
    values = {
        each.attributes.get("key"): each.attributes.get("value", "")
        for each in element.all("metadata")
    }
    modifies = values.get("modifier") == "1"
    return values.get("volume_type") or ("ParameterModifier" if modifies else "ModelPart")
