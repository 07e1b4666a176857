"""Which bodies are suggested as fixed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from satcheck.audit import Settings
from satcheck.audit.suggest_support import suggest_support
from tests.audit.statics.scenes import box, loaded


def suggested(folder: Path, bodies: list[dict[str, Any]], *rules: dict[str, Any]) -> dict[str, str]:
    terms = suggest_support(loaded(folder, bodies, list(rules)), Settings())
    return {fixed.body: fixed.evidence for fixed in terms.fixed}


@pytest.mark.parametrize("name", ["floor", "House/Floor", "wall_3", "Ceiling.001", "west walls"])
def test_parts_of_buildings_are_fixed(tmp_path, name):
    bodies = [box("a", [1, 1, 1], [0, 0, 0]), box(name, [9, 9, 1], [0, 0, 5])]
    assert list(suggested(tmp_path, bodies)) == [name]


@pytest.mark.parametrize("name", ["floor_lamp", "wallet", "roofing nail", "underground"])
def test_names_that_only_begin_so_are_not(tmp_path, name):
    bodies = [box("a", [1, 1, 1], [0, 0, 0]), box(name, [1, 1, 1], [0, 0, 5])]
    assert list(suggested(tmp_path, bodies)) == ["a"]


def test_without_names_the_lowest_are_suggested(tmp_path):
    bodies = [
        box("plate", [9, 9, 1], [0, 0, -0.5]),
        box("a", [1, 1, 1], [0, 0, 0.5]),
        box("b", [1, 1, 1], [3, 0, 0.5]),
    ]
    found = suggested(tmp_path, bodies)
    assert found == {"plate": "it lies lowest, and touches 2 of the others"}


def test_what_is_fixed_already_is_not_suggested(tmp_path):
    plate = box("plate", [9, 9, 1], [0, 0, -0.5], static=True)
    wall = box("wall", [1, 9, 9], [4, 0, 5])
    assert not suggested(tmp_path, [plate, box("a", [1, 1, 1], [0, 0, 0.5])])
    assert list(suggested(tmp_path, [plate, wall])) == ["wall"]
    assert not suggested(tmp_path, [plate, wall], {"bodies": "wall", "mounted": True})
