"""What the registry knows of SDFormat files."""

from __future__ import annotations

from satcheck.scene.files.readers import RobotReader

ROOTS = ("sdf", "gazebo")  # the second until SDFormat 1.2

READERS = (
    RobotReader(
        "sdf",
        "SDF",
        (".sdf", ".world"),
        ROOTS,
        "satcheck.plugins.sdf.reading:read_sdf",
        marks=(b"<sdf", b"<gazebo"),
    ),
)
