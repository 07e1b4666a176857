"""The samples get the answers that are pinned."""

from __future__ import annotations

import pytest

from tests.contract.broken import broken
from tests.contract.cases import Call, sample_pairs, sample_scenes
from tests.plugin_marks import skip_without

ALL_SAMPLES = ("yard.sdf", "lift.xml")  # that need a plug-in


@pytest.mark.parametrize("call", sample_pairs(), ids=lambda call: call.name)
def test_pair(call: Call) -> None:
    skip_without([*call.arguments, *ALL_SAMPLES] if call.name == "each" else call.arguments)
    assert broken("sample_pairs", call) == []


@pytest.mark.parametrize("call", sample_scenes(), ids=lambda call: call.name)
def test_scene(call: Call) -> None:
    skip_without([*call.arguments, *ALL_SAMPLES] if call.name == "each" else call.arguments)
    assert broken("sample_scenes", call) == []
