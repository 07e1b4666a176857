"""What the elements of a 3MF model may hold: names that are read, and names that are harmless.

3MF core specification 1.3 and the extensions of the 3MF consortium; the attributes that common
slicers add. A name of an extension has the usual prefix of its namespace.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

from satcheck.scene.files.xml_tree import UNDECLARED, split_name
from satcheck.scene.vocabulary import Names, reasons

CORE = frozenset(
    {
        "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
        "http://schemas.microsoft.com/3dmanufacturing/2013/01",
    }
)
TYPES = frozenset({"model", "solidsupport", "support", "surface", "other"})
UNITS = frozenset({"micron", "millimeter", "centimeter", "inch", "foot", "meter"})
PREFIXES = {
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06": "p",
    "http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04": "pa",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02": "m",
    "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07": "s",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07": "t",
    "http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/04": "sc",
    "http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/07": "sc",
    "http://schemas.openxmlformats.org/markup-compatibility/2006": "mc",
    "http://purl.org/dc/elements/1.1/": "dc",
    "http://purl.org/dc/terms/": "dcterms",
    "http://schemas.slic3r.org/3mf/2017/06": "slic3rpe",
    "http://schemas.bambulab.com/package/2021": "BambuStudio",
    "http://software.ultimaker.com/xml/cura/3mf/2015/10": "cura",
    "http://www.w3.org/XML/1998/namespace": "xml",
    "http://www.w3.org/2001/XMLSchema-instance": "xsi",
}
# Words in the namespaces of extensions that define geometry: a file cannot make them ignorable.
_GEOMETRY = frozenset(
    {
        *("alternatives", "beamlattice", "booleanoperations", "displacement"),
        *("implicit", "slice", "volumetric"),
    }
)
FULL = frozenset({"s:meshresolution", "pa:modelresolution"})  # the mesh counts if "fullres"
_ABOUT = reasons(
    of_XML="xml:* xsi:*",
    a_name="p:UUID partnumber",
    it_is_checked_all_the_same="printable",
    printing="slic3rpe:* BambuStudio:* cura:*",
)


def _names(read: str, **harmless: str) -> Names:
    return Names(frozenset(read.split()), _ABOUT | reasons(**harmless))


# By the element of the core namespace.
ATTRIBUTES = {
    "model": _names(
        "unit requiredextensions",
        nothing_depends_on_them="recommendedextensions",
        a_language="lang",
        a_picture="preview",
        names_of_its_namespaces_count_for_no_body="mc:Ignorable",
    ),
    "object": _names(
        "id type s:meshresolution pa:modelresolution",
        a_name="name",
        appearance="colorid materialid pid pindex",
        a_picture="thumbnail",
        the_material_of_the_inside="volumeid",
    ),
    "component": _names("objectid transform p:path"),
    "item": _names("objectid transform p:path"),
    "vertex": _names("x y z"),
    "triangle": _names(
        "v1 v2 v3",
        appearance="colorid materialid pid p1 p2 p3 cv1 cv2 cv3",
        printing="paint_color paint_seam paint_supports paint_fuzzy_skin face_property",
    ),
    **dict.fromkeys(
        ("build", "resources", "mesh", "vertices", "triangles", "components"), _names("")
    ),
}
_DATA = reasons(data="metadata metadatagroup dc:* dcterms:*", printing="slic3rpe:*")
CHILDREN = {
    "model": Names(frozenset({"resources", "build"}), _DATA),
    "resources": Names(
        frozenset({"object"}),
        reasons(  # those without a prefix are of the core specification, and of drafts of it
            appearance="""basematerials color colorgroup compositematerials material multiproperties
                texture texture2d texture2dgroup""",
            it_counts_where_an_object_names_it="*:*",
        ),
    ),
    "object": Names(frozenset({"mesh", "components"}), _DATA),
    "mesh": Names(
        frozenset({"vertices", "triangles"}),
        {"t:trianglesets": "names of triangles", "texturevertices": "appearance"},
    ),
    "vertices": Names(frozenset({"vertex"})),
    "triangles": Names(frozenset({"triangle"})),
    "components": Names(frozenset({"component"})),
    "build": Names(frozenset({"item"}), _DATA),
    "item": Names(frozenset(), _DATA),
    **dict.fromkeys(("vertex", "triangle", "component"), Names(frozenset())),
}
RELATIONSHIPS = Names(frozenset({"Relationship"}))
RELATIONSHIP = Names(frozenset({"Target", "Type", "TargetMode"}), {"Id": "a name"})
# Settings of Cura for an object that is no body, or takes from one.
CURA_VOLUMES = Names(
    frozenset({"anti_overhang_mesh", "cutting_mesh", "infill_mesh", "support_mesh"})
)


@lru_cache(maxsize=256)
def short(name: str) -> str:
    """Return the name of an attribute with the prefix of its namespace."""
    namespace, local = split_name(name)
    if not namespace:
        return local
    prefix = PREFIXES.get(namespace) or namespace.removeprefix(UNDECLARED)
    return f"{prefix}:{local}"


@lru_cache(maxsize=256)
def short_element(name: str) -> str:
    """Return the name of an element: one of the core specification alone, or with a prefix."""
    namespace, local = split_name(name)
    if namespace in CORE:
        return local
    return short(name) if namespace else f"{local} without a namespace"


def ignorable(attributes: Mapping[str, str], prefixes: Mapping[str | None, str]) -> frozenset[str]:
    """Return the namespaces that a model declares ignorable, and that nobody knows."""
    named = {prefixes.get(each, "") for each in attributes.get("mc:Ignorable", "").split()}
    return frozenset(
        each.removeprefix(UNDECLARED)
        for each in named - CORE - PREFIXES.keys() - {""}
        if _GEOMETRY.isdisjoint(each.split("/"))
    )
