"""Real meshes, and scenes in all formats, get the answers that are pinned."""

from __future__ import annotations

import pytest

from tests.contract.broken import broken
from tests.contract.cases import Call, data_pairs, data_scenes
from tests.plugin_marks import skip_without


@pytest.mark.parametrize("call", data_pairs(), ids=lambda call: call.name)
def test_pair(call: Call) -> None:
    skip_without(call.arguments)
    assert broken("data_pairs", call) == []


@pytest.mark.parametrize("call", data_scenes(), ids=lambda call: call.name)
def test_scene(call: Call) -> None:
    skip_without(call.arguments)
    assert broken("data_scenes", call) == []
