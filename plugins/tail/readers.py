"""What the registry knows of the formats that trimesh reads."""

from __future__ import annotations

from satcheck.scene.files.readers import Reader

_READ = "satcheck.plugins.tail.reader:read_tail"

READERS = (
    Reader("3dxml", "3DXML", (".3dxml",), _READ, marks=(b"PK\x03\x04",), complete=False),
    Reader("xaml", "XAML", (".xaml",), _READ, text="own", complete=False),
    Reader("zae", "ZAE", (".zae",), _READ, marks=(b"PK\x03\x04",), complete=False),
)
