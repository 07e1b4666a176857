"""A robot as its URDF or SDFormat file describes it: links with geometry, and joints that move
links.

Lengths in metres, angles in radians, as both formats prescribe. A pose is a rigid row-major 4x4 for
column vectors. This module reads no files and stores no values of joints.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.read_options import GeometryKind

JointKind = Literal["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]


class MeshReference(Struct, frozen=True):
    """A mesh file by its URI as written. scale: factors of x, y, z; negative ones mirror."""

    uri: str
    scale: Vector


class RefusedShape(Struct, frozen=True):
    """Geometry that cannot be used. code: of `issue.CODES`. reason: without the line, so that one
    message can cover all bodies with this reason."""

    code: str
    reason: str


Geometry = MeshReference | Primitive | RefusedShape


class Collision(Struct, frozen=True):
    """One <collision> of a link, or one <visual> if these are checked.

    origin: its pose in the link's frame. line: in the file that states it; for refused geometry,
    the line of the wrong element. file: its path; "": that of the robot. groups: see `Exemption`.
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
    joint's frame. limits: None if there are none. child_origin: the pose of the child in the
    joint's frame. stands_at_zero: without a value it stands at 0, even if 0 is beyond its limits,
    because the file states the pose of the child there.
    """

    name: str
    kind: JointKind
    parent: str
    child: str
    origin: Transform
    axis: Vector
    limits: Limits | None
    mimic: Mimic | None
    child_origin: Transform = IDENTITY
    stands_at_zero: bool = False

    @property
    def freedoms(self) -> int:
        """How many numbers its value has."""
        return {"fixed": 0, "planar": 3, "floating": 6}.get(self.kind, 1)

    @property
    def free(self) -> bool:
        """Whether a pose sets its value: it moves and mimics no other joint."""
        return self.freedoms > 0 and self.mimic is None


class Exemption(Struct, frozen=True):
    """Bodies that need no check against each other, as the format says. a, b: two links, or two
    groups of collisions, which may be the same."""

    a: str
    b: str
    reason: str


class Exempt(Struct, frozen=True):
    """The exemptions of a robot: pairs of links, and pairs of groups of collisions."""

    links: tuple[Exemption, ...] = ()
    groups: tuple[Exemption, ...] = ()


class Robot(Struct, frozen=True):
    """Trees of links, checked. The links of an SDFormat file are one robot.

    file: its path as given. roots: links that no joint carries -> their pose in the world. joints:
    each after the joint of its parent link. exempt: pairs that the format does not check; None: the
    format says nothing about them. geometry: the elements of links that are checked.
    """

    name: str
    file: str
    roots: dict[str, Transform]
    links: dict[str, Link]
    joints: tuple[Joint, ...]
    exempt: Exempt | None = None
    geometry: GeometryKind = "collision"

    def joint(self, name: str) -> Joint | None:
        return next((joint for joint in self.joints if joint.name == name), None)
