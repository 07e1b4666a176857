"""What this process and the reading child say to each other: headers, JSON, raw arrays. No pickle.

request: uint32 length of a JSON object {format, directory}, the object, the file's bytes.
reply: magic, uint32 length of a JSON object, uint64 bytes of vertices, uint64 bytes of triangles,
then these three. The object is {"refusal": [code, message]} or a RawMesh without its arrays.
"""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass

from satcheck.scene.loading.raw_mesh import RawMesh

_REQUEST = struct.Struct("<I")
_REPLY = struct.Struct("<4sIQQ")
_MAGIC = b"SCM1"


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why the file cannot be used: one of `codes.CODES` and a sentence."""

    code: str
    message: str


@dataclass(frozen=True, slots=True)
class Request:
    """A file to read: its format, its bytes, and the directory its references start from."""

    format: str
    directory: str
    data: memoryview


def pack_request(file_format: str, directory: str, data: bytes) -> bytes:
    header = json.dumps({"format": file_format, "directory": directory}).encode()
    return _REQUEST.pack(len(header)) + header + data


def unpack_request(request: bytes) -> Request:
    (length,) = _REQUEST.unpack_from(request)
    body = _REQUEST.size + length
    header = json.loads(request[_REQUEST.size : body])
    return Request(header["format"], header["directory"], memoryview(request)[body:])


def pack_reply(answer: RawMesh | Refusal) -> bytes:
    if isinstance(answer, Refusal):
        return _frame({"refusal": [answer.code, answer.message]}, b"", b"")
    header: dict[str, object] = {
        "precision": answer.precision,
        "decimals": answer.decimals,
        "significant": answer.significant,
        "units": answer.units,
        "warnings": answer.warnings,
    }
    return _frame(header, answer.vertices, answer.triangles)


def _frame(header: dict[str, object], vertices: bytes, triangles: bytes) -> bytes:
    text = json.dumps(header).encode()
    head = _REPLY.pack(_MAGIC, len(text), len(vertices), len(triangles))
    return b"".join((head, text, vertices, triangles))


def unpack_reply(reply: bytes) -> RawMesh | Refusal:
    magic, text_size, vertex_size, triangle_size = _REPLY.unpack_from(reply)
    vertices_at = _REPLY.size + text_size
    triangles_at = vertices_at + vertex_size
    if magic != _MAGIC or len(reply) != triangles_at + triangle_size:
        return Refusal("reader-failed", "the reader's answer is damaged")
    header = json.loads(reply[_REPLY.size : vertices_at])
    if "refusal" in header:
        return Refusal(*header["refusal"])
    return RawMesh(
        vertices=reply[vertices_at:triangles_at],
        triangles=reply[triangles_at:],
        precision=header["precision"],
        decimals=header["decimals"],
        significant=header["significant"],
        units=header["units"],
        warnings=tuple((code, message) for code, message in header["warnings"]),
    )
