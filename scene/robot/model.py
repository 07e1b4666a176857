"""A robot as its URDF describes it: links that carry geometry, joints that carry links.

Lengths in metres, angles in radians, as URDF prescribes. A pose is a rigid row-major 4x4 for column
vectors. Nothing here knows files or values of joints.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform

JointKind = Literal["revolute", "continuous", "prismatic", "fixed", "floating", "planar"]


class MeshReference(Struct, frozen=True):
    """A mesh file by its URI as written. scale: of its x, y, z; negative ones mirror."""

    uri: str
    scale: Vector


class RefusedShape(Struct, frozen=True):
    """Geometry that cannot be used, and why. code: of `issue.CODES`. reason: without the line, so
    that bodies that are refused for one reason are told together."""

    code: str
    reason: str


Geometry = MeshReference | Primitive | RefusedShape


class Collision(Struct, frozen=True):
    """One <collision> of a link. origin: its pose in the link's frame. line: in the URDF; of what
    cannot be used the element to blame."""

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
    """What a joint may do: radians, or metres of a prismatic one; lower <= upper."""

    lower: float
    upper: float


class Mimic(Struct, frozen=True):
    """Value = multiplier * value of `joint` + offset."""

    joint: str
    multiplier: float
    offset: float


class Joint(Struct, frozen=True):
    """Carries the link `child` in the frame of the link `parent`.

    origin: the pose of the joint's frame in that of the parent. axis: unit vector in the joint's
    frame. limits: None for kinds that have none.
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
        """Whether a pose gives its value."""
        return self.freedoms > 0 and self.mimic is None


class Robot(Struct, frozen=True):
    """A tree of links, checked.

    file: the URDF's path as given. joints: each after the one that carries its parent.
    """

    name: str
    file: str
    root: str
    links: dict[str, Link]
    joints: tuple[Joint, ...]

    def joint(self, name: str) -> Joint | None:
        return next((joint for joint in self.joints if joint.name == name), None)
