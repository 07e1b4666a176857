"""A against B and B against A: one answer, mirrored."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satcheck import core
from satcheck.audit import Settings, check
from satcheck.report.report import Finding
from tests.audit.shapes import bracket, moved, scene_of
from tests.hard_cases import mesh_families
from tests.hard_cases.case import Vertices
from tests.hard_cases.families import angles, contact, gaps, sizes
from tests.hard_cases.mesh_case import MIRRORED

ALIKE = ("depth", "depth_bounds", "distance", "tolerance", "severity", "quality")


def hull(points: Vertices) -> Any:
    faces = np.array([[0, 1, 2]], dtype=np.int64)
    found = core.Geometry(core.Mesh(np.array(points), faces), False).hull()
    return [tuple(p) for p in found.vertices.tolist()], [tuple(t) for t in found.triangles.tolist()]


def asked(folder: Path, a: Any, b: Any, settings: Settings) -> Finding:
    (finding,) = check(scene_of(folder, a=a, b=b), settings).findings
    return finding


def expect_mirrored(folder: Path, a: Any, b: Any, settings: Settings, name: str) -> None:
    one, other = asked(folder, a, b, settings), asked(folder, b, a, settings)
    assert one.relation == MIRRORED.get(other.relation, other.relation), name
    assert one.relation != "indeterminate", one.reason
    for key in ALIKE:
        assert getattr(one, key) == getattr(other, key), (name, key)
    if one.normal is not None:
        assert one.normal == tuple(0.0 - c for c in other.normal or ()), name


@pytest.mark.parametrize("family", [angles, contact, gaps, sizes])
def test_convex_pairs(tmp_path: Path, family: Any) -> None:
    draw = random.Random(3)
    for pair in family.cases(3):
        stone = pair.name.startswith("stone of 1e-09 in the middle of 1e+09")
        is_solid = min(len(set(pair.a)), len(set(pair.b))) > 3 and set(pair.a) != set(pair.b)
        if not is_solid or not (stone or draw.random() < 0.15):
            continue
        settings = Settings(tolerance=draw.choice((None, 1e-9)), clearance=0.5)
        expect_mirrored(tmp_path, hull(pair.a), hull(pair.b), settings, pair.name)


@pytest.mark.parametrize("family", mesh_families.FAMILIES)
def test_meshes(tmp_path: Path, family: Any) -> None:
    draw = random.Random(3)
    for pair in family.cases(3):
        if draw.random() < 0.15 or pair.name.startswith("rod through the wall of a ring, mixed"):
            settings = Settings(tolerance=draw.choice((None, 1e-9, 0.05)), budget=0.1)
            a = (pair.a.vertices, pair.a.triangles)
            b = (pair.b.vertices, pair.b.triangles)
            expect_mirrored(tmp_path, a, b, settings, pair.name)


@pytest.mark.parametrize(("x", "y"), [(1.0, 1.0), (-1.5, 3.0), (3.0, -0.5), (0.25, 0.5)])
def test_outlines_in_a_plane(tmp_path: Path, x: float, y: float) -> None:
    """Two Ls that are hooked into each other, one of them upside down."""
    points, faces = moved(bracket(), x, y, 0)
    upturned = [(7.0 - u, 5.0 - v, w) for u, v, w in points], faces
    settings = Settings(planar="xy", budget=0.1)
    expect_mirrored(tmp_path, bracket(), upturned, settings, f"{x}, {y}")
