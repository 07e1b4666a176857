"""Writes meshes: as a GLB file of named nodes, each mesh and material once, by trimesh; convex
parts also as OBJ (an object for each) or STL.

GLB and STL hold 32-bit floats (glTF 2.0, section 3.6.2.2; the STL of 3D Systems, 1988). GLB holds
metres (section 3.4).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct

from satcheck.core import Mesh
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.units import MICROMETRES, unit_of

if TYPE_CHECKING:
    from trimesh import Trimesh

Part = tuple[str, Mesh]
FORMATS = (".glb", ".obj", ".stl")
_SINGLE = (".glb", ".stl")  # those of 32-bit floats
_CONTINUES = "\\"  # at the end of a line of OBJ: the next line belongs to it


class Material(Struct, frozen=True):
    """colour: red, green, blue, alpha, from 0 to 1."""

    name: str
    colour: tuple[float, float, float, float]


class Node(Struct, frozen=True):
    """transform: row-major 4x4; None: the identity. material: None: that of the viewer."""

    name: str
    mesh: Mesh
    transform: Transform | None = None
    material: Material | None = None


def glb(nodes: Sequence[Node], units: str | None, remarks: Sequence[str] = ()) -> bytes:
    """units: of all coordinates; the file is in metres where they are known. remarks: `extras` of
    the scene."""
    from trimesh import Scene
    from trimesh.exchange.gltf import export_glb

    scene = Scene(metadata={"remarks": list(remarks)} if remarks else None)
    scale = np.diag([_metres(units)] * 3 + [1.0])
    meshes: dict[tuple[int, Material | None], str] = {}
    names = {str(number): node.name for number, node in enumerate(nodes)}
    for number, node in zip(names, nodes, strict=True):
        mesh = meshes.setdefault((id(node.mesh), node.material), number)
        if mesh == number:
            scene.geometry[number] = _mesh(node)
        place = scale @ np.reshape(node.transform or IDENTITY, (4, 4))
        scene.graph.update(frame_to=number, matrix=place, geometry=mesh)

    def name(tree: dict[str, Any]) -> None:
        """In a scene of trimesh no name occurs twice, so there they are numbers."""
        for entry in (*tree["nodes"], *tree.get("meshes", ())):
            entry["name"] = names.get(entry["name"], entry["name"])

    content: bytes = export_glb(scene, include_normals=False, tree_postprocessor=name)
    return content


def _mesh(node: Node) -> Trimesh:
    from trimesh import Trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    made = Trimesh(node.mesh.vertices, node.mesh.triangles, process=False)
    if node.material is not None:
        material = PBRMaterial(
            name=node.material.name,
            baseColorFactor=node.material.colour,
            metallicFactor=0.0,
            doubleSided=True,
            alphaMode="BLEND" if node.material.colour[3] < 1.0 else None,
        )
        made.visual = TextureVisuals(material=material)
    return made


def _metres(units: str | None) -> float:
    unit = unit_of(units)
    return 1.0 if unit is None else MICROMETRES[unit] / MICROMETRES["m"]


def written(parts: Sequence[Part], suffix: str, units: str | None) -> bytes:
    """The content of a file. parts: names, and meshes in one frame. suffix: one of FORMATS.
    units: of the coordinates. If they are known, a GLB file is in metres."""
    named = [(_plain(name), mesh) for name, mesh in parts]
    if suffix == ".glb":
        return glb([Node(name, mesh) for name, mesh in named], units)
    return _obj(named, units) if suffix == ".obj" else _stl(named)


def rounding(parts: Sequence[Part], suffix: str) -> float:
    """An upper bound on how far a vertex moves when its coordinates are rounded for the file."""
    if suffix not in _SINGLE:
        return 0.0
    steps = [mesh.vertices - mesh.vertices.astype("<f4") for _, mesh in parts]
    return max((float(np.linalg.norm(step, axis=1).max()) for step in steps), default=0.0)


def _plain(name: str) -> str:
    """A name of one line."""
    return "".join(c if c.isprintable() else "_" for c in name)


def _obj(parts: Sequence[Part], units: str | None) -> bytes:
    lines = ["# convex parts, made by satcheck", *([f"# units: {units}"] if units else [])]
    first = 1
    for name, mesh in parts:
        lines.append(f"o {name.rstrip(_CONTINUES)}")
        lines += ["v {!r} {!r} {!r}".format(*point) for point in mesh.vertices.tolist()]
        corners = mesh.triangles.astype(np.int64) + first
        lines += ["f {} {} {}".format(*triangle) for triangle in corners.tolist()]
        first += mesh.vertex_count
    return "".join(f"{line}\n" for line in lines).encode(errors="backslashreplace")


def _stl(parts: Sequence[Part]) -> bytes:
    import trimesh
    from trimesh.exchange.stl import export_stl

    meshes = [trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False) for _, mesh in parts]
    content: bytes = export_stl(trimesh.util.concatenate(meshes))
    return content
