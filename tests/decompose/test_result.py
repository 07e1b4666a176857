"""decompose/result.py: a decomposition survives its encoding, and nothing else decodes."""

from __future__ import annotations

import pytest

from satcheck.core import Mesh
from satcheck.core.blocks import pack_blocks, unpack_blocks
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


def test_every_missing_block_is_refused(result: Decomposition) -> None:
    blocks = unpack_blocks(encode(result))
    for count in range(len(blocks)):
        with pytest.raises(ValueError, match=r"head|blocks"):
            decode(pack_blocks(blocks[:count]), SETTINGS)


def test_a_part_that_is_no_mesh_is_refused(result: Decomposition) -> None:
    blocks = unpack_blocks(encode(result))
    blocks[2] = blocks[2][:-1]
    with pytest.raises(ValueError, match="multiples"):
        decode(pack_blocks(blocks), SETTINGS)


def test_an_empty_part_is_refused(result: Decomposition) -> None:
    blocks = unpack_blocks(encode(result))
    blocks[2] = blocks[3] = b""
    with pytest.raises(ValueError, match="empty"):
        decode(pack_blocks(blocks), SETTINGS)
