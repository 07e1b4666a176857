"""decompose/result.py: a decomposition survives its encoding, and nothing else decodes."""

from __future__ import annotations

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
    back = decode(encode(result), SETTINGS)
    assert encode(back) == encode(result)
    assert back.from_cache
    assert (back.outside, back.missing, back.seconds) == (0.25, 1e-300, 1.5)
    assert back.notes == result.notes
    assert back.inner[0] is None
    assert [part.dimension for part in back.parts] == [3, 3]
    for mine, theirs in zip(result.parts, back.parts, strict=True):
        assert theirs.to_mesh().topology().volume == mine.to_mesh().topology().volume


def test_whatever_is_cut_off_is_refused(result: Decomposition) -> None:
    data = encode(result)
    for length in range(len(data)):
        with pytest.raises(ValueError):  # noqa: PT011  of several kinds
            decode(data[:length], SETTINGS)


@pytest.mark.parametrize("part", [(b"x" * 23, b"0" * 12), (b"", b""), b"", None, ("text", b"")])
def test_a_part_that_is_no_mesh_is_refused(result: Decomposition, part: object) -> None:
    entry = msgspec.msgpack.decode(encode(result))
    entry["parts"][0] = part
    with pytest.raises(ValueError):  # noqa: PT011  of several kinds
        decode(msgspec.msgpack.encode(entry), SETTINGS)
