"""The keys of a scene file satcheck.scene/1, in TOML or JSON; docs/scenes.md explains them.

`satcheck schema scene` prints them as a JSON Schema, with these docstrings. A placement, by
position, rotation and scale or as a matrix, becomes one transform.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from contextlib import suppress
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Final, Literal

from msgspec import Meta, defstruct, field

from satcheck.core import transform
from satcheck.core.errors import SatcheckError
from satcheck.core.shapes import Box, Curved
from satcheck.core.transform import Transform, about_fixed_axes, cos_sin, quaternion_matrix
from satcheck.scene import motion
from satcheck.scene.files.readers import option_named, options
from satcheck.scene.planar.outline import Outline
from satcheck.scene.rules import SELECTED, Length, Selector
from satcheck.scene.statics import StaticsTerms
from satcheck.scene.table import Direction, Number, Table, Text, Texts, Wrong

SCENE_1: Final = "satcheck.scene/1"
# A matrix counts as singular if its determinant is smaller than this share of the product of its
# row lengths. Such a determinant may come from the rounding of the entries alone.
_SINGULAR = 2.0**-40
_UNTURNED: transform.Rotation = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
_ORIGIN = (0.0, 0.0, 0.0)
_HALF_TURN = 180.0

Vector = tuple[Number, Number, Number]
Row = tuple[Number, Number, Number, Number]
Quaternion = Annotated[Row, Meta(extra_json_schema={"not": {"items": {"const": 0}}})]
Factor = Annotated[Number, Meta(extra_json_schema={"not": {"const": 0}})]
# Three by their length: msgspec 0.22 crashes for a number with limits beside a tuple of three.
Factors = Annotated[tuple[Factor, ...], Meta(min_length=3, max_length=3)]
LastRow = Annotated[Row, Meta(extra_json_schema={"const": [0, 0, 0, 1]})]
Matrix = tuple[Row, Row, Row, LastRow]


class HalfSpace(Table, frozen=True, tag_field="type", tag="half-space"):
    """All points with z <= 0."""


Shape = Box | Curved | HalfSpace | Outline


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
    lengths = ("surface_tolerance",)
    excludes: ClassVar = {
        "shape": ("part", "units"),
        "quaternion": ("euler",),
        "matrix": ("position", "quaternion", "euler", "scale"),
    }

    id: Text
    mesh: Text | None = None
    part: Text | None = None
    units: Text | None = None
    shape: Shape | None = None
    position: Vector | None = None
    quaternion: Quaternion | None = None
    euler: Vector | None = None
    scale: Factor | Factors | None = None
    matrix: Matrix | None = None
    groups: Texts = ()
    static: bool = False
    pinned: bool = False
    surface_tolerance: Length | None = None

    def placement(self) -> Transform | None:
        """Scales first, then rotates, then translates; None if the body states none of it. Raises
        Wrong."""
        if self.matrix is not None:
            return affine(self.matrix, "matrix")
        if (self.position, self.quaternion, self.euler, self.scale) == (None,) * 4:
            return None
        turn = _UNTURNED
        if self.quaternion is not None:
            turn = quaternion_matrix(*_w_last(self.quaternion))
        elif self.euler is not None:
            turn = euler_matrix(self.euler)
        position = self.position or _ORIGIN
        if self.scale is None:
            return transform.placed(turn, position)
        scale = self.scale if isinstance(self.scale, tuple) else (self.scale,) * 3
        if 0.0 in scale:
            raise Wrong("a scale must not be 0", "scale", code="singular-transform")
        scaled = [entry * scale[k % 3] for k, entry in enumerate(turn)]
        return _regular(transform.placed(scaled, position), "scale")


def affine(rows: Matrix, key: str) -> Transform:
    """The matrix that a key states. Raises Wrong if it cannot place a body."""
    if rows[3] != (0.0, 0.0, 0.0, 1.0):
        raise Wrong("the last row should be 0 0 0 1", key, code="singular-transform")
    return _regular((*rows[0], *rows[1], *rows[2], *rows[3]), key)


def _regular(placement: Transform, key: str) -> Transform:
    """The same. Raises Wrong if it flattens space. key: that states it."""
    a, b, c, _, d, e, f, _, g, h, i, *_ = placement
    p, q, r = math.hypot(a, b, c), math.hypot(d, e, f), math.hypot(g, h, i)
    if 0.0 in (p, q, r):
        raise Wrong("singular transform: it scales by 0", key, code="singular-transform")
    a, b, c, d, e, f, g, h, i = a / p, b / p, c / p, d / q, e / q, f / q, g / r, h / r, i / r
    if abs(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)) < _SINGULAR:
        raise Wrong("singular transform: it flattens space", key, code="singular-transform")
    return placement


def _w_last(quaternion: Row) -> transform.Quaternion:
    """From the order of scene files. Raises Wrong."""
    w, x, y, z = quaternion
    if not any(quaternion):
        raise Wrong("a quaternion must not be zero", "quaternion")
    return x, y, z, w


def euler_matrix(degrees: Sequence[float]) -> transform.Rotation:
    """The rotation about the fixed axes x, then y, then z. Quarter turns are exact."""
    x, y, z = map(cos_sin, degrees)
    return about_fixed_axes(x, y, z)


def quaternion_of_euler(degrees: Sequence[float]) -> transform.Quaternion:
    """The same rotation as a unit quaternion (x, y, z, w)."""
    (cx, sx), (cy, sy), (cz, sz) = (cos_sin(angle / 2.0) for angle in degrees)
    return (
        sx * cy * cz - cx * sy * sz,
        cx * sy * cz + sx * cy * sz,
        cx * cy * sz - sx * sy * cz,
        cx * cy * cz + sx * sy * sz,
    )


# Rules have no tag: the key `bodies` tells what they are about.
AnyRule = Annotated[
    dict[str, Any],
    Meta(
        extra_json_schema={
            "if": {"required": ["bodies"]},
            "then": {"$ref": "#/$defs/BodyRuleKeys"},
            "else": {"$ref": "#/$defs/RuleKeys"},
        }
    ),
]


class Waypoint(Table, frozen=True):
    """How the body, as it is placed, is turned and then moved at this time.

    quaternion: [w, x, y, z], of any length but zero.
    euler: Degrees about the fixed axes x, then y, then z.
    """

    excludes: ClassVar = {"quaternion": ("euler",)}

    time: Annotated[float, Meta(ge=0, le=1)]
    position: Vector
    quaternion: Quaternion | None = None
    euler: Vector | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.quaternion is not None:
            _w_last(self.quaternion)

    def pose(self) -> motion.Waypoint:
        turn = motion.NO_TURN if self.euler is None else quaternion_of_euler(self.euler)
        if self.quaternion is not None:
            turn = _w_last(self.quaternion)
        return motion.Waypoint(self.time, self.position, turn)

    def turns_far(self, before: Waypoint) -> bool:
        """Whether an angle changes by more than half a turn: a body takes the shortest turn, which
        may differ from what the angles mean."""
        if before.quaternion is not None or self.quaternion is not None:
            return False
        angles = zip(before.euler or _ORIGIN, self.euler or _ORIGIN, strict=True)
        return any(abs(end - start) > _HALF_TURN for start, end in angles)


class Rotation(Table, frozen=True):
    """About a line, right-handed.

    axis: Its direction, of any length but zero.
    point: On it; left out: the origin.
    """

    axis: Direction
    degrees: Number
    point: Vector = (0.0, 0.0, 0.0)


class Choices(tuple[Selector, ...]):
    """Selectors: in the file one, or a list."""


_CHOICES = {"anyOf": [SELECTED, {"type": "array", "minItems": 1, "items": SELECTED}]}


class Motion(Table, frozen=True):
    """Bodies that move together, rigidly.

    clear: No body may be touched on the way that does not touch them as placed.
    """

    one_of = ("translation", "rotation", "path")

    bodies: Annotated[Choices, Meta(extra_json_schema=_CHOICES)]
    clear: bool = False
    translation: Vector | None = None
    rotation: Rotation | None = None
    path: Annotated[tuple[Waypoint, ...], Meta(min_length=2)] | None = None

    def way(self) -> motion.Path:
        """Raises Wrong and SatcheckError."""
        if self.translation is not None:
            return motion.Translation(self.translation)
        if (turn := self.rotation) is not None:
            return motion.Rotation(turn.point, turn.axis, turn.degrees)
        points = self.path or ()
        for k, (before, after) in enumerate(pairwise(points), 1):
            if after.turns_far(before):
                message = "more than half a turn from the pose before: give a pose between"
                raise Wrong(message, "path", k, "euler")
        return motion.PosePath(tuple(point.pose() for point in points))


def reading_table(names: Iterable[str] = ()) -> type[Table]:
    """Return the table of the options that readers declare, also those of other packages if one of
    these names needs them."""
    for name in names:
        with suppress(SatcheckError):  # the table says so, and what was meant
            option_named(name)
    known = {name: option for name, (option, _) in sorted(options().items())}
    about = "\n".join(
        f"    {name}: {option.help[0].upper()}{option.help[1:]}." for name, option in known.items()
    )
    table: type[Table] = defstruct(  # type: ignore[assignment]
        "Reading",
        [(name, option.type | None, None) for name, option in known.items()],
        bases=(Table,),
        module=__name__,
        namespace={"__doc__": f"{_OF_READING}\n\n{about}\n"},
        kw_only=True,
    )
    return table


_OF_READING = """How mesh files are read where their format leaves a choice. Options of the command
    line override it."""


class RulesFile(Table, frozen=True, kw_only=True):
    """A file of rules, without bodies."""

    rules: tuple[AnyRule, ...]
    schema: Literal["satcheck.scene/1"] | None = None
    editor: Text | None = field(default=None, name="$schema")
    name: Text | None = None
    description: Text | None = None
    units: Text | None = None
    statics: StaticsTerms | None = None
    accept: Texts = ()


class Scene(RulesFile, frozen=True, kw_only=True):
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

    bodies: tuple[Body, ...]
    rules: tuple[AnyRule, ...] = ()
    check_static: bool = False
    ignore_within_groups: Texts = ()
    motion: tuple[Motion, ...] = ()
    reading: dict[str, Any] | None = None
