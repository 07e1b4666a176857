"""Meshes as a GLB file (glTF 2.0, Khronos, 2021), by trimesh: named nodes, each mesh and material
once.

GLB holds 32-bit floats (section 3.6.2.2), metres (section 3.4).
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
