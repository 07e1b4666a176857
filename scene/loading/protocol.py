"""What this process and the reading child say to each other: headers, JSON, raw arrays. No pickle.

request: uint32 length of a JSON object {format, directory, flat, allow_outside},
the object, the file's bytes.
reply: magic, uint32 length of a JSON object, the object, and the arrays that it announces: vertices
and triangles of each part that has a mesh, then three rows of each node that has a matrix.
The object is {"refusal": [code, message]}, or a RawScene with numbers of bytes for its arrays.
"""

from __future__ import annotations

import json
import struct
from array import array
from collections.abc import Iterator
from typing import Any

from msgspec import Struct

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.raw_mesh import Block, RawMesh, RawNode, RawPart, RawScene

_REQUEST = struct.Struct("<I")
_REPLY = struct.Struct("<4sI")
_MAGIC = b"SCM2"
_MATRIX = struct.Struct("<12d")
_LAST_ROW = (0.0, 0.0, 0.0, 1.0)


class Request(Struct, frozen=True):
    """A file to read: its format, its bytes, the directory its references start from and whether
    they may leave it, and whether all of it is wanted as one mesh."""

    format: str
    directory: str
    flat: bool
    allow_outside: bool
    data: memoryview


def pack_request(
    file_format: str, directory: str, data: bytes, *, flat: bool, allow_outside: bool
) -> bytes:
    values = {
        "format": file_format,
        "directory": directory,
        "flat": flat,
        "allow_outside": allow_outside,
    }
    header = json.dumps(values).encode()
    return _REQUEST.pack(len(header)) + header + data


def unpack_request(request: bytes) -> Request:
    (length,) = _REQUEST.unpack_from(request)
    body = _REQUEST.size + length
    header = json.loads(request[_REQUEST.size : body])
    return Request(**header, data=memoryview(request)[body:])


def pack_reply(answer: RawScene | MeshFileError) -> bytes:
    if isinstance(answer, MeshFileError):
        return _frame({"refusal": [answer.code, answer.message]}, [])
    arrays: list[Block] = []
    for part in answer.parts:
        if isinstance(part.mesh, RawMesh):
            arrays += [part.mesh.vertices, part.mesh.triangles]
    matrices = array("d")
    for node in answer.nodes:
        if node.matrix is not None:
            matrices.extend(node.matrix[:12])
    header = {
        "parts": [[part.name, _mesh_header(part.mesh)] for part in answer.parts],
        "nodes": [[node.path, node.part, node.matrix is not None] for node in answer.nodes],
        "warnings": answer.warnings,
    }
    return _frame(header, [*arrays, struct.pack(f"<{len(matrices)}d", *matrices)])


def _mesh_header(mesh: RawMesh | MeshFileError) -> dict[str, Any]:
    if isinstance(mesh, MeshFileError):
        return {"refusal": [mesh.code, mesh.message]}
    return {
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.triangles),
        "precision": mesh.precision,
        "decimals": mesh.decimals,
        "significant": mesh.significant,
        "units": mesh.units,
        "warnings": mesh.warnings,
    }


def _frame(header: dict[str, Any], arrays: list[Block]) -> bytes:
    text = json.dumps(header).encode()
    return b"".join((_REPLY.pack(_MAGIC, len(text)), text, *arrays))


def unpack_reply(reply: bytes) -> RawScene:
    """Raises MeshFileError where the answer is one, or is damaged."""
    damaged = MeshFileError("reader-failed", "the reader's answer is damaged")
    magic, size = _REPLY.unpack_from(reply)
    arrays = _Arrays(reply, _REPLY.size + size)
    if magic != _MAGIC:
        raise damaged
    header = json.loads(reply[_REPLY.size : _REPLY.size + size])
    if "refusal" in header:
        raise MeshFileError(*header["refusal"])
    parts = tuple(RawPart(name, _mesh(mesh, arrays)) for name, mesh in header["parts"])
    placed = sum(has_matrix for _, _, has_matrix in header["nodes"])
    matrices = arrays.matrices(placed)
    if not arrays.at_end:
        raise damaged
    return RawScene(
        parts=parts,
        nodes=tuple(
            RawNode(path, part, next(matrices) if has_matrix else None)
            for path, part, has_matrix in header["nodes"]
        ),
        warnings=_warnings(header),
    )


class _Arrays:
    """The bytes after the header, in order."""

    def __init__(self, reply: bytes, start: int) -> None:
        self._reply = reply
        self._at = start

    def take(self, size: int) -> bytes:
        self._at += size
        return self._reply[self._at - size : self._at]

    def matrices(self, count: int) -> Iterator[tuple[float, ...]]:
        rows = _MATRIX.iter_unpack(self.take(count * _MATRIX.size))
        return ((*row, *_LAST_ROW) for row in rows)

    @property
    def at_end(self) -> bool:
        return self._at == len(self._reply)


def _mesh(header: dict[str, Any], arrays: _Arrays) -> RawMesh | MeshFileError:
    if "refusal" in header:
        return MeshFileError(*header["refusal"])
    return RawMesh(
        vertices=arrays.take(header["vertices"]),
        triangles=arrays.take(header["triangles"]),
        precision=header["precision"],
        decimals=header["decimals"],
        significant=header["significant"],
        units=header["units"],
        warnings=_warnings(header),
    )


def _warnings(header: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    return tuple((code, message) for code, message in header["warnings"])
