"""What the registry knows of USD files."""

from __future__ import annotations

from satcheck.scene.loading.readers import Reader

READERS = (
    Reader(
        "usd",
        "USD",
        (".usd", ".usda", ".usdc", ".usdz"),
        "satcheck.plugins.usd.reader:read_usd",
        kind="document",
        options=("time", "geometry", "purpose"),
        marks=(b"PK\x03\x04",),
        by_name=True,
    ),
)
