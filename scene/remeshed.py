"""A mesh file as if it held another mesh: for questions about meshes that are in no file."""

from __future__ import annotations

import hashlib

from msgspec.structs import replace

from satcheck.core import Mesh
from satcheck.scene.bodies import MeshFile
from satcheck.scene.health import examine


def remeshed(file: MeshFile, mesh: Mesh) -> MeshFile:
    """The file with this mesh, inspected and repaired as one that was read.

    sha256 is that of the mesh, so that nothing known about the file's own is taken for this one.
    Raises MeshFileError when no triangle has an area.
    """
    examined = examine(mesh, resolution=lambda _: file.resolution)
    return replace(
        file,
        sha256=hashlib.sha256(b"".join(mesh.to_bytes())).hexdigest(),
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
    )
