"""Makes a robot of a compiled MJCF file. Runs in a child process.

MuJoCo itself parses the file and refuses what is wrong. Geometry that satcheck does not check is an
unreadable body.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from msgspec.structs import replace

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Box, Capsule, Cylinder, Ellipsoid, HalfSpace, Primitive, Sphere
from satcheck.core.transform import compose
from satcheck.plugins.mjcf.compiling import Compiled, Key, numbers, part_name, pose_of
from satcheck.plugins.mjcf.exemptions import Exemptions, mask_of
from satcheck.plugins.mjcf.joints import joints_of, rest_poses, values_of
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import Refusal, UniqueNames
from satcheck.scene.issue import issue
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import (
    Collision,
    Geometry,
    Link,
    MeshReference,
    Robot,
    RobotDocument,
    State,
)

_GEOM = mujoco.mjtGeom
_FLEX = Refusal("unsupported-feature", "a deformable body (flex) is not read")


class Reading:
    """path: of the file. options: geometry: "collision": geoms whose contype or conaffinity is not
    0, or that a <pair> names; "visual": the others. Raises Refused if a number is not finite."""

    def __init__(self, read: Compiled, path: str, options: Mapping[str, Any]) -> None:
        m = self._model = read.model
        self._read = read
        self._path = path
        self._geometry = options["geometry"]
        is_solid = self._geometry == "collision"
        self._hulls = options["mesh_hulls"] and is_solid
        self._bodies = self._names("body", m.nbody)
        self._geoms = self._names("geom", m.ngeom)
        self._joints = self._names("joint", m.njnt)
        self._masks = list(map(mask_of, m.geom_contype.tolist(), m.geom_conaffinity.tolist()))
        paired = {*m.pair_geom1.tolist(), *m.pair_geom2.tolist()}
        self._checked = [
            k for k, mask in enumerate(self._masks) if (mask.collides or k in paired) == is_solid
        ]
        flexes = map(mask_of, m.flex_contype.tolist(), m.flex_conaffinity.tolist())
        named = zip(self._names("flex", m.nflex), flexes, strict=True)
        self._flexes = [(name, mask) for name, mask in named if mask.collides or not is_solid]
        solid = [*(self._masks[k] for k in self._checked), *(mask for _, mask in self._flexes)]
        masks = solid if is_solid else []
        self._exemptions = Exemptions(m, self._bodies, self._geoms, masks)

    def _names(self, kind: str, count: int) -> list[str]:
        """As in MuJoCo, with the number for a name that is missing."""
        names, of_kind = UniqueNames(), getattr(mujoco.mjtObj, f"mjOBJ_{kind.upper()}")
        given = [mujoco.mj_id2name(self._model, of_kind, k) for k in range(count)]
        return [names.unique(name or f"{kind}{k}") for k, name in enumerate(given)]

    def document(self) -> RobotDocument:
        issues = (issue(code, message, file=self._path) for code, message in self._notes())
        return RobotDocument(robot=self._robot(), issues=tuple(issues))

    def _robot(self) -> Robot:
        m = self._model
        places = [pose_of(m.body_pos[k], m.body_quat[k]) for k in range(m.nbody)]
        joints, between = joints_of(m, self._bodies, self._joints, places)
        groups = {name: self._exemptions.groups(None, mask) for name, mask in self._flexes}
        flexes = [
            Link(f"flex {name}", (Collision(None, IDENTITY, _FLEX, 0, groups=of),), unused=False)
            for name, of in groups.items()
        ]
        links = [*self._links(rest_poses(m, places)), *between, *flexes]
        states = tuple(
            State("", key.name, dict(values_of(key, m, self._joints)), self._path, {})
            for key in self._read.keys
            if self._no_state(key) is None
        )
        return Robot(
            name=self._read.name or Path(self._path).stem,
            file=self._path,
            roots={link.name: IDENTITY for link in (links[0], *flexes)},
            links={link.name: link for link in links},
            joints=tuple(joints),
            exempt=tuple(self._exemptions.exempt()),
            states=states,
        )

    def _links(self, rest: list[Any]) -> Iterator[Link]:
        m = self._model
        of_body: dict[int, list[Collision]] = {}
        for k in self._checked:
            of_body.setdefault(int(m.geom_bodyid[k]), []).append(self._collision(k))
        checked = set(self._checked)
        others = {body for k, body in enumerate(m.geom_bodyid.tolist()) if k not in checked}
        for number, name in enumerate(self._bodies):
            yield Link(
                name=name,
                collisions=tuple(of_body.get(number, ())),
                unused=number in others,
                static=bool(m.body_treeid[number] < 0),
                rest=rest[number],
            )

    def _collision(self, k: int) -> Collision:
        m = self._model
        origin, shape = pose_of(m.geom_pos[k], m.geom_quat[k]), self._shape(k)
        if isinstance(shape, MeshReference) and shape.part is None:
            # MuJoCo has moved its coordinates by their centre, and turned them.
            mesh = m.geom_dataid[k]
            moved = pose_of(m.mesh_pos[mesh], m.mesh_quat[mesh])
            origin = origin if moved == IDENTITY else compose(origin, inverse(moved))
        return Collision(
            name=self._geoms[k],
            origin=origin,
            geometry=shape,
            line=self._read.lines.get(k, 0),
            groups=self._exemptions.groups(int(m.geom_bodyid[k]), self._masks[k], k),
        )

    def _shape(self, k: int) -> Geometry:
        m, read = self._model, self._read
        if k in read.of_geom:
            return read.of_geom[k]
        kind = m.geom_type[k]
        if kind == _GEOM.mjGEOM_PLANE:
            return HalfSpace()
        if kind != _GEOM.mjGEOM_MESH:
            try:
                return _primitive(kind, numbers(m.geom_size[k]))
            except ValueError as error:
                return Refusal("bad-robot", str(error))
        mesh = m.geom_dataid[k]
        name = m.mesh(mesh).name
        if name in read.file_meshes:
            file = read.file_meshes[name]
            if 0.0 in file.scale:
                return Refusal("singular-transform", "scale 0 flattens the mesh")
            return replace(file, hull=self._hulls)
        if name in read.refused:
            return read.refused[name]
        own = Path(self._path).name
        return MeshReference(own, (1.0, 1.0, 1.0), part=part_name(m, mesh), hull=self._hulls)

    def _notes(self) -> Iterator[tuple[str, str]]:
        shapes = map(self._shape, self._checked)
        if self._geometry == "collision" and any(isinstance(s, MeshReference) for s in shapes):
            taken = "the convex hulls of meshes are checked, as in MuJoCo, not their triangles"
            own = "the triangles of meshes are checked; MuJoCo uses their convex hulls"
            yield "mesh-or-hull", taken if self._hulls else f"{own} (--read mesh-hulls=true)"
        unsolved = "not solved: joints stand where the pose says"
        if count := self._read.constraints:
            what = "constraint is" if count == 1 else "constraints are"
            yield "constraint-not-solved", f"{count} equality {what} {unsolved}"
        if self._has_spring():
            yield "constraint-not-solved", f"springs that rest elsewhere are {unsolved}"
        reasons = {key.name: self._no_state(key) for key in self._read.keys}
        for reason in dict.fromkeys(filter(None, reasons.values())):
            names = ", ".join(name for name, each in reasons.items() if each == reason)
            yield "keyframe-not-read", f"keyframes are no states, because {reason}: {names}"

    def _has_spring(self) -> bool:
        """Whether a spring of a joint or tendon pulls bodies out of qpos0."""
        m = self._model
        starts = m.jnt_qposadr[(m.jnt_stiffness > 0) & (m.jnt_type >= 2)]  # of slides and hinges
        bent = m.qpos_spring[starts] != m.qpos0[starts]
        low, high = m.tendon_lengthspring.T
        slack = (m.tendon_length0 < low) | (m.tendon_length0 > high)
        return bool(bent.any() or slack[m.tendon_stiffness > 0].any())

    def _no_state(self, key: Key) -> str | None:
        """Why a keyframe is no state; None: it is one."""
        m = self._model
        if self._read.aligned:
            return "alignfree moves the frames of their values"
        if len(key.qpos) not in (0, m.nq) or not all(map(math.isfinite, key.qpos)):
            return "a joint has no value"
        bodies = [int(np.flatnonzero(m.body_mocapid == k)[0]) for k in range(m.nmocap)]
        stored = ((key.mpos, m.body_pos[bodies]), (key.mquat, m.body_quat[bodies]))
        moves = any(given and list(given) != own.ravel().tolist() for given, own in stored)
        return "they place mocap bodies" if moves else None


def _primitive(kind: int, size: Vector) -> Primitive:
    """MuJoCo states half sizes."""
    a, b, c = size
    match kind:
        case _GEOM.mjGEOM_SPHERE:
            return Sphere(a)
        case _GEOM.mjGEOM_CAPSULE:
            return Capsule(a, 2 * b) if b > 0 else Sphere(a)
        case _GEOM.mjGEOM_CYLINDER:
            return Cylinder(a, 2 * b)
        case _GEOM.mjGEOM_ELLIPSOID:
            return Ellipsoid((a, b, c))
        case _GEOM.mjGEOM_BOX:
            return Box((2 * a, 2 * b, 2 * c))
    raise ValueError(f"a geom of type {kind} is not read")
