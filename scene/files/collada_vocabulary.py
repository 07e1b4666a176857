"""What the elements of a COLLADA file may hold: names that are read, and names that are harmless.

Khronos, "COLLADA 1.4.1" (2008) and "COLLADA 1.5.0" (2008). Of the contents of <extra> nothing is
known: programs keep data of their own there.
"""

from __future__ import annotations

from satcheck.scene.files.xml_tree import Element
from satcheck.scene.vocabulary import Names, UnknownNames

_TEXT = "words about the file"
_EXTRA = {"extra": "data of a program"}


def _names(read: str, harmless: str = "", why: str = _TEXT) -> Names:
    return Names(frozenset(read.split()), {**dict.fromkeys(harmless.split(), why), **_EXTRA})


# Tag -> its children.
CHILDREN = {
    "COLLADA": _names(
        "asset scene library_visual_scenes library_geometries library_nodes library_animations",
        "library_animation_clips library_cameras library_controllers library_effects "
        "library_force_fields library_images library_lights library_materials library_formulas "
        "library_physics_materials library_physics_models library_physics_scenes library_joints "
        "library_articulated_systems library_kinematics_models library_kinematics_scenes",
        "nothing of it stands in the scene unless a node or the scene names it",
    ),
    "asset": _names(
        "unit up_axis",
        "contributor created keywords modified revision subject title coverage",
    ),
    "scene": _names("instance_visual_scene"),
    "geometry": _names("mesh spline asset"),
    "mesh": _names(
        "source vertices triangles polylist polygons tristrips trifans lines linestrips asset"
    ),
    **dict.fromkeys(
        ("triangles", "lines", "linestrips", "tristrips", "trifans"), _names("input p")
    ),
    "polylist": _names("input p vcount"),
    "polygons": _names("input p ph"),
    "instance_geometry": _names("", "bind_material", "appearance"),
    "instance_node": _names(""),
    "vertices": _names("input"),
}
# Tag -> children of which only the first is read.
_ONCE = {"COLLADA": ("asset", "scene"), "geometry": ("mesh",)}
_ID = "id sid name"
# Tag -> its attributes.
ATTRIBUTES = {
    "unit": _names("meter", "name"),
    "node": _names("", f"{_ID} type layer"),
    "instance_geometry": _names("url", "sid name"),
    "instance_node": _names("url", "sid name proxy"),
    "geometry": _names("", _ID),
    "vertices": _names("", _ID),
    "accessor": _names("source count offset stride"),
    **dict.fromkeys(
        ("triangles", "polylist", "polygons", "tristrips", "trifans"),
        _names("count", "name material"),
    ),
}


def look_at(element: Element, unknown: UnknownNames, *, is_root: bool) -> None:
    """Gather what nobody reads of an element. Raises Refused for a name that is misspelt."""
    place = f"line {element.line}: <{element.tag}>"
    tags = [child.tag for child in element.children]
    for table, names in ((CHILDREN, tags), (ATTRIBUTES, element.attributes)):
        if element.tag in table:
            unknown.look(table[element.tag], names, element.tag, place)
    for tag in _ONCE.get(element.tag, ()):
        if tags.count(tag) > 1:
            unknown.note((element.tag, f"two {tag}"), f"{place}: a second <{tag}> is not read")
    asset = None if is_root else element.find("asset")
    if asset is not None and any(child.tag in ("unit", "up_axis") for child in asset.children):
        unknown.note(("asset", ""), f"{place}: units and axes of its own are not read")
