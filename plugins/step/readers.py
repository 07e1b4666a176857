"""What the registry knows of STEP files."""

from __future__ import annotations

from satcheck.scene.files.readers import Reader, facets

# Millimetres. In machines press fits of 0.02 mm are common, and facets hide overlaps up to twice
# their tolerance.
CHORD = 0.005

READERS = (
    Reader(
        "step",
        "STEP",
        (".step", ".stp", ".p21"),
        "satcheck.plugins.step.assembly:read_step",
        options=facets(CHORD),
        marks=(b"ISO-10303-21;",),
        text="own",
    ),
)
