"""Meshes as a GLB file (glTF 2.0, Khronos, 2021): named nodes, each mesh and material once.

GLB holds 32-bit floats (section 3.6.2.2), metres (section 3.4).
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from msgspec import Struct

from satcheck.core import Mesh
from satcheck.core.transform import Transform
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.units import MICROMETRES, unit_of

_FLOAT, _UNSIGNED_INT = 5126, 5125
_VERTICES, _INDICES = 34962, 34963


class Material(Struct, frozen=True):
    """colour: red, green, blue, alpha, from 0 to 1."""

    name: str
    colour: tuple[float, float, float, float]


class Node(Struct, frozen=True):
    """transform: row-major 4x4; None: the identity. material: None: that of the viewer."""

    name: str
    mesh: Mesh
    transform: Transform | None = None
    material: Material | None = None


def glb(nodes: Sequence[Node], units: str | None, remarks: Sequence[str] = ()) -> bytes:
    """units: of all coordinates; the file is in metres where they are known. remarks: `extras` of
    the scene."""
    file = _File(remarks)
    for node in nodes:
        file.add(node, _metres(units))
    return file.content()


class _File:
    """A document and its buffer, as they grow."""

    def __init__(self, remarks: Sequence[str]) -> None:
        self._remarks = {"extras": {"remarks": list(remarks)}} if remarks else {}
        self._lists: dict[str, list[dict[str, Any]]] = {
            name: [] for name in ("nodes", "meshes", "materials", "accessors", "bufferViews")
        }
        self._chunks: list[bytes] = []
        self._size = 0
        self._primitives: dict[int, dict[str, Any]] = {}
        self._meshes: dict[tuple[int, Material | None], int] = {}
        self._materials: dict[Material, int] = {}

    def add(self, node: Node, metres: float) -> None:
        place: dict[str, Any] = {} if metres == 1.0 else {"scale": [metres] * 3}
        if node.transform is not None and node.transform != IDENTITY:
            matrix = np.diag([metres] * 3 + [1.0]) @ np.array(node.transform).reshape(4, 4)
            place = {"matrix": matrix.T.ravel().tolist()}
        self._append("nodes", {"name": node.name, "mesh": self._mesh(node), **place})

    def content(self) -> bytes:
        document = {
            "asset": {"version": "2.0", "generator": "satcheck"},
            "scene": 0,
            "scenes": [{"nodes": list(range(len(self._lists["nodes"]))), **self._remarks}],
            **{name: entries for name, entries in self._lists.items() if entries},
            "buffers": [{"byteLength": self._size}],
        }
        text = json.dumps(document, separators=(",", ":")).encode()
        chunks = {b"JSON": text + b" " * (-len(text) % 4), b"BIN\0": b"".join(self._chunks)}
        return _container(chunks)

    def _mesh(self, node: Node) -> int:
        key = id(node.mesh), node.material
        if key not in self._meshes:
            primitive = self._primitive(node.mesh)
            if node.material is not None:
                primitive = {**primitive, "material": self._material(node.material)}
            entry = {"name": node.name, "primitives": [primitive]}
            self._meshes[key] = self._append("meshes", entry)
        return self._meshes[key]

    def _primitive(self, mesh: Mesh) -> dict[str, Any]:
        if id(mesh) not in self._primitives:
            points, corners = mesh.vertices.astype("<f4"), mesh.triangles.astype("<u4")
            low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()
            vectors = {"componentType": _FLOAT, "type": "VEC3", "count": len(points)}
            numbers = {"componentType": _UNSIGNED_INT, "type": "SCALAR", "count": corners.size}
            self._primitives[id(mesh)] = {
                "attributes": {
                    "POSITION": self._accessor(points, _VERTICES, **vectors, min=low, max=high)
                },
                "indices": self._accessor(corners, _INDICES, **numbers),
            }
        return self._primitives[id(mesh)]

    def _accessor(self, values: Any, target: int, **accessor: Any) -> int:
        data = values.tobytes()
        view = {"buffer": 0, "byteOffset": self._size, "byteLength": len(data), "target": target}
        self._chunks.append(data)
        self._size += len(data)
        number = self._append("bufferViews", view)
        return self._append("accessors", {"bufferView": number, **accessor})

    def _material(self, material: Material) -> int:
        if material not in self._materials:
            entry: dict[str, Any] = {
                "name": material.name,
                "doubleSided": True,
                "pbrMetallicRoughness": {
                    "baseColorFactor": list(material.colour),
                    "metallicFactor": 0.0,
                },
            }
            if material.colour[3] < 1.0:
                entry["alphaMode"] = "BLEND"
            self._materials[material] = self._append("materials", entry)
        return self._materials[material]

    def _append(self, name: str, entry: dict[str, Any]) -> int:
        self._lists[name].append(entry)
        return len(self._lists[name]) - 1


def _metres(units: str | None) -> float:
    unit = unit_of(units)
    return 1.0 if unit is None else MICROMETRES[unit] / MICROMETRES["m"]


def _container(chunks: Mapping[bytes, bytes]) -> bytes:
    body = b"".join(struct.pack("<I", len(c)) + kind + c for kind, c in chunks.items())
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body
