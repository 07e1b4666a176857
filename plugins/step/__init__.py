"""STEP files (ISO 10303-21): OpenCascade makes facets of their solids, through cascadio.

`exchange` looks at the text of the file: whether it is whole, and what OpenCascade would leave out
without a word. `assembly` makes bodies of the glTF document with the facets. README.md says what is
read.
"""

from __future__ import annotations

from satcheck.scene.loading.readers import Reader

# Millimetres. In machines press fits of 0.02 mm are common, and facets hide overlaps up to twice
# their tolerance.
CHORD = 0.005

READERS = (
    Reader(
        "step",
        "STEP",
        (".step", ".stp", ".p21"),
        "satcheck.plugins.step.assembly:read_step",
        options=("chord_tolerance", "angular_tolerance"),
        marks=(b"ISO-10303-21;",),
        chord=CHORD,
    ),
)
