"""The samples get the answers that are pinned."""

from __future__ import annotations

import pytest

from tests.contract.broken import broken
from tests.contract.cases import Call, sample_pairs, sample_scenes


@pytest.mark.parametrize("call", sample_pairs(), ids=lambda call: call.name)
def test_pair(call: Call) -> None:
    assert broken("sample_pairs", call) == []


@pytest.mark.parametrize("call", sample_scenes(), ids=lambda call: call.name)
def test_scene(call: Call) -> None:
    assert broken("sample_scenes", call) == []
