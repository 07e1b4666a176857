"""glTF files of moved bodies: what was moved has moved, and nothing else has."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from satcheck.core.conventions import Bounds
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.scene.loading.gltf_buffers import split_glb
from satcheck.scene.moved.gltf import moved_gltf
from tests.scene.files import glb, gltf_document

BY = (0.25, -2.0, 0.5)
UP = (0.0, 0.0, 4.0)
# A quarter turn about z, twice as large, moved along x: exact in binary.
TURNED = [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 10, 0, 0, 1]
TABLE, VASE, LAMP = "room/table", "room/table/vase", "lamp"


def nested(**changes: dict[str, Any]) -> dict[str, Any]:
    """A vase below a table in a turned room, and a lamp beside the room. changes: of nodes."""
    nodes: dict[str, dict[str, Any]] = {
        "room": {"children": [1], "matrix": TURNED},
        "table": {"mesh": 0, "translation": [1, 0, 0], "children": [2]},
        "vase": {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1]},
        "lamp": {"mesh": 0},
    }
    placed = [{"name": name, **node, **changes.get(name, {})} for name, node in nodes.items()]
    document, _ = gltf_document()
    return document | {"nodes": placed, "scenes": [{"nodes": [0, 3]}]}


def bounds(path: Path) -> dict[str, Bounds]:
    return {body.id: body.world_mesh().bounds for body in load_scene([path]).bodies}


def moved(
    folder: Path, document: dict[str, Any], by: dict[str, tuple[float, float, float]]
) -> tuple[dict[str, Bounds], dict[str, Bounds]]:
    source, output = folder / "source.glb", folder / "moved.glb"
    source.write_bytes(glb(document))
    output.write_bytes(moved_gltf(source.read_bytes(), by, binary=True))
    return bounds(source), bounds(output)


def shifted(box: Bounds, by: tuple[float, float, float]) -> Bounds:
    low, high = (tuple(x + d for x, d in zip(corner, by, strict=True)) for corner in box)
    return low, high  # type: ignore[return-value]


def test_only_the_moved_body_moves(tmp_path: Path) -> None:
    before, after = moved(tmp_path, nested(), {TABLE: BY})
    assert set(before) == {TABLE, VASE, LAMP}
    assert after == before | {TABLE: shifted(before[TABLE], BY)}


def test_a_body_below_a_moved_body_takes_its_own_way(tmp_path: Path) -> None:
    before, after = moved(tmp_path, nested(), {TABLE: BY, VASE: UP, LAMP: BY})
    moves = {TABLE: BY, VASE: UP, LAMP: BY}
    assert after == {name: shifted(before[name], by) for name, by in moves.items()}


def test_nothing_changes_but_placements(tmp_path: Path) -> None:
    document = nested() | {"extras": {"made": "by hand"}}
    moved(tmp_path, document, {LAMP: BY})
    old, new = (
        split_glb(memoryview((tmp_path / name).read_bytes()))
        for name in ("source.glb", "moved.glb")
    )
    assert new[1] == old[1]
    before, after = json.loads(bytes(old[0])), json.loads(bytes(new[0]))
    assert after["nodes"][3].pop("translation") == list(BY)
    assert after == before


@pytest.mark.parametrize(
    ("changes", "path", "reason"),
    [
        ({"lamp": {"skin": 0}}, LAMP, "its skin"),
        ({}, "lamp#2", "no node of its own"),
        ({}, "nobody", "no node of its own"),
    ],
)
def test_what_no_node_places_is_not_moved(changes: Any, path: str, reason: str) -> None:
    with pytest.raises(SatcheckError, match=reason) as caught:
        moved_gltf(glb(nested(**changes)), {path: BY}, binary=True)
    assert caught.value.code == "not-movable"
    assert "write a scene file" in caught.value.message


def test_an_animated_node_is_not_moved() -> None:
    target = {"node": 3, "path": "translation"}
    document = nested() | {"animations": [{"channels": [{"sampler": 0, "target": target}]}]}
    with pytest.raises(SatcheckError, match="an animation places it"):
        moved_gltf(glb(document), {LAMP: BY}, binary=True)
    assert moved_gltf(glb(document), {TABLE: BY}, binary=True)
