"""A robot as its URDF, SDFormat or MJCF file describes it: links with geometry, and joints that
move links.

Lengths in metres, angles in radians, as these formats prescribe. A pose is a rigid row-major 4x4
for column vectors. This module reads no files and stores no values of joints.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations_with_replacement
from typing import Literal, NamedTuple

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import Document, RawRule, Refusal

JointKind = Literal[
    "revolute", "continuous", "prismatic", "fixed", "floating", "planar", "ball", "free"
]
# The value of a joint: no number for a fixed joint, (x, y, angle) for a planar one, (x, y, z, roll,
# pitch, yaw) for a floating one, a quaternion (w, x, y, z) for a ball joint, (x, y, z, w, x, y, z)
# for a free one, an angle or a length for others.
Values = tuple[float, ...]
FREEDOMS: dict[JointKind, int] = {"fixed": 0, "planar": 3, "floating": 6, "ball": 4, "free": 7}


class MeshReference(Struct, frozen=True, tag=True):
    """A mesh file by its URI as written. scale: factors of x, y, z; negative ones mirror.

    start: a rigid pose that is applied before the scale. part: of the file; None: all of it. hull:
    its convex hull is meant.
    """

    uri: str
    scale: Vector
    start: Transform = IDENTITY
    part: str | None = None
    hull: bool = False


Geometry = MeshReference | Primitive | Refusal


class Collision(Struct, frozen=True):
    """One <collision> of a link, or one <visual> if these are checked.

    origin: its pose in the link's frame. line: in the file that states it; for refused geometry,
    the line of the wrong element. file: its path; "": that of the robot. groups: see `RawRule`.
    """

    name: str | None
    origin: Transform
    geometry: Geometry
    line: int
    file: str = ""
    groups: tuple[str, ...] = ()


class Link(Struct, frozen=True):
    """A rigid body.

    unused: whether it has geometry of the kind that is not checked. static: nothing moves it. rest:
    its pose in the world while all joints above it stand at 0, if the file states it; None: it
    follows from the joints.
    """

    name: str
    collisions: tuple[Collision, ...]
    unused: bool
    static: bool = False
    rest: Transform | None = None


class Limits(Struct, frozen=True):
    """The range of a joint: radians, or metres for a prismatic joint; lower <= upper."""

    lower: float
    upper: float


class Mimic(Struct, frozen=True):
    """Value = multiplier * value of `joint` + offset."""

    joint: str
    multiplier: float
    offset: float


class Joint(Struct, frozen=True):
    """Moves the link `child` relative to the link `parent`.

    origin: the pose of the joint's frame in the frame of the parent. axis: unit vector in the
    joint's frame; of a prismatic joint its length is that of a metre in the unit of the poses.
    limits: None if there are none. child_origin: the pose of the child in the joint's frame.
    stands_at_zero: without a value it stands at 0, or at `reference`, even if that is beyond its
    limits, because the file states the pose of the child there. reference: the value at which it
    does not move the child; (): 0. The value of a free joint is a pose in the world.
    """

    name: str
    kind: JointKind
    parent: str
    child: str
    origin: Transform
    axis: Vector = (1.0, 0.0, 0.0)
    limits: Limits | None = None
    mimic: Mimic | None = None
    child_origin: Transform = IDENTITY
    stands_at_zero: bool = False
    reference: Values = ()

    @property
    def freedoms(self) -> int:
        """Return how many numbers its value has."""
        return FREEDOMS.get(self.kind, 1)

    @property
    def neutral(self) -> Values:
        """The value at which it does not move the child."""
        return self.reference or (0.0,) * self.freedoms

    @property
    def free(self) -> bool:
        """Return whether a pose sets its value: it moves and mimics no other joint."""
        return self.freedoms > 0 and self.mimic is None


class Mask(NamedTuple):
    """Two collisions are checked if the bits of one and those that the other meets share one.
    name: of the group of the collisions with this mask."""

    bits: int
    meets: int
    name: str

    @property
    def collides(self) -> bool:
        return bool(self.bits or self.meets)


def told_apart(masks: Iterable[Mask], format_name: str) -> tuple[set[str], list[RawRule]]:
    """(the groups of masks that have to be told apart, the exemptions of those that share no
    bit)."""
    exempt = [
        RawRule(a.name, b.name, f"{format_name}: {a.name} and {b.name} share no bit", True)
        for a, b in combinations_with_replacement(sorted({*masks}), 2)
        if not (a.bits & b.meets or b.bits & a.meets)
    ]
    return {name for each in exempt for name in (each.a, each.b)}, exempt


class State(Struct, frozen=True):
    """A name for values of some joints: a <group_state> of an SRDF, or a keyframe of MJCF. file:
    path as given. lines: joint -> line in the file; none of a keyframe."""

    group: str
    name: str
    joints: dict[str, Values]
    file: str
    lines: dict[str, int]


class Robot(Struct, frozen=True):
    """Trees of links, checked. The links of an SDFormat or MJCF file are one robot.

    file: its path as given. roots: links that no joint carries -> their pose in the world. joints:
    each after the joint of its parent link. exempt: pairs that the format does not check, of which
    a later one counts more; None: the format says nothing about them. states: those that the file
    itself names.
    """

    name: str
    file: str
    roots: dict[str, Transform]
    links: dict[str, Link]
    joints: tuple[Joint, ...]
    exempt: tuple[RawRule, ...] | None = None
    states: tuple[State, ...] = ()


class RobotDocument(Document, frozen=True, kw_only=True):
    """A robot and issues, as its reader returns them, also from a child process. Its items follow
    from the links (`assembly.document_of_robot`)."""

    has_own_groups = True
    robot: Robot
