"""What the registry knows of IFC files."""

from __future__ import annotations

from satcheck.scene.files.readers import Reader, facets

CHORD = 1.0  # millimetres: buildings are drawn to about that

READERS = (
    Reader(
        "ifc",
        "IFC",
        (".ifc", ".ifczip"),
        "satcheck.plugins.ifc.reader:read_ifc",
        kind="document",
        options=facets(CHORD),
        marks=(b"ISO-10303-21;", b"PK\x03\x04"),
        text="own",
    ),
)
