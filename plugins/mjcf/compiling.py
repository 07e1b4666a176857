"""Compiles an MJCF file with MuJoCo. Runs in a child process, because MuJoCo may end its process.

Images may be missing, and lengths of muscles need not be found. Nor does MuJoCo read meshes in
formats that satcheck reads: a box stands for each.
"""

from __future__ import annotations

import math
import os
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np

from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box
from satcheck.core.transform import Transform, placed, quaternion_matrix
from satcheck.plugins.mjcf.files import ModelFiles
from satcheck.scene.document import COMPONENT_MARK, Document, RawMesh, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import Instance, raw_scene
from satcheck.scene.files.readers import File
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import MeshReference
from satcheck.scene.robot.packages import FilePlaces

# Else MuJoCo writes its warnings into a file of the working directory.
mujoco.set_mju_user_warning(lambda _: None)
_GEOM = mujoco.mjtGeom
_READ_BY_SATCHECK = (".obj", ".stl")
# The centre and the axes of inertia are those of its coordinates: MuJoCo does not move it.
_BOX = mesh_of(Box((2.0, 4.0, 8.0)))
_NOT_READ = {
    _GEOM.mjGEOM_HFIELD: "a height field (hfield) is not read",
    _GEOM.mjGEOM_SDF: "a signed distance field of a plugin (sdf) is not read",
}


class Key(NamedTuple):
    """A named keyframe. mpos, mquat: of the mocap bodies; (): as in the file."""

    name: str
    qpos: tuple[float, ...]
    mpos: tuple[float, ...] = ()
    mquat: tuple[float, ...] = ()


class Compiled(NamedTuple):
    """file_meshes, refused: the meshes that satcheck reads, and those that nobody does, by name.
    of_geom: why a geom is not read, by its number. solved: what equality constraints connect."""

    model: Any
    name: str
    file_meshes: dict[str, MeshReference]
    refused: dict[str, Refusal]
    of_geom: dict[int, Refusal]
    lines: dict[int, int]
    keys: tuple[Key, ...]
    constraints: int
    aligned: bool


def compiled(file: File) -> Compiled:
    """Raises Refused."""
    path = file.path
    places = FilePlaces(path, file.packages, file.permitted)
    models = ModelFiles(path, places).models
    try:
        return _compiled(path, places, models)
    except (ValueError, mujoco.FatalError) as error:
        message = " ".join(str(error).removeprefix("Error: ").split())
        code = "missing-resource" if "Error opening file" in message else "bad-robot"
        raise Refused(code, f"MuJoCo refuses it: {message}", file=path) from None


def _compiled(path: str, places: FilePlaces, models: list[str]) -> Compiled:
    spec = mujoco.MjSpec.from_file(path)
    keys = [
        Key(key.name or f"key{k}", tuple(key.qpos), tuple(key.mpos), tuple(key.mquat))
        for k, key in enumerate(spec.keys)
    ]
    constraints = sum(bool(equality.active) for equality in spec.equalities)
    _relax(spec)
    _empty_textures(spec)
    refusals = _replace_geoms(spec)
    file_meshes, refused = _replace_meshes(spec, path, places, models)
    for number, geom in enumerate(spec.geoms):
        if geom.meshname in refused and geom.type != _GEOM.mjGEOM_MESH:
            refusals[number] = refused[geom.meshname]
    model = spec.compile()
    return Compiled(
        model,
        spec.modelname,
        file_meshes,
        refused,
        {geom.id: refusals[k] for k, geom in enumerate(spec.geoms) if k in refusals},
        {geom.id: _line(geom.info) for geom in spec.geoms},
        tuple(keys),
        constraints,
        bool(spec.compiler.alignfree) or any(joint.align == 1 for joint in spec.joints),
    )


def _relax(spec: Any) -> None:
    """Nothing is merged or left out, and nothing that places no geometry is refused: masses, sizes
    of memory, lengths of muscles, keyframes."""
    spec.memory = spec.nstack = spec.njmax = spec.nconmax = -1
    spec.compiler.fusestatic = False
    spec.compiler.discardvisual = False
    spec.compiler.balanceinertia = True
    spec.compiler.boundmass = spec.compiler.boundinertia = 1e-6

    spec.compiler.LRopt.mode = mujoco.mjtLRMode.mjLRMODE_NONE
    for key in spec.keys:
        for values in ("qpos", "qvel", "act", "ctrl", "mpos", "mquat"):
            setattr(key, values, [])
    for skin in list(spec.skins):
        spec.delete(skin)


def _empty_textures(spec: Any) -> None:
    """Images may be missing. (To delete an element takes long in a large model.)"""
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    for number, texture in enumerate(spec.textures):
        texture.name = texture.name or f"unnamed texture {number}"
        texture.file, texture.cubefiles = "", [""] * len(texture.cubefiles)
        texture.type = mujoco.mjtTexture.mjTEXTURE_2D
        texture.builtin = mujoco.mjtBuiltin.mjBUILTIN_FLAT
        texture.width = texture.height = 1
        texture.nchannel = 3


