"""The GlobalId of the project of an IFC file, which BCF names beside the file."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.ifc.model import unpacked

_PROJECT = re.compile(rb"=\s*IFCPROJECT\s*\(\s*'([0-9A-Za-z_$]{22})'", re.IGNORECASE)


@cache
def project_of(file: str) -> str | None:
    """None: the file is not there any more, or names no project."""
    try:
        match = _PROJECT.search(unpacked(memoryview(Path(file).read_bytes())))
    except (OSError, MeshFileError):
        return None
    return match[1].decode("ascii", "replace") if match else None
