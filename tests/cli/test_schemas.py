"""Every document that a command prints follows its published schema."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from satcheck.audit import Settings, check
from satcheck.cli.report.schema import text
from satcheck.scene import load_scene

SCHEMA = Draft202012Validator(json.loads(text()))
CERTIFIED = Settings(certificate=True, depth=True, clearance=0.5)
SHAPES: dict[str, dict[str, Any]] = {
    "box": {"type": "box", "size": [1, 1, 1]},
    "slab": {"type": "box", "size": [4, 4, 1]},
    "ball": {"type": "sphere", "radius": 0.5},
    "globe": {"type": "sphere", "radius": 2},
    "pill": {"type": "capsule", "radius": 0.25, "length": 1},
    "can": {"type": "cylinder", "radius": 0.5, "height": 1},
    "hat": {"type": "cone", "radius": 0.5, "height": 1},
    "egg": {"type": "ellipsoid", "radii": [0.5, 0.25, 0.75]},
}
# Apart, near, flush, within the tolerance, overlapping, concentric.
OFFSETS = (5.0, 1.25, 1.0, 1.0 - 1e-7, 0.75, 0.0)


def checked(folder: Path, settings: Settings, bodies: list[dict[str, Any]], **more: Any) -> Any:
    path = folder / "scene.json"
    path.write_text(
        json.dumps({"schema": "satcheck.scene/1", "bodies": bodies, **more}), encoding="utf-8"
    )
    return check(load_scene([path]), settings).to_dict()


@pytest.mark.parametrize("turn", [{}, {"euler": [20, 30, 40]}], ids=["straight", "turned"])
def test_certificates_of_shapes(tmp_path: Path, turn: dict[str, Any]) -> None:
    """Pairs of primitives in every relation: `point` and `nested` prove curved shapes alone."""
    kinds = set()
    pairs = itertools.combinations_with_replacement(SHAPES, 2)
    for (one, other), offset in itertools.product(pairs, OFFSETS):
        bodies = [
            {"id": "a", "shape": SHAPES[one]},
            {"id": "b", "shape": SHAPES[other], "position": [0, 0, offset], **turn},
        ]
        document = checked(tmp_path, CERTIFIED, bodies)
        SCHEMA.validate(document)
        certificate = document["findings"][0]["certificate"]
        kinds.add(certificate and certificate["relation"]["kind"])
    assert kinds >= {"axis", "point", "nested"}