def _replace_geoms(spec: Any) -> dict[int, Refusal]:
    """Puts a sphere in the place of each geom that is not read. Number of the geom -> the reason"""
    refusals = {}
    for number, geom in enumerate(spec.geoms):
        if geom.type in _NOT_READ:
            refusals[number] = Refusal("unsupported-feature", _NOT_READ[geom.type])
            geom.type, geom.size = _GEOM.mjGEOM_SPHERE, (1, 1, 1)
            geom.meshname = geom.hfieldname = ""
    for field in list(spec.hfields):
        spec.delete(field)
    return refusals


def _replace_meshes(
    spec: Any, path: str, places: FilePlaces, models: list[str]
) -> tuple[dict[str, MeshReference], dict[str, Refusal]]:
    """Puts a box in the place of each mesh that MuJoCo need not read, or cannot."""
    # Shapes are fitted to these.
    fitted = {geom.meshname for geom in spec.geoms if geom.type != _GEOM.mjGEOM_MESH}
    files: dict[str, MeshReference] = {}
    refused: dict[str, Refusal] = {}
    for mesh in spec.meshes:
        if not mesh.file:
            continue
        uri, place = _place_of(mesh, path, places, models, stripped=bool(spec.strippath))
        if isinstance(place, Path) and not _has_faces(place):
            continue
        if Path(uri).suffix.lower() in _READ_BY_SATCHECK:  # who also reports what is wrong with it
            start = inverse(pose_of(mesh.refpos, mesh.refquat))
            files[mesh.name] = MeshReference(uri, numbers(mesh.scale), start)
            if mesh.name in fitted and isinstance(place, Path):
                continue
        if isinstance(place, Refusal):
            refused[mesh.name] = place
        mesh.file, mesh.content_type = "", ""
        mesh.uservert, mesh.userface = (
            np.ravel(each) for each in (_BOX.vertices, np.asarray(_BOX.triangles, np.int32))
        )
        mesh.scale, mesh.refpos, mesh.refquat = (1, 1, 1), (0, 0, 0), (1, 0, 0, 0)
    return files, refused


def _has_faces(place: Path) -> bool:
    """Whether satcheck can read the mesh. MuJoCo takes the hull of an OBJ file with points only."""
    suffix = place.suffix.lower()
    if suffix != ".obj":
        return suffix in _READ_BY_SATCHECK
    with place.open("rb") as file:
        return any(line.lstrip()[:2] in (b"f ", b"f\t") for line in file)


def _place_of(
    mesh: Any, path: str, places: FilePlaces, models: list[str], *, stripped: bool
) -> tuple[str, Path | Refusal]:
    """(the file of a mesh, relative to the folder of the model file, where it lies). MuJoCo does
    not say which of the models that it attaches names the mesh, so one place must have the file."""
    start = Path(path).parent
    own = Path(mesh.compiler.meshdir, Path(mesh.file).name if stripped else mesh.file)
    folders = dict.fromkeys(os.path.relpath(Path(model).parent, start) for model in models)
    uris = [os.path.normpath(folder / own) for folder in folders]
    located: dict[str, Path] = {}
    failures: list[Refused] = []
    for uri in uris:
        try:
            located[uri] = places.of(path).locate_small(uri)
        except Refused as error:
            failures.append(error)
    if len(located) > 1:
        message = f"mesh file {str(own)!r} lies beside several attached models"
        return uris[0], Refusal("bad-robot", message)
    if not located:
        return uris[0], Refusal(failures[0].code, f"{own}: {failures[0].message}")
    return next(iter(located.items()))


def _line(info: str) -> int:
    words = info.split()
    return int(words[1]) if len(words) > 1 and words[0] == "line" and words[1].isdigit() else 0


def numbers(values: Any) -> Any:
    """As floats. Raises Refused if one is not finite."""
    vector = tuple(map(float, values))
    if not all(map(math.isfinite, vector)):
        raise Refused("non-finite", "a number of the file is not finite")
    return vector


def pose_of(at: Any, turn: Any) -> Transform:
    """turn: a unit quaternion (w, x, y, z), as in MuJoCo."""
    w, x, y, z = numbers(turn)
    return placed(quaternion_matrix(x, y, z, w), numbers(at))


def own_meshes_of(read: Compiled) -> Document:
    """Return the meshes that only MuJoCo reads, in the coordinates of the compiled model. Raises
    Refused."""
    m = read.model

    def mesh(k: int) -> RawMesh:
        vertices = m.mesh_vert[m.mesh_vertadr[k] :][: m.mesh_vertnum[k]].astype("<f8")
        faces = m.mesh_face[m.mesh_faceadr[k] :][: m.mesh_facenum[k]].astype("<u4")
        return RawMesh(vertices.tobytes(), faces.tobytes(), "float32", units="m")

    others = {*read.refused, *read.file_meshes}
    own = [k for k in range(m.nmesh) if m.mesh(k).name not in others]
    if not own:
        raise Refused("unknown-part", "it has no mesh of its own")
    name = partial(part_name, m)
    return raw_scene([Instance(k, None, name(k)) for k in own], name, mesh)


def part_name(model: Any, mesh: int) -> str:
    """Without the mark of components. Names of meshes are unique, and so are these."""
    name = model.mesh(mesh).name
    return f"mesh{mesh}" if COMPONENT_MARK in name else name
