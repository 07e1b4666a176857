"""The keys of a scene file satcheck.scene/1, in TOML or JSON; docs/scenes.md explains them.

`satcheck schema scene` prints them as a JSON Schema, with these docstrings.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from msgspec import UNSET, Meta, UnsetType, defstruct, field

from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, Ellipsoid, Sphere
from satcheck.scene.files.readers import option_named, options
from satcheck.scene.planar.outline import Outline
from satcheck.scene.rules import Severity
from satcheck.scene.scene_file.form import LARGEST, Table
from satcheck.scene.units import LENGTH_PATTERN

SCENE_1 = "satcheck.scene/1"
RULES_FILE_KEYS = (
    "schema",
    "$schema",
    "name",
    "description",
    "units",
    "rules",
    "statics",
    "accept",
)


Flag = bool | UnsetType
Text = Annotated[str, Meta(min_length=1)]
Number = Annotated[float, Meta(ge=-LARGEST, le=LARGEST)]
NotNegative = Annotated[float, Meta(ge=0, le=LARGEST)]
Positive = Annotated[float, Meta(gt=0, le=LARGEST)]
Texts = tuple[Text, ...]
Vector = tuple[Number, Number, Number]
Row = tuple[Number, Number, Number, Number]
_NOT_ZERO = Meta(extra_json_schema={"not": {"items": {"const": 0}}})
Direction = Annotated[Vector, _NOT_ZERO]
Quaternion = Annotated[Row, _NOT_ZERO]
Factor = Annotated[Number, Meta(extra_json_schema={"not": {"const": 0}})]
# Three by their length: msgspec 0.22 crashes for a number with limits beside a tuple of three.
Factors = Annotated[tuple[Factor, ...], Meta(min_length=3, max_length=3)]
LastRow = Annotated[Row, Meta(extra_json_schema={"const": [0, 0, 0, 1]})]
Matrix = tuple[Row, Row, Row, LastRow]
LengthText = Annotated[str, Meta(extra_json_schema={"pattern": LENGTH_PATTERN})]
Length = NotNegative | LengthText
Selector = Annotated[str, Meta(extra_json_schema={"minLength": 1, "not": {"const": "group:"}})]


class HalfSpace(Table, frozen=True, tag_field="type", tag="half-space"):
    """All points with z <= 0."""


Shape = Box | Sphere | Capsule | Cylinder | Cone | Ellipsoid | HalfSpace | Outline


class Body(Table, frozen=True):
    """A mesh file or a shape, scaled first, then turned, then moved.

    id: Unique in the file.
    mesh: A mesh file, its path from the scene file on.
    part: The path of a node in the mesh file, where the file places it; left out: all of the file.
    units: Of the mesh, in the place of what its file states: um, mm, cm, m, in or ft.
    shape: Centred at its origin, axis along z; the apex of a cone is at +z.
    quaternion: [w, x, y, z], of any length but zero.
    euler: Degrees about the fixed axes x, then y, then z.
    matrix: Four rows of four numbers, world = matrix * (x, y, z, 1), affine and not singular.
    static: Part of the surroundings: see check_static.
    pinned: Not to be moved when a scene is pulled apart.
    surface_tolerance: How far its surface may be off. In the units of the scene, or with a unit:
        "2mm".
    """

    one_of = ("mesh", "shape")
    excludes: ClassVar = {
        "shape": ("part", "units"),
        "quaternion": ("euler",),
        "matrix": ("position", "quaternion", "euler", "scale"),
    }

    id: Text
    mesh: Text | UnsetType = UNSET
    part: Text | UnsetType = UNSET
    units: Text | UnsetType = UNSET
    shape: Shape | UnsetType = UNSET
    position: Vector | UnsetType = UNSET
    quaternion: Quaternion | UnsetType = UNSET
    euler: Vector | UnsetType = UNSET
    scale: Factor | Factors | UnsetType = UNSET
    matrix: Matrix | UnsetType = UNSET
    groups: Texts = ()
    static: bool = False
    pinned: bool = False
    surface_tolerance: Length | UnsetType = UNSET


class Rule(Table, frozen=True):
    """What is asked of the pairs with one body in a and the other in b. A selector is a glob of
    ids, or of groups after "group:"; an id or group that is exactly the text comes first.

    allowed: They may overlap; nothing is computed. Needs a reason, and no other key.
    max_depth: An overlap no deeper than this is within budget.
    max_thickness: So is one without a ball in both bodies thicker than this.
    max_volume: So is one that shares no more than this.
    clearance: The gap that they must keep.
    tolerance: Half the width of the touch band.
    reason: Why, in words.
    """

    a: Selector
    b: Selector
    allowed: Flag = UNSET
    max_depth: Length | UnsetType = UNSET
    max_thickness: Length | UnsetType = UNSET
    max_volume: NotNegative | UnsetType = UNSET
    clearance: Length | UnsetType = UNSET
    tolerance: Length | UnsetType = UNSET
    severity: Severity | UnsetType = UNSET
    reason: Text | UnsetType = UNSET


class BodyRule(Table, frozen=True):
    """What is asked of single bodies, and stated about them.

    supported: Contacts within the tolerance must be able to carry them.
    stable: So must their nearest contacts alone.
    mounted: They hold like static bodies and need not stand.
    inside: The id of the body in which they must lie.
    region: They bound space and have no material: they collide with nothing and hold nothing.
    mass: Of each of them; overrides the density.
    friction: Of two bodies the smaller one counts.
    reason: Why, in words.
    """

    bodies: Selector
    supported: Flag = UNSET
    stable: Flag = UNSET
    mounted: Flag = UNSET
    inside: Text | UnsetType = UNSET
    region: Flag = UNSET
    density: Positive | UnsetType = UNSET
    mass: Positive | UnsetType = UNSET
    friction: NotNegative | UnsetType = UNSET
    severity: Severity | UnsetType = UNSET
    reason: Text | UnsetType = UNSET


# Rules have no tag: the key `bodies` tells what they are about.
AnyRule = Annotated[
    dict[str, Any],
    Meta(
        extra_json_schema={
            "if": {"required": ["bodies"]},
            "then": {"$ref": "#/$defs/BodyRule"},
            "else": {"$ref": "#/$defs/Rule"},
        }
    ),
]


class Statics(Table, frozen=True):
    """What rules about the support of bodies assume.

    gravity: The direction in which things fall; its length does not count.
    friction: The Coulomb coefficient of all contacts.
    tolerance: A gap, or an overlap, up to this is a contact.
    """

    gravity: Direction | UnsetType = UNSET
    friction: NotNegative | UnsetType = UNSET
    tolerance: Length | UnsetType = UNSET


class Waypoint(Table, frozen=True):
    """How the body, as it is placed, is turned and then moved at this time.

    quaternion: [w, x, y, z], of any length but zero.
    euler: Degrees about the fixed axes x, then y, then z.
    """

    excludes: ClassVar = {"quaternion": ("euler",)}

    time: Annotated[float, Meta(ge=0, le=1)]
    position: Vector
    quaternion: Quaternion | UnsetType = UNSET
    euler: Vector | UnsetType = UNSET


class Rotation(Table, frozen=True):
    """About a line, right-handed.

    axis: Its direction, of any length but zero.
    point: On it; left out: the origin.
    """

    axis: Direction
    degrees: Number
    point: Vector = (0.0, 0.0, 0.0)


class Motion(Table, frozen=True):
    """Bodies that move together, rigidly.

    clear: No body may be touched on the way that does not touch them as placed.
    """

    one_of = ("translation", "rotation", "path")

    bodies: Selector | Annotated[tuple[Selector, ...], Meta(min_length=1)]
    clear: bool = False
    translation: Vector | UnsetType = UNSET
    rotation: Rotation | UnsetType = UNSET
    path: Annotated[tuple[Waypoint, ...], Meta(min_length=2)] | UnsetType = UNSET


def reading_table() -> type[Table]:
    """Return the table of the options that readers declare."""
    known = {name: option for name, (option, _) in sorted(options().items())}
    about = "\n".join(
        f"    {name}: {option.help[0].upper()}{option.help[1:]}." for name, option in known.items()
    )
    table: Any = defstruct(
        "Reading",
        [(name, option.type | UnsetType, UNSET) for name, option in known.items()],
        bases=(Table,),
        module=__name__,
        namespace={"__doc__": f"{_OF_READING}\n\n{about}\n"},
        kw_only=True,
    )
    made: type[Table] = table
    return made


def reading_table_for(names: Iterable[str]) -> type[Table]:
    """Return this table, also with the options of other packages if one of these names needs it."""
    unknown = [name for name in names if name not in Reading.__struct_fields__]
    if not unknown:
        return Reading
    for name in unknown:
        with suppress(SatcheckError):  # the table says so, and what was meant
            option_named(name)
    return reading_table()


_OF_READING = """How mesh files are read where their format leaves a choice. Options of the command
    line override it."""
if TYPE_CHECKING:
    Reading = Table
else:
    Reading = reading_table()


class Scene(Table, frozen=True):
    """A scene to check for collisions, written in TOML or JSON. World frame, right-handed; lengths
    in the units of the scene. Beyond this schema: ids are unique, the edges of an outline do not
    meet, a text as a length needs declared units that are known, a body is moved once and not when
    it is static, waypoints go from time 0 to time 1, and mesh files are there.

    $schema: For editors; not read.
    name: Left out: the name of the file.
    description: For people; not read.
    units: Of all lengths: um, mm, cm, m, in or ft. Mesh files of another unit are converted.
    check_static: Whether pairs of two static bodies are checked.
    ignore_within_groups: Two bodies of one of these groups are not checked against each other.
    rules: The last rule about a pair, or about a body, that sets a key decides that key.
    accept: Issues that may stay, each as CODE or CODE:NAME, as with --accept.
    """

    schema: Literal["satcheck.scene/1"]
    bodies: tuple[Body, ...]
    editor: Text | UnsetType = field(default=UNSET, name="$schema")
    name: Text | UnsetType = UNSET
    description: Text | UnsetType = UNSET
    units: Text | UnsetType = UNSET
    rules: tuple[AnyRule, ...] = ()
    statics: Statics | UnsetType = UNSET
    check_static: bool = False
    ignore_within_groups: Texts = ()
    accept: Texts = ()
    motion: tuple[Motion, ...] = ()
    reading: Reading | UnsetType = UNSET
