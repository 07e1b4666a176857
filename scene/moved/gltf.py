"""Writes moved bodies into a glTF or GLB file. Only the placements of nodes change."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from satcheck.core.errors import SatcheckError
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.loading.gltf_buffers import Work, items, split_glb
from satcheck.scene.loading.gltf_nodes import NodeGraph, parse_document, placement_of
from satcheck.scene.loading.placing import multiply

Vector = tuple[float, float, float]

_ORIGIN = (0.0, 0.0, 0.0)
_PLACING = frozenset(("translation", "rotation", "scale"))  # by these, animations place nodes
_HEADER_BYTES, _CHUNK_HEADER_BYTES = 12, 8


def moved_gltf(data: bytes, translations: Mapping[str, Vector], *, binary: bool) -> bytes:
    """The file with these bodies moved, and all others where they were.

    translations: path of a node with a mesh -> translation in the world, in metres. binary: GLB.
    Raises SatcheckError (`not-movable`) for a node that a skin, an animation or an instance places,
    and MeshFileError for a broken file.
    """
    text = split_glb(memoryview(data))[0] if binary else memoryview(data)
    document = parse_document(text)
    _move(document, translations)
    if not binary:
        return json.dumps(document, ensure_ascii=False, indent=2).encode() + b"\n"
    written = json.dumps(document, ensure_ascii=False, separators=(",", ":")).encode()
    written += b" " * (-len(written) % 4)
    rest = data[_HEADER_BYTES + _CHUNK_HEADER_BYTES + len(text) :]
    chunk = struct.pack("<I", len(written)) + b"JSON" + written
    return b"glTF" + struct.pack("<II", 2, _HEADER_BYTES + len(chunk) + len(rest)) + chunk + rest


def _move(document: dict[str, Any], translations: Mapping[str, Vector]) -> None:
    """Nodes below a moved node move with it. Those with a mesh are moved back."""
    graph, nodes = NodeGraph(document, Work(isolated=True)), items(document, "nodes")
    paths = {node.key: node.path for node in graph.drawn()}
    for name in translations.keys() - set(paths.values()):
        raise _not_movable(name, "it is no node of its own")
    animated = _animated(document)
    waiting = [(root, IDENTITY, _ORIGIN) for root in graph.roots()]
    while waiting:
        number, parent, inherited = waiting.pop()
        path = paths.get(number)
        step = inherited if path is None else translations.get(path, _ORIGIN)
        world = multiply(parent, placement_of(nodes[number], number)) or IDENTITY
        waiting += [(child, world, step) for child, _ in graph.children(number)]
        if step != inherited:
            if "skin" in nodes[number]:
                raise _not_movable(str(path), "its skin places it")
            if number in animated:
                raise _not_movable(str(path), "an animation places it")
            _shift(nodes[number], np.subtract(step, inherited), parent)


def _shift(node: dict[str, Any], step: Any, parent: Sequence[float]) -> None:
    """step: in the world. parent: its matrix."""
    x, y, z = np.linalg.solve(np.array(parent).reshape(4, 4)[:3, :3], step).tolist()
    if "matrix" in node:
        columns = node["matrix"]
        columns[12:15] = [columns[12] + x, columns[13] + y, columns[14] + z]
    else:
        a, b, c = node.get("translation", _ORIGIN)
        node["translation"] = [a + x, b + y, c + z]


def _animated(document: dict[str, Any]) -> frozenset[int]:
    targets = [
        channel["target"]
        for animation in items(document, "animations")
        for channel in items(animation, "channels")
    ]
    return frozenset(target["node"] for target in targets if target.get("path") in _PLACING)


def _not_movable(path: str, reason: str) -> SatcheckError:
    return SatcheckError(
        "not-movable", f"{path} cannot be moved in the glTF file: {reason}; write a scene file"
    )
