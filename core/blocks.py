"""Lists of byte strings as one byte string: the common ground of worker messages and cache files.

Layout: the number of blocks, then each block's length and bytes; all integers little-endian u64.
Meshes travel as two blocks, float64 xyz... and uint32 ijk..., as Mesh.to_bytes() gives them.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import Final

_COUNT: Final = struct.Struct("<Q")


def pack_blocks(blocks: Iterable[bytes]) -> bytes:
    pieces = list(blocks)
    data = bytearray(_COUNT.pack(len(pieces)))
    for piece in pieces:
        data += _COUNT.pack(len(piece))
        data += piece
    return bytes(data)


def unpack_blocks(data: bytes) -> list[bytes]:
    """Raises ValueError unless `data` is exactly what pack_blocks() makes."""
    try:
        (count,) = _COUNT.unpack_from(data)
        offset = _COUNT.size
        blocks = []
        for _ in range(count):
            (length,) = _COUNT.unpack_from(data, offset)
            offset += _COUNT.size
            blocks.append(data[offset : offset + length])
            if len(blocks[-1]) != length:
                raise ValueError(f"a block of {length} bytes is cut short")
            offset += length
    except struct.error as error:
        raise ValueError("a block header is cut short") from error
    if offset != len(data):
        raise ValueError(f"{len(data) - offset} bytes follow the last block")
    return blocks
