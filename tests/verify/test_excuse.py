"""Overlaps that surfaces which may be off explain, and excuses that explain nothing."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from satcheck.audit import Settings, check
from satcheck.scene import load_scene
from tests.audit.shapes import Mesh, box, bracket, unit_box, write
from tests.audit.stages.test_explained import BLOCK, FINNED, PLATE, SPIKE, joined, moved
from tests.audit.stages.test_thickness import WEDGE_THICKNESS, wedge
from tests.verify.honest import document
from tests.verify.reports import Json, verified

OFF = 0.51 * WEDGE_THICKNESS
# In a notch with sides of 2: too wide by this, and free along z only.
KEY = box((1.9375, 1.9375, 1.0), (3.0, 3.0, 2.0))


def made_of(folder: Path, a: Mesh, b: Mesh, **settings: Any) -> Json:
    return document(write(folder, a=a, b=b), **settings)


@pytest.mark.parametrize(
    ("a", "b", "settings"),
    [
        (unit_box(), wedge(), {"surface_tolerance": OFF}),
        (unit_box(), wedge(), {"surface_tolerance": OFF, "depth": True}),
        (unit_box(), wedge(), {"tolerance": 1.001 * WEDGE_THICKNESS}),
        (bracket(), KEY, {"surface_tolerance": 0.0625}),
        (KEY, bracket(), {"tolerance": 0.125, "depth": True}),
        (bracket(), KEY, {"surface_tolerance": 0.0625, "planar": "xy"}),
    ],
    ids=["a surface tolerance", "its depth", "the touch band", "a key", "a deep key", "in a plane"],
)
def test_what_is_explained_is_certified(
    tmp_path: Path, a: Mesh, b: Mesh, settings: dict[str, Any]
) -> None:
    made = made_of(tmp_path, a, b, **settings)
    (finding,) = made["findings"]
    assert (finding["relation"], finding["exact_relation"]) == ("touching", "penetrating")
    assert verified(made).accepted


def test_each_body_has_its_own_tolerance(tmp_path: Path) -> None:
    write(tmp_path, box=unit_box(), wedge=wedge())
    bodies = [
        {"id": "box", "mesh": "box.obj", "surface_tolerance": 0.26},
        {"id": "wedge", "mesh": "wedge.obj"},
    ]
    scene = tmp_path / "cell.json"
    scene.write_text(json.dumps({"schema": "satcheck.scene/1", "units": "mm", "bodies": bodies}))
    made = document([scene])
    assert made["findings"][0]["relation"] == "touching"
    assert verified(made).accepted
    made["bodies"][0]["surface_tolerance"] = 0.24
    assert not verified(made).accepted


def numbers(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, dict | list):
        for key, member in value.items() if isinstance(value, dict) else enumerate(value):
            yield from numbers(member, (*path, key))
    elif isinstance(value, int | float):
        yield path


def put(document: Json, path: tuple[Any, ...], value: Any) -> Json:
    forged = copy.deepcopy(document)
    place = forged
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return forged


TIGHT = 0.501 * WEDGE_THICKNESS


def test_no_excuse_is_forged(tmp_path: Path) -> None:
    """An overlap that is thicker than its surfaces may be off, with every number changed of an
    excuse for surfaces that may be off by more."""
    made = made_of(tmp_path, unit_box(), wedge(), surface_tolerance=TIGHT)
    assert verified(made).accepted
    less = 0.99 * TIGHT
    for body in made["bodies"]:
        body["surface_tolerance"] = less
    excuse = ("findings", 0, "certificate", "band", "excuse")
    places = list(numbers(made["findings"][0]["certificate"]["band"]["excuse"], excuse))
    assert len(places) > 20
    for path in places:
        value: Any = made
        for key in path:
            value = value[key]
        for other in (value, 0, -value, value + 1, value * 0.5, value * 1.01 + 1e-3):
            assert not verified(put(made, path, other)).accepted, (path, other)


def test_a_ball_shows_that_a_body_is_thicker_than_its_surface_is_off(tmp_path: Path) -> None:
    made = made_of(tmp_path, unit_box(), wedge(), surface_tolerance=TIGHT)
    excuse = ("findings", 0, "certificate", "band", "excuse")
    for body, (key, other) in (
        ("a", ("radius", TIGHT)),
        ("a", ("radius", 0.51)),
        ("b", ("radius", 0.75)),
        ("a", ("centre", [0.5, 0.5, 1.0])),
        ("b", ("centre", [0.5, 0.5, 0.5])),
    ):
        assert not verified(put(made, (*excuse, body, key), other)).accepted, (body, key)


def test_nothing_excuses_what_passes_through_or_is_all_error(tmp_path: Path) -> None:
    """What the search refuses is refused by the checker, with an excuse that shows all else."""
    cases = {
        "passes through": (PLATE, SPIKE, 0.0625 - 2.0**-10),
        "thicker": (box((-1, -1, 0.9), (2, 2, 1.0)), wedge(0.0625), 0.0625),
        "reaches deep": (joined(moved(FINNED[0], 3.0), FINNED[1]), BLOCK, 0.02),
    }
    for why, (a, b, off) in cases.items():
        made = made_of(tmp_path, a, b, surface_tolerance=off)
        (finding,) = made["findings"]
        assert finding["relation"] == "penetrating"
        paths = write(tmp_path, a=a, b=b)
        report = check(load_scene(paths), Settings(certificate=True, tolerance=0.0))
        forged = forged_excuse(made, report.findings[0].certificate is not None, off, paths)
        assert not verified(forged).accepted
        assert why in str(verified(forged).findings[0].reason)


def forged_excuse(made: Json, certified: bool, off: float, paths: list[Path]) -> Json:
    """A report that calls its overlap explained, with cells that show how thin it is."""
    from msgspec import to_builtins

    from satcheck import core
    from satcheck.audit.body import PlacedBody, SharedMesh
    from satcheck.audit.stages.certificate.cells import cells

    assert certified
    settings = Settings(surface_tolerance=off)
    placed = [PlacedBody(b, SharedMesh(b.file, settings)) for b in load_scene(paths).bodies]
    surfaces = [body.surface() for body in placed]
    balls = []
    for surface in surfaces:
        ball = core.search_thickness(surface, surface, width=0.01, work=10**8)
        balls.append({"centre": list(ball.centre or (0, 0, 0)), "radius": ball.radius})
    proof = core.search_thickness(
        *surfaces, width=0.0, work=10**9, less_a=off, less_b=off, limit=0.0, prove=True
    ).proof
    assert proof is not None
    shown = to_builtins(cells(proof))
    forged = copy.deepcopy(made)
    finding = forged["findings"][0]
    finding["relation"], finding["severity"] = "touching", "note"
    finding["certificate"]["band"] = {
        "excuse": {"a": balls[0], "b": balls[1], "cells": json.loads(json.dumps(shown))}
    }
    return forged


@pytest.mark.parametrize("weight", [5e-324, 1.0, 1e308])
def test_weights_of_any_size_excuse_no_deep_overlap(tmp_path: Path, weight: float) -> None:
    """A box reaches 1/4 into another one, 25 times as deep as the touch band is wide."""
    made = made_of(
        tmp_path, unit_box(), box((0.75, 0.25, 0.25), (1.25, 0.75, 0.75)), tolerance=0.01
    )
    (finding,) = made["findings"]
    assert finding["relation"] == "penetrating"
    cells = {
        "origin": [0.0, 0.0, 0.0],
        "low": [0.75, 0.25, 0.25],
        "high": [1.0, 0.75, 0.75],
        "patches": [
            {"kind": "face", "body": "a", "triangles": [10, 11]},
            {"kind": "face", "body": "b", "triangles": [8, 9]},
        ],
        "cells": [6],
        "at": [],
        "cuts": [],
        "sums": [[[0, weight], [1, weight]]],
    }
    balls = {
        "a": {"centre": [0.5, 0.5, 0.5], "radius": 0.4},
        "b": {"centre": [1.0, 0.5, 0.5], "radius": 0.2},
    }
    finding.update(relation="touching", severity="note")
    finding["certificate"]["band"] = {"excuse": {**balls, "cells": cells}}
    found = verified(made).findings[0]
    assert (found.outcome, found.reason) == (
        "rejected",
        "a cell is not shown to be as thin as that",
    )
