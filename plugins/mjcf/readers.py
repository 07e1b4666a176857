"""What the registry knows of MJCF files."""

from __future__ import annotations

from satcheck.scene.files.readers import Option, Reader

ENDING = ".xml"
MESH_HULLS = Option("mesh_hulls", bool, "true: hulls of meshes, as in MuJoCo", False)

READERS = (
    Reader(
        "mjcf",
        "MJCF",
        (ENDING,),
        "satcheck.plugins.mjcf.child:read_mjcf",
        kind="robot",
        options=(MESH_HULLS,),
        roots=("mujoco",),
        texts=(),
    ),
    Reader(
        "mjcf",
        "MJCF",
        (ENDING,),
        "satcheck.plugins.mjcf.child:own_meshes",
        kind="robot",
        by_name=True,
    ),
)
