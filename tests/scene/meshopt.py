"""Streams of the meshopt bitstream, written plainly: no delta is predicted, no index guessed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def zigzag(value: int, bits: int) -> int:
    """value: a difference modulo 2^bits."""
    signed = value - (1 << bits) if value >> (bits - 1) else value
    return (~(signed << 1) if signed < 0 else signed << 1) & ((1 << bits) - 1)


def attributes(data: bytes, stride: int, version: int = 0) -> bytes:
    """Elements of `stride` bytes, each byte of a block by itself and in full."""
    count = len(data) // stride
    block = min(8192 // stride // 16 * 16, 256)
    stream = bytearray([0xA0 + version])
    before = bytes(stride)
    for start in range(0, count, block):
        rows = [
            data[i * stride : (i + 1) * stride] for i in range(start, min(start + block, count))
        ]
        stream += b"\xff" * (stride // 4 if version else 0)  # every byte verbatim
        groups = -(-len(rows) // 16)
        for k in range(stride):
            earlier = [before[k], *(row[k] for row in rows[:-1])]
            pairs = zip(rows, earlier, strict=True)
            deltas = bytes(zigzag((row[k] - old) % 256, 8) for row, old in pairs)
            if not version:
                stream += b"\xff" * -(-groups // 4)  # every group in full
                deltas = deltas.ljust(16 * groups, b"\0")
            stream += deltas
        before = rows[-1]
    tail = bytes(stride) + bytes(stride // 4 if version else 0)
    return bytes(stream) + tail.rjust(24 if version else 32, b"\0")


def varint(value: int) -> bytes:
    low, high = value & 0x7F, value >> 7
    return bytes([low | 0x80]) + varint(high) if high else bytes([low])


def indices(values: Iterable[int]) -> bytes:
    stream, last = bytearray([0xD1]), 0
    for value in values:
        stream += varint(zigzag((value - last) % (1 << 31), 31) << 1)
        last = value
    return bytes(stream) + bytes(4)


def triangles(faces: Sequence[Sequence[int]]) -> bytes:
    """Each corner as a difference to the one before."""
    data, last = bytearray(), 0
    for face in faces:
        data.append(0xFF)
        for corner in face:
            data += varint(zigzag((corner - last) % (1 << 32), 32))
            last = corner
    return bytes([0xE1]) + b"\xff" * len(faces) + bytes(data) + bytes(16)
