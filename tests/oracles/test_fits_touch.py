"""What contradicts the oracle, and what does not."""

from __future__ import annotations

from typing import Any

import pytest

from tests.oracles.fits_touch import collisions_that_fit

ERROR: dict[str, Any] = {
    "a": "plate",
    "b": "pin",
    "severity": "error",
    "relation": "penetrating",
    "rule": None,
    "tolerance": 1e-3,
    "thickness_bounds": [0.0, 1e-3],
    "plan": [],
}
THROUGH = {"stage": "touch-band", "detail": "one body passes through the other; off by 1"}


@pytest.mark.parametrize(
    ("changes", "contradicts"),
    [
        ({}, True),
        ({"relation": "contains"}, True),
        ({"severity": "warning"}, False),
        ({"relation": "touching", "placed_relation": None}, False),
        ({"thickness_bounds": [0.0, 1.1e-3]}, False),
        ({"thickness_bounds": None}, False),
        ({"rule": "max-depth"}, False),
        ({"plan": [THROUGH]}, False),
        ({"components": {"components": [{"passes": "a-through-b"}]}}, False),
        ({"components": {"components": [{"passes": "none"}]}}, True),
    ],
)
def test_what_contradicts(changes: dict[str, Any], contradicts: bool) -> None:
    found = collisions_that_fit({"findings": [ERROR | changes]})
    assert found == (["plate and pin"] if contradicts else [])
