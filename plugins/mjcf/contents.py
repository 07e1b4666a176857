"""What a compiled MJCF file contains, as messages. Runs in a child process."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

from satcheck.core.conventions import Vector
from satcheck.core.shapes import Box, Capsule, Cylinder, Ellipsoid, HalfSpace, Primitive, Sphere
from satcheck.plugins.mjcf.compiling import Compiled
from satcheck.plugins.mjcf.messages import (
    Body,
    FileMesh,
    Flex,
    Geom,
    Joint,
    Key,
    Model,
    OwnMesh,
    Place,
)
from satcheck.scene.errors import Refused
from satcheck.scene.loading.raw_mesh import RawMesh, RawNode, RawPart, RawScene, Refusal
from satcheck.scene.plain_ids import COMPONENT_MARK, UniqueNames

_GEOM = mujoco.mjtGeom
_TYPES = {
    "body": mujoco.mjtObj.mjOBJ_BODY,
    "geom": mujoco.mjtObj.mjOBJ_GEOM,
    "joint": mujoco.mjtObj.mjOBJ_JOINT,
    "flex": mujoco.mjtObj.mjOBJ_FLEX,
}
_KINDS = {0: "free", 1: "ball", 2: "slide", 3: "hinge"}
_VALUES = {"free": 7, "ball": 4, "slide": 1, "hinge": 1}


def model_of(read: Compiled) -> Model:
    """Raises Refused if a number is not finite."""
    return _Contents(read).model()


class _Contents:
    def __init__(self, read: Compiled) -> None:
        self._read = read
        self._model = read.model
        self._names = {kind: UniqueNames() for kind in _TYPES}

    def model(self) -> Model:
        m, read = self._model, self._read
        return Model(
            name=read.name,
            bodies=tuple(self._body(k) for k in range(m.nbody)),
            geoms=tuple(self._geom(k) for k in range(m.ngeom)),
            joints=tuple(self._joint(k) for k in range(m.njnt)),
            flexes=tuple(
                Flex(self._name("flex", k), int(m.flex_contype[k]), int(m.flex_conaffinity[k]))
                for k in range(m.nflex)
            ),
            excludes=tuple((int(s) >> 16, int(s) & 0xFFFF) for s in m.exclude_signature),
            pairs=tuple(zip(m.pair_geom1.tolist(), m.pair_geom2.tolist(), strict=True)),
            keys=tuple(
                key
                for key in read.keys
                if self._is_read(key) and not self._moves_mocap(key) and not read.aligned
            ),
            parents_pass=not m.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_FILTERPARENT,
            notes=tuple(self._notes()),
        )

    def _name(self, kind: str, number: int) -> str:
        """As in MuJoCo, with the number for a name that is missing."""
        given = mujoco.mj_id2name(self._model, _TYPES[kind], number)
        return self._names[kind].unique(given or f"{kind}{number}")

    def _body(self, k: int) -> Body:
        m = self._model
        return Body(
            name=self._name("body", k),
            parent=int(m.body_parentid[k]),
            weld=int(m.body_weldid[k]),
            static=bool(m.body_treeid[k] < 0),
            place=_place(m.body_pos[k], m.body_quat[k]),
        )

    def _geom(self, k: int) -> Geom:
        m = self._model
        shape, place = self._shape(k)
        return Geom(
            name=self._name("geom", k),
            body=int(m.geom_bodyid[k]),
            place=place,
            contype=int(m.geom_contype[k]),
            conaffinity=int(m.geom_conaffinity[k]),
            line=self._read.lines.get(k, 0),
            shape=shape,
        )

    def _shape(self, k: int) -> tuple[Primitive | FileMesh | OwnMesh | Refusal, Place]:
        m, read = self._model, self._read
        place = _place(m.geom_pos[k], m.geom_quat[k])
        if k in read.of_geom:
            return read.of_geom[k], place
        kind = m.geom_type[k]
        if kind == _GEOM.mjGEOM_PLANE:
            return HalfSpace(), place
        if kind != _GEOM.mjGEOM_MESH:
            try:
                return _primitive(kind, _vector(m.geom_size[k])), place
            except ValueError as error:
                return Refusal("bad-robot", str(error)), place
        mesh = m.geom_dataid[k]
        name = m.mesh(mesh).name
        if name in read.file_meshes:
            if 0.0 in read.file_meshes[name].scale:
                return Refusal("singular-transform", "scale 0 flattens the mesh"), place
            return read.file_meshes[name], _uncentred(place, m.mesh_pos[mesh], m.mesh_quat[mesh])
        if name in read.refused:
            return read.refused[name], place
        return OwnMesh(_part_name(m, mesh)), place

    def _joint(self, k: int) -> Joint:
        m = self._model
        kind = _KINDS[int(m.jnt_type[k])]
        first = int(m.jnt_qposadr[k])
        low, high = _vector(m.jnt_range[k])
        return Joint(
            name=self._name("joint", k),
            kind=kind,  # type: ignore[arg-type]
            body=int(m.jnt_bodyid[k]),
            at=_vector(m.jnt_pos[k]),
            axis=_vector(m.jnt_axis[k]),
            limits=(low, high) if m.jnt_limited[k] and kind in ("hinge", "slide") else None,
            first=first,
            rest=_vector(m.qpos0[first : first + _VALUES[kind]]),
        )

    def _notes(self) -> Iterator[tuple[str, str]]:
        read = self._read
        if read.constraints:
            what = "constraint is" if read.constraints == 1 else "constraints are"
            yield (
                "constraint-not-solved",
                f"{read.constraints} equality {what} not solved: joints stand where the pose says",
            )
        if read.aligned and read.keys:
            why = "alignfree moves the frames of their values"
            yield "keyframe-not-read", f"keyframes are no states, because {why}"
        wrong = [key.name for key in read.keys if not self._is_read(key)]
        if wrong:
            names = ", ".join(wrong)
            yield "keyframe-not-read", f"keyframes without a value for each joint: {names}"

        moving = [key.name for key in read.keys if self._moves_mocap(key)]
        if moving:
            names = ", ".join(moving)
            yield "keyframe-not-read", f"keyframes that place mocap bodies are no states: {names}"

    def _moves_mocap(self, key: Key) -> bool:
        """Whether it places mocap bodies elsewhere than the file does."""
        m = self._model
        bodies = [int(np.flatnonzero(m.body_mocapid == k)[0]) for k in range(m.nmocap)]
        stored = ((key.mpos, m.body_pos[bodies]), (key.mquat, m.body_quat[bodies]))
        return any(given and list(given) != own.ravel().tolist() for given, own in stored)

    def _is_read(self, key: Key) -> bool:
        """Not if it lacks values, or has values that are not numbers."""
        return len(key.qpos) in (0, self._model.nq) and all(map(math.isfinite, key.qpos))


def own_meshes_of(read: Compiled) -> RawScene:
    """Return the meshes that only MuJoCo reads, in the coordinates of the compiled model. Raises
    Refused."""
    m = read.model
    parts: list[RawPart] = []
    nodes: list[RawNode] = []
    for k in range(m.nmesh):
        name = m.mesh(k).name
        if name in read.refused or name in read.file_meshes:
            continue
        vertices = m.mesh_vert[m.mesh_vertadr[k] :][: m.mesh_vertnum[k]].astype("<f8")
        faces = m.mesh_face[m.mesh_faceadr[k] :][: m.mesh_facenum[k]].astype("<u4")
        mesh = RawMesh(vertices.tobytes(), faces.tobytes(), "float32", units="m")
        nodes.append(RawNode(_part_name(m, k), len(parts)))
        parts.append(RawPart(_part_name(m, k), mesh))
    if not parts:
        raise Refused("unknown-part", "it has no mesh of its own")
    return RawScene(tuple(parts), tuple(nodes))


def _part_name(model: Any, mesh: int) -> str:
    """Without the mark of components. Names of meshes are unique, and so are these."""
    name = model.mesh(mesh).name
    return f"mesh{mesh}" if COMPONENT_MARK in name else name


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


def _uncentred(place: Place, centre: Any, turn: Any) -> Place:
    """The place of the coordinates that MuJoCo has moved by the centre and turned."""
    if not centre.any() and turn.tolist() == [1, 0, 0, 0]:
        return place
    back = np.zeros(3), np.zeros(4)
    mujoco.mju_negPose(*back, centre, turn)
    at, quaternion = np.zeros(3), np.zeros(4)
    mujoco.mju_mulPose(at, quaternion, np.array(place.at), np.array(place.turn), *back)
    return _place(at, quaternion)


def _place(at: Any, turn: Any) -> Place:
    return Place(_vector(at), _vector(turn))


def _vector(values: Any) -> Any:
    vector = tuple(map(float, values))
    if not all(map(math.isfinite, vector)):
        raise Refused("non-finite", "a number of the file is not finite")
    return vector
