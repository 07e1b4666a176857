"""decompose/result.py: a decomposition survives its encoding, and nothing else decodes."""

from __future__ import annotations

import math
import struct

import msgspec
import pytest

from satcheck.core import Mesh
from satcheck.decompose.result import Decomposition, Note, decode, encode
from satcheck.decompose.settings import DecompositionSettings

SETTINGS = DecompositionSettings()


@pytest.fixture
def result(box: Mesh, l_shape: Mesh) -> Decomposition:
    hull = l_shape.convex_hull()
    return Decomposition(
        parts=(hull, box.convex_hull()),
        inner=(None, box.convex_hull()),
        outside=0.25,
        missing=1e-300,
        seconds=1.5,
        from_cache=False,
        settings=SETTINGS,
        notes=(Note("some-code", "Größe"), Note("other-code", "")),
    )


def test_round_trip(result: Decomposition) -> None:
    back = decode(encode(result))
    assert (back.seconds, back.notes) == (1.5, result.notes)
    assert back.inner[0] is None
    assert [part.dimension for part in back.parts] == [3, 3]
    for mine, theirs in zip(result.parts, back.parts, strict=True):
        assert theirs.to_mesh().to_bytes() == mine.to_mesh().to_bytes()


def test_whatever_is_cut_off_is_refused(result: Decomposition) -> None:
    data = encode(result)
    for length in range(len(data)):
        with pytest.raises(ValueError):  # noqa: PT011  of several kinds
            decode(data[:length])


NAN = struct.pack("<12d", *[math.nan] * 12), struct.pack("<3I", 0, 1, 2)
FLAT = struct.pack("<9d", 0, 0, 0, 1, 0, 0, 0, 1, 0), struct.pack("<3I", 0, 1, 2)


@pytest.mark.parametrize(
    "part", [(b"x" * 23, b"0" * 12), (b"", b""), b"", None, ("text", b""), NAN, FLAT]
)
def test_a_part_that_is_no_solid_is_refused(result: Decomposition, part: object) -> None:
    entry = msgspec.msgpack.decode(encode(result))
    entry["parts"][0] = part
    with pytest.raises(ValueError):  # noqa: PT011  of several kinds
        decode(msgspec.msgpack.encode(entry))


@pytest.mark.parametrize(
    "change",
    [
        {"parts": [], "inner": []},
        {"inner": [None]},
        {"seconds": math.nan},
        {"seconds": -1.0},
    ],
)
def test_what_no_result_has_is_refused(result: Decomposition, change: dict[str, object]) -> None:
    entry = msgspec.msgpack.decode(encode(result)) | change
    with pytest.raises(ValueError):  # noqa: PT011  of several kinds
        decode(msgspec.msgpack.encode(entry))
