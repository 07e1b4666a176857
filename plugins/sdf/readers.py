"""What the registry knows of SDFormat files."""

from __future__ import annotations

import math

from satcheck.scene.files.readers import Reader

ROOTS = ("sdf", "gazebo")  # the second until SDFormat 1.2

READERS = (
    Reader(
        "sdf",
        "SDF",
        (".sdf", ".world"),
        "satcheck.plugins.sdf.reading:read_sdf",
        kind="robot",
        here=math.inf,
        roots=ROOTS,
        texts=(b"<sdf", b"<gazebo"),
    ),
)
