"""decompose/settings.py: settings that CoACD would hang or abort on are refused by name."""

from __future__ import annotations

import math

import pytest

from satcheck.decompose.errors import BAD_SETTING, DecompositionError
from satcheck.decompose.settings import DecompositionSettings


@pytest.mark.parametrize("threshold", [0.0, -0.05, 1.0000001, math.inf, math.nan])
def test_a_threshold_out_of_range_is_refused(threshold: float) -> None:
    with pytest.raises(DecompositionError) as caught:
        DecompositionSettings(threshold=threshold)
    assert caught.value.code == BAD_SETTING


@pytest.mark.parametrize("seed", [-1, 1 << 32])
def test_a_seed_out_of_range_is_refused(seed: int) -> None:
    with pytest.raises(DecompositionError) as caught:
        DecompositionSettings(seed=seed)
    assert caught.value.code == BAD_SETTING
