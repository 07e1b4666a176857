"""The parts of a 3MF package beside its models, and which volumes the configs of slicers leave out.

PrusaSlicer and SuperSlicer write Metadata/Slic3r_PE_model.config, with volumes as ranges of
triangles of an object; SuperSlicer has further names for it. Bambu Studio and OrcaSlicer write
Metadata/model_settings.config, with parts that are components of an object.
"""

from __future__ import annotations

from msgspec import Struct

from satcheck.scene.errors import Refused
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.vocabulary import Names, UnknownNames, reasons

CONFIGS = "metadata/*model*.config"  # in lower case
# The parts of a package, in lower case. Programs put their own into folders of their own; those of
# slicers are in the folder Metadata.
_PRINTING = """slic3r.config slic3r_pe.config superslicer.config print_profile.config
    project_settings.config slice_info.config print_setting_*.config process_settings_*.config
    filament_settings_*.config machine_settings_*.config *layer_heights_profile.txt
    *layer_config_ranges.xml *sla_support_points.txt *custom_gcode_per_* *cut_information.xml
    *wipe_tower_information.xml *brim_ear_points.txt filament_sequence.json plate_*.json *.gcode
    *.gcode.md5 *_pt*.xml cura/*"""
SIDE_FILES = Names(
    frozenset({"_rels/.rels", "metadata/slic3r_pe_model.config", "metadata/model_settings.config"}),
    {
        **dict.fromkeys((f"metadata/{name}" for name in _PRINTING.split()), "printing"),
        **reasons(
            read=CONFIGS,
            of_other_parts="*/_rels/*",
            it_counts_where_a_model_names_it="*.model",
            a_picture="*.png *.jpg *.jpeg *.svg *.webp",
            about_the_file="*.prop metadata/*core*.xml",
        ),
    },
)
# What the elements of a config may hold.
_METADATA = {"metadata": "data"}
_ELEMENTS = {
    "config": Names(frozenset({"object"}), dict.fromkeys(("plate", "assemble"), "printing")),
    "object": Names(frozenset({"volume", "part"}), _METADATA),
    **dict.fromkeys(
        ("volume", "part"),
        Names(
            frozenset({"metadata"}),
            reasons(of_the_repair="mesh mesh_stat", what_the_mesh_was_made_of="*text* *shape"),
        ),
    ),
}
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


def volumes(config: Element, unknown: UnknownNames) -> list[Volume]:
    """Return the volumes that are no material. Raises Refused for an unknown kind or a misspelt
    name."""
    if config.tag != "config":
        config.refuse("the outermost element of the config of a slicer should be <config>")
    _look(config, unknown)
    return [
        volume
        for owner in config.all("object")
        for element in owner.children
        if element.tag in ("volume", "part") and (volume := _volume(owner, element)) is not None
    ]


def _look(element: Element, unknown: UnknownNames) -> None:
    place = f"config of a slicer, line {element.line}: <{element.tag}>"
    _ATTRIBUTES.refuse_misspelt(element.attributes, place)
    if element.tag == "metadata":
        _KEYS.refuse_misspelt([element.attributes.get("key", "")], place)
    if names := _ELEMENTS.get(element.tag):
        unknown.look(names, [child.tag for child in element.children], element.tag, place)
        for child in element.children:
            _look(child, unknown)


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
