"""The lower end of a concave depth: covers of all shorter translations, and what is none."""

from __future__ import annotations

import json
import math
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from msgspec import ValidationError, convert

from satcheck.audit.certify.cover import cover
from satcheck.report.certificate import Cover
from satcheck.report.report import plain
from satcheck.verify import Rejected
from satcheck.verify.depth import depth_is_at_least
from satcheck.verify.pairs import Pair
from satcheck.verify.world import Exact, World, lattice
from tests.audit.shapes import Mesh, bracket, moved, unit_box, write
from tests.verify.honest import document
from tests.verify.reports import Json, pieces, turned, verified

# name: A, B, the depth
DEEP: dict[str, tuple[Mesh, Mesh, float]] = {
    "a box in an arm": (bracket(), unit_box(5.5, 0.5, 1.0), 0.5),
    "a box across the notch": (bracket(), unit_box(1.5, 1.5, 1.0, edge=2.0), math.sqrt(0.5)),
    "one of two boxes": (pieces(unit_box(), unit_box(8.0)), unit_box(0.75, 0.25, 0.125), 0.25),
    "brackets": (bracket(), moved(bracket(), 5.0, 1.0, 1.0), 1.0),
}


def pair_of(a: Mesh, b: Mesh) -> Pair:
    worlds = [world_of(mesh) for mesh in (a, b)]
    k = max(world.lattice for world in worlds)
    first, second = (Exact(world, k) for world in worlds)
    return Pair(first, second, False)


def world_of(mesh: Mesh) -> World:
    import numpy as np

    points, faces = mesh
    fans = [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]
    return World(np.array(points, dtype=float), np.array(fans, dtype=np.int64), solid=True)


@pytest.mark.parametrize("name", DEEP)
def test_a_report_proves_its_lower_end(name: str, tmp_path: Path) -> None:
    a, b, depth = DEEP[name]
    made = document(write(tmp_path, a=a, b=b), depth=True)
    finding = made["findings"][0]
    assert finding["depth_bounds"][0] <= depth <= finding["depth_bounds"][1]
    assert finding["depth_bounds"][0] > 0.98 * depth
    found = verified(made)
    assert found.accepted
    assert found.findings[0].depth
    assert "findings[].depth_bounds" not in {one.field for one in found.not_covered}


@pytest.mark.parametrize("name", DEEP)
def test_no_cover_is_found_beyond_the_depth(name: str) -> None:
    a, b, depth = DEEP[name]
    pair = pair_of(a, b)
    assert cover(pair, Fraction(depth) * 99 / 100) is not None
    if depth != math.sqrt(0.5):  # shorter translations, not those as long
        assert cover(pair, Fraction(depth)) is not None
    assert cover(pair, Fraction(depth) * 101 / 100) is None


@pytest.mark.parametrize("name", DEEP)
def test_a_cover_of_less_is_none_of_more(name: str) -> None:
    a, b, depth = DEEP[name]
    pair = pair_of(a, b)
    made = cover(pair, Fraction(depth) * 127 / 128)
    assert made is not None
    depth_is_at_least(made, pair.a, pair.b, Fraction(depth) * 127 / 128)
    for more in (Fraction(1, 1000), Fraction(1, 2), Fraction(5)):
        with pytest.raises(Rejected):
            depth_is_at_least(made, pair.a, pair.b, Fraction(depth) + more)


def changed(made: Json) -> Any:
    """Covers with one number of it changed, dropped or added."""
    for key in ("cubes", "pairs"):
        for place in range(len(made[key])):
            other = json.loads(json.dumps(made))
            del other[key][place]
            yield other
    for place, leaf in enumerate(made["cubes"]):
        for false in {-2, -1, 0, 1, len(made["pairs"])} - {leaf}:
            other = json.loads(json.dumps(made))
            other["cubes"][place] = false
            yield other
    yield {**made, "cubes": [*made["cubes"], 0]}
    yield {**made, "cubes": []}


def test_what_is_changed_in_a_cover_proves_no_more_than_is_true() -> None:
    """Beyond the depth nothing is accepted, whatever the cover says."""
    a, b, depth = DEEP["a box across the notch"]
    pair = pair_of(a, b)
    made = plain(cover(pair, Fraction(depth) * 15 / 16))
    for other in changed(made):
        with pytest.raises((Rejected, ValidationError)):
            depth_is_at_least(convert(other, Cover), pair.a, pair.b, Fraction(depth) * 129 / 128)


def test_a_pinched_body_is_free_where_its_surfaces_only_cross() -> None:
    """Two boxes that share an edge, put into the two corners that two others leave free: every
    plane of one body crosses planes of the other there, and no interior is common."""
    a = pieces(unit_box(0.0, 0.0, 0.0, edge=2.0), unit_box(-2.0, -2.0, 0.0, edge=2.0))
    b = pieces(unit_box(-2.0, 0.0, 0.0, edge=2.0), unit_box(0.0, -2.0, 0.0, edge=2.0))
    for depth in (Fraction(1, 1 << 20), Fraction(1, 4), Fraction(1)):
        assert cover(pair_of(a, b), depth) is None
    # Moved a little it overlaps, and moved back it does not.
    assert cover(pair_of(moved(a, 0.25, 0.0, 0.0), b), Fraction(3, 10)) is None


def test_a_wall_of_no_thickness_shows_nothing() -> None:
    a = pieces(unit_box(8.0), unit_box(), turned(unit_box()))
    pair = pair_of(a, unit_box(0.5, 0.5, 0.5))
    assert cover(pair, Fraction(1, 8)) is None
    every = [(s, t) for s in range(len(pair.a.world.triangles)) for t in range(12)]
    for number in range(len(every)):
        with pytest.raises(Rejected):
            depth_is_at_least(Cover((every[number],), (0,)), pair.a, pair.b, Fraction(1, 1 << 30))


def test_the_lattice_is_that_of_both() -> None:
    assert lattice(world_of(unit_box(0.125)).vertices) == 3
