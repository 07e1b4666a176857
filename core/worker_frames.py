"""Frames of the pipes between `core.worker` and its child.

Each message is one frame: magic, status, length, CRC-32, payload.
"""

from __future__ import annotations

import struct
import zlib

HEADER = struct.Struct("<8scQI")  # magic, status, payload length in bytes, CRC-32 of the payload
_SECONDS = struct.Struct("<d")
_MAGIC = b"SATWRK01"
REQUEST = b"Q"
REPLY = b"R"
FAILED = b"F"
OUT_OF_MEMORY = b"M"

CHUNK_BYTES = 1 << 16  # one pipe read
MEMORY_SIGNS = (
    "bad_alloc",
    "MemoryError",
    "Cannot allocate memory",
    "out of memory",
    "failed to map segment",  # a shared library that did not fit
)


def parcel(request: bytes, seconds: float) -> bytes:
    """The payload of a request that has this much time."""
    return _SECONDS.pack(seconds) + request


def unwrapped(payload: bytes) -> tuple[bytes, float]:
    return payload[_SECONDS.size :], _SECONDS.unpack_from(payload)[0]


def frame_header(status: bytes, payload: bytes) -> bytes:
    return HEADER.pack(_MAGIC, status, len(payload), zlib.crc32(payload))


def frame_length(data: bytes | bytearray) -> int | None:
    """The length of the frame that starts here; None: its header is not complete yet."""
    if len(data) < HEADER.size:
        return None
    return HEADER.size + int(HEADER.unpack_from(data)[2])


def parse_frame(data: bytes) -> tuple[bytes, bytes] | None:
    """(status, payload); None: the frame is truncated or damaged."""
    if len(data) < HEADER.size:
        return None
    magic, status, length, checksum = HEADER.unpack_from(data)
    payload = data[HEADER.size :]
    if magic != _MAGIC or len(payload) != length or zlib.crc32(payload) != checksum:
        return None
    return status, payload
