"""The text of a STEP file: whether it is whole, and the few records that decide what is read.

OpenCascade reads what it can and is silent about the rest, so the text is looked at first.
Source: ISO 10303-21, clear text encoding of the exchange structure.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping

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
# Of AP242. OpenCascade leaves them out.
_FACETS = """TESSELLATED_SOLID TESSELLATED_SHELL TESSELLATED_GEOMETRIC_SET TRIANGULATED_FACE
    COMPLEX_TRIANGULATED_FACE"""
TESSELLATED = frozenset(_FACETS.split())
# Records that place and shape bodies. Others are many, and few names of them are like these.
_READ = """ADVANCED_BREP_SHAPE_REPRESENTATION ADVANCED_FACE AXIS2_PLACEMENT_3D
    B_SPLINE_CURVE_WITH_KNOTS B_SPLINE_SURFACE_WITH_KNOTS BREP_WITH_VOIDS CARTESIAN_POINT
    CARTESIAN_TRANSFORMATION_OPERATOR_3D CIRCLE CLOSED_SHELL CONICAL_SURFACE
    CONTEXT_DEPENDENT_SHAPE_REPRESENTATION CONVERSION_BASED_UNIT CYLINDRICAL_SURFACE DIRECTION
    EDGE_CURVE EDGE_LOOP ELLIPSE FACE_BOUND FACE_OUTER_BOUND FACE_SURFACE FACETED_BREP
    FACETED_BREP_SHAPE_REPRESENTATION GEOMETRICALLY_BOUNDED_SURFACE_SHAPE_REPRESENTATION
    GLOBAL_UNIT_ASSIGNED_CONTEXT ITEM_DEFINED_TRANSFORMATION LENGTH_MEASURE_WITH_UNIT
    LENGTH_UNIT MANIFOLD_SOLID_BREP MANIFOLD_SURFACE_SHAPE_REPRESENTATION MAPPED_ITEM
    NEXT_ASSEMBLY_USAGE_OCCURRENCE OPEN_SHELL ORIENTED_CLOSED_SHELL ORIENTED_EDGE
    ORIENTED_OPEN_SHELL POLY_LOOP PRODUCT_DEFINITION PRODUCT_DEFINITION_SHAPE
    REPRESENTATION_MAP REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION
    SHAPE_DEFINITION_REPRESENTATION SHAPE_REPRESENTATION SHAPE_REPRESENTATION_RELATIONSHIP
    SHELL_BASED_SURFACE_MODEL SI_UNIT SPHERICAL_SURFACE SURFACE_OF_LINEAR_EXTRUSION
    SURFACE_OF_REVOLUTION TOROIDAL_SURFACE VERTEX_LOOP VERTEX_POINT"""
_COUNTED = """CSG_SHAPE_REPRESENTATION CARTESIAN_TRANSFORMATION_OPERATOR
    GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION
    MANIFOLD_SUBSURFACE_SHAPE_REPRESENTATION FACE_SHAPE_REPRESENTATION_RELATIONSHIP
    FEA_AXIS2_PLACEMENT_3D CARTESIAN_TRANSFORMATION_OPERATOR_2D
    NON_MANIFOLD_SURFACE_SHAPE_REPRESENTATION PRODUCT_DEFINITION_USAGE AXIS2_PLACEMENT_2D
    REPRESENTATION_RELATIONSHIP"""
_KINDS = Names(
    frozenset(_READ.split()),
    dict.fromkeys(_COUNTED.split(), "its own kind: its solids and faces are counted"),
    alike=0.9,
)
# What the records of a list should be, and where such lists stand. A record of several kinds is of
# the kind "".
_NO_SURFACE = """AXIS*_PLACEMENT* CARTESIAN_* DIRECTION VECTOR *CURVE* LINE CIRCLE ELLIPSE *POLYLINE
    *EDGE* *POINT* *WIREFRAME* *VERTEX* PLANE *_SURFACE *_ITEM *TEXT* *CALLOUT* *DIMENSION* *SYMBOL*
    ANNOTATION_* DRAUGHTING_* CAMERA_* TESSELLATED_* *TRIANGULATED_* COORDINATES_LIST"""
_BODIES = """MANIFOLD_SOLID_BREP BREP_WITH_VOIDS FACETED_BREP SHELL_BASED_SURFACE_MODEL MAPPED_ITEM
    FACE_BASED_SURFACE_MODEL GEOMETRIC_SET ADVANCED_FACE FACE_SURFACE"""
_ITEMS = Names(
    frozenset(["", *_BODIES.split()]),
    dict.fromkeys(_NO_SURFACE.split(), "no surface with bounds, or a copy of one"),
)
_FACES = Names(frozenset(("", "ADVANCED_FACE", "FACE_SURFACE", "FACE", "ORIENTED_FACE", "SUBFACE")))
_AXES = "AXIS2_PLACEMENT_2D AXIS2_PLACEMENT_3D FEA_AXIS2_PLACEMENT_3D"
_PLACES = Names(frozenset(("", "CARTESIAN_TRANSFORMATION_OPERATOR_3D", *_AXES.split())))
_LISTS = (
    ("a shape", _ITEMS, re.compile(rb"SHAPE_REPRESENTATION\s*\(\s*\$?\s*,\s*\(([^)]*)\)")),
    ("a shell", _FACES, re.compile(rb"(?:_SHELL|FACE_SET)\s*\(\s*\$?\s*,\s*\(([^)]*)\)")),
    ("an occurrence", _PLACES, re.compile(rb"ITEM_DEFINED_TRANSFORMATION\s*\(([^;)]*)\)")),
)
# Occurrences that OpenCascade does not place.
_UNREAD_USES = ("QUANTIFIED_ASSEMBLY_COMPONENT_USAGE", "PROMISSORY_USAGE_OCCURRENCE")
_SHAPE_OF = re.compile(rb"(#\d+)\s*=\s*PRODUCT_DEFINITION_SHAPE\s*\([^#;]*(#\d+)")
_PLACED = re.compile(rb"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION\s*\(\s*#\d+\s*,\s*(#\d+)")
_USE = re.compile(rb"(#\d+)\s*=\s*NEXT_ASSEMBLY_USAGE_OCCURRENCE\s*\(")
_NO_PLACE = re.compile(rb"ITEM_DEFINED_TRANSFORMATION\s*\([^;)]*\$\s*(?:,\s*#\d+\s*)?\)")
_NUMBER = rb"\s*[-+]?\d+\.?\d*(?:[Ee][-+]?\d+)?\s*"
_NO_POINT = re.compile(
    rb"(?<!\w)(?:CARTESIAN_POINT|DIRECTION)\s*\("
    rb"(?!(?:\s*\$?\s*,)?\s*\(%b(?:,%b){0,2}\)\s*\))[^;]*" % (_NUMBER, _NUMBER)
)
_LENGTH = re.compile(rb"(#\d+)\s*=\s*\([^;]*\bLENGTH_UNIT\b")
_UNITS = re.compile(rb"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\s*\(([^)]*)\)")
_COMPLEX = re.compile(rb"=\s*\(([^;]*);")
_KIND = re.compile(rb"([A-Za-z_]\w*)\s*\(")
_SURFACES = frozenset(("ADVANCED_FACE", "FACE_SURFACE"))


class Exchange(Struct, frozen=True):
    """kinds: how many records of each kind there are. products: occurrences without a name of
    their own, by their identifiers -> the names of their products. documents: the other files that
    the file names. has_unit: it states a unit of length. is_curved: it has curved surfaces. unread:
    words about what OpenCascade loses."""

    kinds: Mapping[str, int]
    products: Mapping[str, str]
    documents: tuple[str, ...]
    has_unit: bool
    is_curved: bool
    unread: tuple[str, ...]

    @property
    def faces(self) -> int:
        return self.kinds.get("ADVANCED_FACE", 0) + self.kinds.get("FACE_SURFACE", 0)


def read_exchange(data: bytes) -> Exchange:
    """Raises SatcheckError for a file that is cut off, that names records which it lacks or has
    twice, that has values, units or placements which are none, or kinds that are misspelt."""
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
    kinds, unread = _kinds(bare)
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
        has_unit=not _references(_UNITS, bare).isdisjoint(_LENGTH.findall(bare)),
        is_curved=_CURVED.search(bare) is not None,
        unread=(*unread, *_unplaced(bare, kinds)),
    )


def _refuse_values(bare: bytes) -> None:
    """OpenCascade reads numbers that are none, and unknown units, as something else."""
    if (wrong := _NO_VALUE.search(bare)) is not None:
        message = f"{wrong[1].decode('ascii', 'replace')!r} is no value of a record"
        raise Refused("bad-record", message)
    if (wrong := _NO_POINT.search(bare) or _NO_PLACE.search(bare)) is not None:
        what = wrong[0].decode("ascii", "replace")
        raise Refused("bad-record", f"{what[:60]} is no place: a value is missing or no number")
    for prefix, unit in _SI_UNIT.findall(bare):
        if not (_PREFIX.fullmatch(prefix) and _UNIT.fullmatch(unit)):
            named = f"{prefix.decode()} {unit.decode()}".strip()
            raise Refused("bad-record", f"SI_UNIT: {named} is no unit")


def _kinds(bare: bytes) -> tuple[Counter[str], list[str]]:
    """The kinds of records of a text without comments and texts, and words about those in lists
    that nobody knows."""
    kinds: Counter[str] = Counter()
    defined: set[bytes] = set()
    listed: list[tuple[str, Names, set[bytes], set[str]]] = [
        (what, names, _references(regex, bare), set()) for what, names, regex in _LISTS
    ]
    for match in _RECORD.finditer(bare):
        id_, kind = match[1], (match[2] or b"").decode("ascii").upper()
        if id_ in defined:
            raise Refused("bad-record", f"the file has two records {id_.decode()}")
        defined.add(id_)
        kinds[kind] += 1
        for _, _, wanted, found in listed:
            if id_ in wanted:
                found.add(kind)
    missing = {match[0] for match in _REFERENCE.finditer(bare)} - defined
    if missing:
        first = min(missing, key=lambda name: (len(name), name)).decode()
        message = f"the file names {len(missing)} records that it lacks, such as {first}"
        raise Refused("index-out-of-range", message)
    unread = [
        message for what, names, _, found in listed for message in names.unread(sorted(found), what)
    ]
    return kinds, unread


def _references(lists: re.Pattern[bytes], bare: bytes) -> set[bytes]:
    """Return the records that lists name."""
    return {id_ for inside in lists.findall(bare) for id_ in _REFERENCE.findall(inside)}


def _unplaced(bare: bytes, kinds: Mapping[str, int]) -> Iterator[str]:
    """Yield words about occurrences that OpenCascade leaves out."""
    for kind in _UNREAD_USES:
        if kind in kinds:
            yield f"occurrences of the kind {kind} are not read"
    if "MAPPED_ITEM" in kinds:  # they place occurrences too
        return
    shapes = dict(_SHAPE_OF.findall(bare))
    placed = {shapes.get(shape) for shape in _PLACED.findall(bare)}
    if lost := [use for use in _USE.findall(bare) if use not in placed]:
        named = lost[0].decode()
        yield f"{len(lost)} occurrences without a placement are not read, such as {named}"


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
