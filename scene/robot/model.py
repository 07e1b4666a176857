"""A robot as its URDF describes it: links with geometry, and joints that move links.

Lengths in metres, angles in radians, as URDF prescribes. A pose is a rigid row-major 4x4 for column
vectors. This module reads no files and stores no values of joints.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform

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
    """One <collision> of a link. origin: its pose in the link's frame. line: in the URDF; for
    refused geometry, the line of the wrong element."""

    name: str | None
    origin: Transform
    geometry: Geometry
    line: int


class Link(Struct, frozen=True):
    """A rigid body. visual: whether it has geometry for display."""

    name: str
    collisions: tuple[Collision, ...]
    visual: bool


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
    joint's frame. limits: None if there are none.
    """

    name: str
    kind: JointKind
    parent: str
    child: str
    origin: Transform
    axis: Vector
    limits: Limits | None
    mimic: Mimic | None

    @property
    def freedoms(self) -> int:
        """How many numbers its value has."""
        return {"fixed": 0, "planar": 3, "floating": 6}.get(self.kind, 1)

    @property
    def free(self) -> bool:
        """Whether a pose sets its value: it moves and mimics no other joint."""
        return self.freedoms > 0 and self.mimic is None


class Robot(Struct, frozen=True):
    """A tree of links, checked.

    file: the URDF's path as given. joints: each after the joint of its parent link.
    """

    name: str
    file: str
    root: str
    links: dict[str, Link]
    joints: tuple[Joint, ...]

    def joint(self, name: str) -> Joint | None:
        return next((joint for joint in self.joints if joint.name == name), None)
