"""SDFormat (.sdf, .world): worlds and models -> one robot with all links.

The format: http://sdformat.org/spec. `reading` collects models, links and joints, `frames` places
them, `joint_forest` of robots orders the joints, and `exemptions` says which pairs are not checked.
README.md says what is read.
"""

from __future__ import annotations

from satcheck.scene.loading.readers import RobotReader

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
