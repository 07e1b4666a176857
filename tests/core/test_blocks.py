"""core/blocks.py: what is unpacked is what was packed, and nothing else passes."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satcheck.core.blocks import pack_blocks, unpack_blocks


@given(st.lists(st.binary(max_size=40), max_size=8))
def test_round_trip(blocks: list[bytes]) -> None:
    assert unpack_blocks(pack_blocks(blocks)) == blocks


@given(st.lists(st.binary(max_size=20), max_size=4), st.data())
def test_every_truncation_is_refused(blocks: list[bytes], data: st.DataObject) -> None:
    packed = pack_blocks(blocks)
    length = data.draw(st.integers(0, len(packed) - 1))
    with pytest.raises(ValueError, match="cut short"):
        unpack_blocks(packed[:length])


def test_trailing_bytes_are_refused() -> None:
    with pytest.raises(ValueError, match="1 bytes follow"):
        unpack_blocks(pack_blocks([b"a"]) + b"x")


def test_a_forged_count_does_not_take_the_memory() -> None:
    with pytest.raises(ValueError, match="cut short"):
        unpack_blocks(b"\xff" * 8)
