"""Writes convex parts to a mesh file: GLB (a node for each part), OBJ (an object for each), or STL.

GLB and STL hold 32-bit floats (glTF 2.0, section 3.6.2.2; the STL of 3D Systems, 1988).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from satcheck.core import Mesh
from satcheck.scene.glb_file import Node, glb

Part = tuple[str, Mesh]
_CONTINUES = "\\"  # at the end of a line of OBJ: the next line belongs to it


def written(parts: Sequence[Part], suffix: str, units: str | None) -> bytes:
    """The content of a file. parts: names, and meshes in one frame. suffix: a key of FORMATS.
    units: of the coordinates. If they are known, a GLB file is in metres."""
    return FORMATS[suffix]([(_plain(name), mesh) for name, mesh in parts], units)


def rounding(parts: Sequence[Part], suffix: str) -> float:
    """An upper bound on how far a vertex moves when its coordinates are rounded for the file."""
    if suffix == ".obj":
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


def _stl(parts: Sequence[Part], units: str | None) -> bytes:
    import trimesh
    from trimesh.exchange.stl import export_stl

    del units
    meshes = [trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False) for _, mesh in parts]
    content: bytes = export_stl(trimesh.util.concatenate(meshes))
    return content


def _glb(parts: Sequence[Part], units: str | None) -> bytes:
    return glb([Node(name, mesh) for name, mesh in parts], units)


FORMATS: dict[str, Callable[[Sequence[Part], str | None], bytes]] = {
    ".glb": _glb,
    ".obj": _obj,
    ".stl": _stl,
}
