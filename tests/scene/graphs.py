"""Small glTF and 3MF files with several nodes, as the tests of nodes need them."""

from __future__ import annotations

import json
import struct
from typing import Any

from tests.scene import files

MOVED = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]  # column-major: x + 5


def meshes(*names: str | None) -> tuple[dict[str, Any], bytes]:
    """A document with the unit cube under each of these names, and its one buffer."""
    document, buffer = files.gltf_document()
    (mesh,) = document["meshes"]
    document["meshes"] = [mesh if name is None else {**mesh, "name": name} for name in names]
    return document, buffer


def glb(nodes: list[dict[str, Any]], *names: str | None, roots: list[int] | None = None) -> bytes:
    document, buffer = meshes(*(names or ("cube",)))
    document["nodes"] = nodes
    children = {child for node in nodes for child in node.get("children", [])}
    tops = [k for k in range(len(nodes)) if k not in children] if roots is None else roots
    document["scenes"] = [{"nodes": tops}]
    return files.glb(document, buffer)


def with_broken_mesh() -> bytes:
    """Two nodes with a cube, and between them one whose mesh has an index too many."""
    document, buffer = meshes("good", "bad")
    document["accessors"].append(
        {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"}
    )
    indices = struct.pack("<3H", 0, 1, 8)
    document["bufferViews"].append(
        {"buffer": 0, "byteOffset": len(buffer), "byteLength": len(indices)}
    )
    document["buffers"][0]["byteLength"] += len(indices)
    document["meshes"][1]["primitives"] = [{"attributes": {"POSITION": 0}, "indices": 2}]
    document["nodes"] = [
        {"name": "a", "mesh": 0},
        {"name": "b", "mesh": 1},
        {"name": "c", "mesh": 0, "translation": [0.5, 0, 0]},
    ]
    document["scenes"] = [{"nodes": [0, 1, 2]}]
    return files.glb(document, buffer + indices)


def gltf(document: dict[str, Any]) -> bytes:
    return json.dumps(document).encode()


def named_3mf(id_: int, name: str, **shape: Any) -> str:
    return files.object_3mf(id_, **shape).replace("<object ", f'<object name="{name}" ', 1)
