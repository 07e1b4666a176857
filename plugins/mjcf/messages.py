"""What the child process that runs MuJoCo answers.

Poses are (x, y, z) and a unit quaternion (w, x, y, z), as in MuJoCo. Lengths in metres, angles in
radians. Bodies, geoms and joints are numbered as in the compiled model; body 0 is the world.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Primitive
from satcheck.scene.loading.raw_mesh import Refusal

Quaternion = tuple[float, float, float, float]


class Place(Struct, frozen=True):
    at: Vector
    turn: Quaternion


class Body(Struct, frozen=True):
    """place: in the frame of the parent, at qpos0. weld: the first of the bodies that no joint
    moves against this one; 0: the world. static: no joint moves it; a mocap body is static."""

    name: str
    parent: int
    weld: int
    static: bool
    place: Place


class FileMesh(Struct, frozen=True, tag=True):
    """A mesh in a file that satcheck reads. A vertex v of the file is at scale * R(v - place.at),
    R being the inverse of place.turn.

    file: relative to the folder of the model file.
    """

    file: str
    scale: Vector
    place: Place


class OwnMesh(Struct, frozen=True, tag=True):
    """A mesh that only MuJoCo reads: a part of the model file."""

    part: str


class Geom(Struct, frozen=True):
    """place: of the shape, or of the coordinates of the mesh, in the frame of the body. line: of
    the XML file; 0: unknown."""

    name: str
    body: int
    place: Place
    contype: int
    conaffinity: int
    line: int
    shape: Primitive | FileMesh | OwnMesh | Refusal


class Joint(Struct, frozen=True):
    """at, axis: in the frame of the body. limits: None if it has none. first: the number of its
    first value in qpos. rest: its values in qpos0."""

    name: str
    kind: Literal["hinge", "slide", "ball", "free"]
    body: int
    at: Vector
    axis: Vector
    limits: tuple[float, float] | None
    first: int
    rest: tuple[float, ...]


class Key(Struct, frozen=True):
    """A named keyframe. mpos, mquat: of the mocap bodies; (): as in the file."""

    name: str
    qpos: tuple[float, ...]
    mpos: tuple[float, ...] = ()
    mquat: tuple[float, ...] = ()


class Flex(Struct, frozen=True):
    """A deformable body."""

    name: str
    contype: int
    conaffinity: int


class Model(Struct, frozen=True, tag=True):
    """excludes: pairs of bodies. pairs: of geoms that are checked in any case. parents_pass: a body
    is not checked against its parent. notes: (code, message)."""

    name: str
    bodies: tuple[Body, ...]
    geoms: tuple[Geom, ...]
    joints: tuple[Joint, ...]
    flexes: tuple[Flex, ...]
    excludes: tuple[tuple[int, int], ...]
    pairs: tuple[tuple[int, int], ...]
    keys: tuple[Key, ...]
    parents_pass: bool
    notes: tuple[tuple[str, str], ...]
