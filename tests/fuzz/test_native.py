"""Every native reader on the inputs of all fuzzers, and on files that once cost it minutes."""

from __future__ import annotations

import random
import struct
from collections.abc import Callable
from typing import Any, Literal, get_args

import pytest

from satcheck._native import readers
from tests.fuzz.readers import SEEDS

NATIVE: dict[str, Callable[[bytes], Any]] = {
    "obj": readers.read_obj,
    "stl": readers.read_stl,
    "ply": readers.read_ply,
    "off": readers.read_off,
}
Mode = Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
Filter = Literal["NONE", "EXPONENTIAL", "QUATERNION"]
# Of the hash of a corner before it began with a random number.
FACTOR = 0x9E3779B97F4A7C15
WORD = 1 << 64


@pytest.mark.parametrize("name", NATIVE)
@pytest.mark.parametrize(
    "seed", sorted(SEEDS.rglob("*.*")), ids=lambda path: path.relative_to(SEEDS).as_posix()
)
def test_every_seed_is_a_mesh_or_an_error(name: str, seed: Any) -> None:
    outcome = NATIVE[name](seed.read_bytes())
    if isinstance(outcome, readers.ReadError):
        assert outcome.code
        assert outcome.message.isprintable()
    else:
        assert outcome.triangles.nbytes % 12 == 0


@pytest.mark.parametrize("mode", get_args(Mode))
@pytest.mark.parametrize("filter_", get_args(Filter))
def test_meshopt_unpacks_every_seed_or_says_why_not(mode: Mode, filter_: Filter) -> None:
    for seed in sorted(SEEDS.rglob("*")):
        data = seed.read_bytes() if seed.is_file() else b""
        for count, stride in ((6, 4), (1000, 8), (3, 2)):
            unpacked = readers.unpack_meshopt(data[7:], mode, count, stride, filter_)
            if isinstance(unpacked, bytes):
                assert len(unpacked) == count * stride


def test_corners_cannot_be_made_to_collide() -> None:
    """With a known hash these 300,000 corners would all have the same place in the table: minutes
    for a file of 5 MB."""
    corners = _colliding(300_000)
    facets = zip(*[iter(corners)] * 3, strict=True)
    body = b"".join(bytes(12) + b"".join(facet) + bytes(2) for facet in facets)
    mesh = readers.read_stl(bytes(80) + struct.pack("<I", len(corners) // 3) + body)
    assert isinstance(mesh, readers.MeshData)
    assert mesh.vertices.nbytes == 24 * len(corners)


def _colliding(count: int) -> list[bytes]:
    inverse = pow(FACTOR, -1, WORD)
    end = 0x123456789ABCDEF0
    corners: list[bytes] = []
    low = 0
    while len(corners) < count:
        low += 1
        high = end >> 32 << 32 | low
        first = high * inverse % WORD
        corner = struct.pack("<QI", first, (high ^ high >> 32 ^ end) % (1 << 32))
        if all(abs(x) < float("inf") for x in struct.unpack("<3f", corner)):
            corners.append(corner)
    return corners


def test_a_ply_header_of_many_properties() -> None:
    """Names were compared each with each."""
    properties = "".join(f"property int p{i}\n" for i in range(200_000))
    elements = "".join(f"element e{i} 0\n" for i in range(100_000))
    header = f"ply\nformat ascii 1.0\nelement vertex 0\n{properties}{elements}end_header\n"
    outcome = readers.read_ply(header.encode())
    assert isinstance(outcome, readers.ReadError)
    assert "no x, y and z" in outcome.message


def test_a_ply_of_many_records_without_properties() -> None:
    """They take no byte, so a file can promise any number of them."""
    elements = "".join(f"element e{i} 4294967295\n" for i in range(10_000))
    header = f"ply\nformat binary_little_endian 1.0\n{elements}end_header\n"
    outcome = readers.read_ply(header.encode())
    assert isinstance(outcome, readers.MeshData)
    assert not outcome.triangles.nbytes


def test_a_polygon_whose_corners_are_all_in_a_line() -> None:
    """Rounding hides every sign, so each is computed exactly; the budget counts that."""
    rng = random.Random(0)
    points = "v 0 0 0\nv 0.1 0.3 0\nv 0.2 0.6 0\nv 0.30000000000000004 0.9 0\nv 5 0.1 0\n"
    corners = " ".join(str(rng.randint(1, 5)) for _ in range(15_000))
    outcome = readers.read_obj(f"{points}f {corners}\n".encode())
    assert isinstance(outcome, readers.ReadError)
    assert outcome.code == "too-large"
    assert "cut them" in outcome.message
