"""What the registry knows of MJCF files."""

from __future__ import annotations

from satcheck.scene.files.readers import Option, Reader, RobotReader

ENDING = ".xml"
MESH_HULLS = Option("mesh_hulls", bool, "true: hulls of meshes, as in MuJoCo", False)

READERS = (
    RobotReader(
        "mjcf",
        "MJCF",
        (ENDING,),
        ("mujoco",),
        "satcheck.plugins.mjcf.child:read_mjcf",
        marks=(),
        options=(MESH_HULLS,),
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
