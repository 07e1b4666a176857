"""Reads files with trimesh, in the child process of the readers.

What trimesh does not know it leaves out, often without a word: a scene that is read so is never
complete. Its warnings are errors here.
"""

from __future__ import annotations

import io
import logging
import re
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from logging.handlers import BufferingHandler
from typing import Any

import numpy as np

from satcheck.core.errors import SatcheckError
from satcheck.scene.document import Document, RawMesh, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import Instance, raw_scene
from satcheck.scene.files.readers import File, imported
from satcheck.scene.units import unit_of

_MOST_VERTICES = 2**32  # they are numbered in 32 bits


def read_tail(file: File) -> Document:
    """Return the meshes of a file where trimesh places them. Raises Refused without a file
    name."""
    trimesh = imported("trimesh", "tail", f"{file.format.upper()} files")
    if file.format not in trimesh.available_formats():
        message = f"{file.format.upper()} files: trimesh needs more: pip install 'satcheck[tail]'"
        raise Refused("missing-extra", message)
    try:
        with _warnings() as said:
            scene = trimesh.load_scene(
                io.BytesIO(bytes(file.data)),
                file_type=file.format,
                process=False,
                allow_remote=False,
            )
    except (MemoryError, SatcheckError):
        raise
    except Exception as error:  # noqa: BLE001  a library with exceptions of every kind
        reason = f"{type(error).__name__}: {error}"
        raise Refused("bad-record", f"trimesh cannot read it: {reason}") from None
    if said:
        raise Refused("bad-record", f"trimesh reads a part of it: {said[0].getMessage()}")
    nodes = sorted(scene.graph.nodes_geometry)
    units = unit_of(scene.units) if scene.units else None
    read = raw_scene(
        [Instance(*_placed(scene, node), str(node)) for node in nodes],
        str,
        lambda name: _mesh(scene.geometry[name], units),
    )
    models = len(re.findall(rb"<(?:\w+:)?GeometryModel3D[\s>]", file.data))
    joined = ("unread", f"trimesh makes one body of its {models} models")
    warnings = (joined,) if models > 1 and file.format == "xaml" else ()
    return Document(read.parts, read.items, warnings, units)


def _placed(scene: Any, node: str) -> tuple[str, tuple[float, ...]]:
    """The name of the mesh of a node, and its placement."""
    matrix, name = scene.graph[node]
    values = np.asarray(matrix, dtype=float)
    if values.shape != (4, 4) or not np.isfinite(values).all():
        raise Refused("bad-record", f"trimesh gives {node} no finite placement")
    return name, tuple(values.ravel().tolist())


def _mesh(geometry: Any, units: str | None) -> RawMesh | Refusal:
    if not hasattr(geometry, "faces"):
        kind = type(geometry).__name__
        return Refusal("unsupported-feature", f"trimesh reads a {kind}, which has no triangles")
    points = np.asarray(geometry.vertices, dtype="<f8")
    faces = np.asarray(geometry.faces)
    if faces.size and not 0 <= faces.min() <= faces.max() < min(len(points), _MOST_VERTICES):
        return Refusal("index-out-of-range", "trimesh gives it faces without corners")
    # The digits of the file are gone: float32 is what these formats are written from.
    return RawMesh(points.tobytes(), faces.astype("<u4").tobytes(), "float32", units=units)


@contextmanager
def _warnings() -> Iterator[list[logging.LogRecord]]:
    """What trimesh warns of meanwhile."""
    handler, log = BufferingHandler(sys.maxsize), logging.getLogger("trimesh")
    handler.setLevel(logging.WARNING)
    log.addHandler(handler)
    try:
        yield handler.buffer
    finally:
        log.removeHandler(handler)
