"""The text of a STEP file: whether it is whole, and the few records that decide what is read.

OpenCascade reads what it can and is silent about the rest, so the text is looked at first.
Source: ISO 10303-21, clear text encoding of the exchange structure.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping

from msgspec import Struct

from satcheck.scene.errors import Refused
from satcheck.scene.vocabulary import Names

_BEGIN, _END = "ISO-10303-21", "END-ISO-10303-21"
_TEXT = rb"'((?:[^']|'')*)'"
_NEXT = rb"\s*,\s*"
_TEXT_OR_NONE = rb"(?:" + _TEXT + rb"|\$)"
_COMMENT_OR_TEXT = re.compile(rb"/\*.*?\*/|'(?:[^']|'')*'", re.DOTALL)
_RECORD = re.compile(rb"(#\d+)\s*=\s*(?:([A-Za-z_]\w*)\s*)?\(")
_REFERENCE = re.compile(rb"#\d+")
_SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*" + _TEXT)
_DOCUMENT = re.compile(rb"=\s*DOCUMENT_FILE\s*\(\s*" + _TEXT)
_PRODUCT = re.compile(rb"(#\d+)\s*=\s*PRODUCT\s*\(\s*" + _TEXT + _NEXT + _TEXT_OR_NONE)
_DEFINITION = re.compile(
    rb"(#\d+)\s*=\s*PRODUCT_DEFINITION(?:_FORMATION|_WITH)?\w*\s*\(\s*"
    + (_TEXT_OR_NONE + _NEXT) * 2
    + rb"(#\d+)"
)
_OCCURRENCE = re.compile(
    rb"=\s*NEXT_ASSEMBLY_USAGE_OCCURRENCE\s*\(\s*"
    + (_TEXT_OR_NONE + _NEXT) * 3
    + rb"#\d+"
    + _NEXT
    + rb"(#\d+)"
)
# What stands for a parameter and is no value of the format, such as nan, -inf and 1.#QNAN.
_NO_VALUE = re.compile(rb"[(,]\s*([A-Za-z_]\w*(?!\w|\s*\()|[-+]\s*[A-Za-z]\w*|[-+]?[\d.]+#\w*)")
_SI_UNIT = re.compile(rb"\bSI_UNIT\s*\(\s*(?:\.(\w+)\.|\$)\s*,\s*\.(\w+)\.\s*\)")
# ISO 10303-41
_PREFIX = re.compile(
    rb"|EXA|PETA|TERA|GIGA|MEGA|KILO|HECTO|DECA|DECI|CENTI|MILLI|MICRO|NANO|PICO|FEMTO|ATTO"
)
_UNIT = re.compile(
    rb"METRE|GRAM|SECOND|AMPERE|KELVIN|MOLE|CANDELA|RADIAN|STERADIAN|HERTZ|NEWTON|PASCAL|JOULE|WATT"
    rb"|COULOMB|VOLT|FARAD|OHM|SIEMENS|WEBER|TESLA|HENRY|DEGREE_CELSIUS|LUMEN|LUX|BECQUEREL|GRAY"
    rb"|SIEVERT"
)
_WIDE = re.compile(r"\\X2\\((?:[0-9A-F]{4})+)\\X0\\")
_NARROW = re.compile(r"\\X\\([0-9A-F]{2})")
# The curved surfaces of ISO 10303-42, also within records of several kinds.
_CURVED = re.compile(
    rb"(?:CYLINDRICAL|CONICAL|SPHERICAL|TOROIDAL|B_SPLINE|BEZIER|UNIFORM|OFFSET|SWEPT)_SURFACE"
    rb"|SURFACE_OF_|TESSELLATED_|TRIANGULATED_"
)
# Solids that OpenCascade does not make from a STEP file.
UNREAD_SOLIDS = frozenset(
    {
        "CSG_SOLID",
        "BOOLEAN_RESULT",
        "BLOCK",
        "RIGHT_ANGULAR_WEDGE",
        "RIGHT_CIRCULAR_CONE",
        "RIGHT_CIRCULAR_CYLINDER",
        "SPHERE",
        "TORUS",
        "EXTRUDED_AREA_SOLID",
        "REVOLVED_AREA_SOLID",
        "EXTRUDED_FACE_SOLID",
        "REVOLVED_FACE_SOLID",
        "SWEPT_DISK_SOLID",
        "HALF_SPACE_SOLID",
        "BOXED_HALF_SPACE",
        "SOLID_REPLICA",
    }
)
# Of AP242. OpenCascade leaves them out.
TESSELLATED = frozenset(
    ("TESSELLATED_SOLID", "TESSELLATED_SHELL", "TESSELLATED_GEOMETRIC_SET", "TRIANGULATED_FACE",
     "COMPLEX_TRIANGULATED_FACE")
)  # fmt: skip
# Records that place and shape bodies. Others are many, and few names of them are like these.
_KINDS = Names(
    frozenset(
        ("ADVANCED_BREP_SHAPE_REPRESENTATION", "ADVANCED_FACE", "AXIS2_PLACEMENT_3D",
         "B_SPLINE_CURVE_WITH_KNOTS", "B_SPLINE_SURFACE_WITH_KNOTS", "BREP_WITH_VOIDS",
         "CARTESIAN_POINT", "CARTESIAN_TRANSFORMATION_OPERATOR_3D", "CIRCLE", "CLOSED_SHELL",
         "CONICAL_SURFACE", "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", "CONVERSION_BASED_UNIT",
         "CYLINDRICAL_SURFACE", "DIRECTION", "EDGE_CURVE", "EDGE_LOOP", "ELLIPSE", "FACE_BOUND",
         "FACE_OUTER_BOUND", "FACE_SURFACE", "FACETED_BREP", "FACETED_BREP_SHAPE_REPRESENTATION",
         "GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION", "GLOBAL_UNIT_ASSIGNED_CONTEXT",
         "ITEM_DEFINED_TRANSFORMATION", "LENGTH_MEASURE_WITH_UNIT", "LENGTH_UNIT",
         "MANIFOLD_SOLID_BREP", "MANIFOLD_SURFACE_SHAPE_REPRESENTATION", "MAPPED_ITEM",
         "NEXT_ASSEMBLY_USAGE_OCCURRENCE", "OPEN_SHELL", "ORIENTED_CLOSED_SHELL", "ORIENTED_EDGE",
         "ORIENTED_OPEN_SHELL", "POLY_LOOP", "PRODUCT_DEFINITION", "PRODUCT_DEFINITION_SHAPE",
         "REPRESENTATION_MAP", "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION",
         "SHAPE_DEFINITION_REPRESENTATION", "SHAPE_REPRESENTATION",
         "SHAPE_REPRESENTATION_RELATIONSHIP", "SHELL_BASED_SURFACE_MODEL", "SI_UNIT",
         "SPHERICAL_SURFACE", "SURFACE_OF_LINEAR_EXTRUSION", "SURFACE_OF_REVOLUTION",
         "TOROIDAL_SURFACE", "VERTEX_LOOP", "VERTEX_POINT")
    ),
    dict.fromkeys(
        ("CSG_SHAPE_REPRESENTATION", "CARTESIAN_TRANSFORMATION_OPERATOR",
         "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
         "MANIFOLD_SUBSURFACE_SHAPE_REPRESENTATION", "FACE_SHAPE_REPRESENTATION_RELATIONSHIP",
         "FEA_AXIS2_PLACEMENT_3D", "CARTESIAN_TRANSFORMATION_OPERATOR_2D",
         "NON_MANIFOLD_SURFACE_SHAPE_REPRESENTATION", "PRODUCT_DEFINITION_USAGE",
         "AXIS2_PLACEMENT_2D", "REPRESENTATION_RELATIONSHIP"),
        "a kind of its own: what it holds is counted by its solids and faces",
    ),
    alike=0.9,
)  # fmt: skip
_COMPLEX = re.compile(rb"=\s*\(([^;]*);")
_KIND = re.compile(rb"([A-Za-z_]\w*)\s*\(")
_SURFACES = frozenset(("ADVANCED_FACE", "FACE_SURFACE"))


class Exchange(Struct, frozen=True):
    """kinds: how many records of each kind there are. products: occurrences without a name of
    their own, by their identifiers -> the names of their products. documents: the other files that
    the file names. has_unit: it states a unit of length. is_curved: it has curved surfaces."""

    kinds: Mapping[str, int]
    products: Mapping[str, str]
    documents: tuple[str, ...]
    has_unit: bool
    is_curved: bool

    @property
    def faces(self) -> int:
        return self.kinds.get("ADVANCED_FACE", 0) + self.kinds.get("FACE_SURFACE", 0)


def read_exchange(data: bytes) -> Exchange:
    """Raises SatcheckError for a file that is cut off, that names records which it lacks, that has
    values or units which are none, kinds
    that are misspelt, or solids which are not read."""
    if not data.lstrip().startswith(_BEGIN.encode()):
        raise Refused("not-this-format", f"not a STEP file: it does not start with {_BEGIN}")
    schema = _SCHEMA.search(data)
    if schema is not None and schema[1].upper().startswith(b"IFC"):
        raise Refused("format-mismatch", "its content is an IFC model: name the file .ifc")
    bare = _COMMENT_OR_TEXT.sub(b"", data)
    if _END.encode() not in bare or b"'" in bare:
        message = f"the file ends before {_END}, or within a text"
        raise Refused("truncated", message)
    _refuse_values(bare)
    kinds = _kinds(bare)
    unread = sorted(UNREAD_SOLIDS & kinds.keys())
    if unread:
        message = f"solids of kind {', '.join(unread)} are not read: write their boundaries instead"
        raise Refused("unsupported-feature", message)
    if not kinds.keys() & _SURFACES and (facets := sorted(TESSELLATED & kinds.keys())):
        message = f"it has only facets ({', '.join(facets)}), which are not read: export surfaces"
        raise Refused("unsupported-feature", message)
    of_complex = {
        m.decode("ascii").upper() for c in _COMPLEX.findall(bare) for m in _KIND.findall(c)
    }
    _KINDS.refuse_misspelt(sorted({*kinds, *of_complex}), "records")
    documents = dict.fromkeys(_decoded(match[1]) for match in _DOCUMENT.finditer(data))
    return Exchange(
        kinds,
        _unnamed(data),
        tuple(filter(None, documents)),
        has_unit=b"LENGTH_UNIT" in bare,
        is_curved=_CURVED.search(bare) is not None,
    )


def _refuse_values(bare: bytes) -> None:
    """OpenCascade reads numbers that are none, and unknown units, as something else."""
    if (wrong := _NO_VALUE.search(bare)) is not None:
        message = f"{wrong[1].decode('ascii', 'replace')!r} is no value of a record"
        raise Refused("bad-record", message)
    for prefix, unit in _SI_UNIT.findall(bare):
        if not (_PREFIX.fullmatch(prefix) and _UNIT.fullmatch(unit)):
            named = f"{prefix.decode()} {unit.decode()}".strip()
            raise Refused("bad-record", f"SI_UNIT: {named} is no unit")


def _kinds(bare: bytes) -> Counter[str]:
    """The kinds of records of a text without comments and texts."""
    kinds: Counter[str] = Counter()
    defined: set[bytes] = set()
    for match in _RECORD.finditer(bare):
        defined.add(match[1])
        kinds[(match[2] or b"").decode("ascii").upper()] += 1
    missing = {match[0] for match in _REFERENCE.finditer(bare)} - defined
    if missing:
        first = min(missing, key=lambda name: (len(name), name)).decode()
        message = f"the file names {len(missing)} records that it lacks, such as {first}"
        raise Refused("index-out-of-range", message)
    return kinds


def _unnamed(data: bytes) -> dict[str, str]:
    """The occurrences without a name, by their identifiers -> the names of their products."""
    products = {m[1]: _decoded(m[3] or b"") or _decoded(m[2]) for m in _PRODUCT.finditer(data)}
    owners = {match[1]: match[4] for match in _DEFINITION.finditer(data)}
    names: dict[str, str] = {}
    for match in _OCCURRENCE.finditer(data):
        formation = owners.get(match[4], b"")
        product = products.get(owners.get(formation, b""), "")
        if not (match[2] or b"").strip() and product:
            names[_decoded(match[1] or b"")] = product
    return names


def _decoded(text: bytes) -> str:
    """A text without the escapes of the format."""
    plain = text.decode("utf-8", "replace").replace("''", "'")
    plain = _WIDE.sub(lambda m: bytes.fromhex(m[1]).decode("utf-16-be", "replace"), plain)
    return _NARROW.sub(lambda m: chr(int(m[1], 16)), plain).replace("\\\\", "\\").strip()
