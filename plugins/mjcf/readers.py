"""What the registry knows of MJCF files."""

from __future__ import annotations

from satcheck.scene.files.readers import Reader, RobotReader

ENDING = ".xml"

READERS = (
    RobotReader(
        "mjcf", "MJCF", (ENDING,), ("mujoco",), "satcheck.plugins.mjcf.child:read_mjcf", marks=()
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
