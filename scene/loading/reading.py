"""Reads a file that is open: in this process or in the child process, as its reader says."""

from __future__ import annotations

from contextlib import suppress

from msgspec.structs import replace

from satcheck.scene.loading.raw_mesh import RawScene
from satcheck.scene.loading.readers import File, NeedsChild, Reader, ReadLimits, reader_named
from satcheck.scene.loading.reading_children import ReadingChildren


def read(file: File, allowed: ReadLimits, children: ReadingChildren) -> RawScene:
    """Return the meshes of a file and their placements. Raises MeshFileError."""
    reader = reader_named(file.format)
    assert reader is not None  # it has opened the file
    if file.size <= reader.here:
        with suppress(NeedsChild):
            return read_with(reader, file)
    from satcheck.scene.loading.child_formats import read_in_child

    if reader.by_name:
        file = replace(file, data=b"")
    return read_in_child(file, children, allowed)


def read_with(reader: Reader, file: File) -> RawScene:
    """Return the meshes of a file, as its reader places them. Raises MeshFileError and
    NeedsChild."""
    scene = reader.function()(file)
    if reader.complete:
        return scene
    message = (
        "the library that reads it may leave out what it does not know: overlaps count as it "
        "places the bodies, and no pair is proven apart"
    )
    return replace(scene, warnings=(*scene.warnings, ("incomplete", message)))
