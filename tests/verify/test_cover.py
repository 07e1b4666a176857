"""The lower end of a concave depth: covers of all shorter translations, and what is none."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from msgspec import ValidationError, convert
from msgspec.structs import replace

from satcheck.audit.stages.certificate.cells import cover
from satcheck.core import Mesh as CoreMesh
from satcheck.core import Surface
from satcheck.report.certificate import Cover, Region
from satcheck.report.report import plain
from satcheck.verify import Rejected
from satcheck.verify.depth import FAR, _is_in_solid, depth_is_at_least
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
    return Pair(first, second)


def world_of(mesh: Mesh) -> World:
    points, faces = mesh
    fans = [(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)]
    return World(np.array(points, dtype=float), np.array(fans, dtype=np.int64), solid=True)


def cover_of(a: Mesh, b: Mesh, depth: float) -> Cover | None:
    worlds = world_of(a), world_of(b)
    surfaces = [Surface(CoreMesh(world.vertices, world.triangles), True) for world in worlds]
    return cover(*surfaces, depth, 20_000_000)


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
    assert cover_of(a, b, depth * 0.99) is not None
    assert cover_of(a, b, depth * 1.01) is None


@pytest.mark.parametrize("name", DEEP)
def test_a_cover_of_less_is_none_of_more(name: str) -> None:
    a, b, depth = DEEP[name]
    pair, shorter = pair_of(a, b), depth * 127 / 128
    made = cover_of(a, b, shorter)
    assert made is not None
    depth_is_at_least(made, pair.a, pair.b, shorter)
    for more in (depth / 16, depth, 8 * depth):
        with pytest.raises(Rejected):
            depth_is_at_least(made, pair.a, pair.b, shorter + more)


@pytest.mark.parametrize("name", DEEP)
def test_far_from_the_origin_a_cover_is_found_too(name: str) -> None:
    a, b, depth = DEEP[name]
    away = 2.0**20, -(2.0**21), 2.0**19
    a, b = moved(a, *away), moved(b, *away)
    made = cover_of(a, b, depth * 127 / 128)
    assert made is not None
    assert any(made.origin)
    depth_is_at_least(made, pair_of(a, b).a, pair_of(a, b).b, depth * 127 / 128)


def places_of(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, dict | list):
        yield path
        for key, member in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places_of(member, (*path, key))
    else:
        yield path


def changed(made: Json) -> Iterator[Any]:
    """Covers with one number of it changed, or one member of a list dropped or doubled."""
    for path in places_of(made):
        if not path:
            continue
        for change in CHANGES:
            other = json.loads(json.dumps(made))
            holder = other
            for key in path[:-1]:
                holder = holder[key]
            if change(holder, path[-1]):
                yield other


def is_other(holder: Any, key: Any) -> bool:
    value = holder[key]
    if isinstance(value, int):
        holder[key] = value + 1
    elif isinstance(value, float):
        holder[key] = 2 * value + 0.5
    return isinstance(value, int | float)


def is_less(holder: Any, key: Any) -> bool:
    value = holder[key]
    if isinstance(value, int):
        holder[key] = value - 1
    elif isinstance(value, float):
        holder[key] = -value
    return isinstance(value, int | float)


def is_dropped(holder: Any, key: Any) -> bool:
    if isinstance(holder, list):
        del holder[key]
    return isinstance(holder, list)


def is_doubled(holder: Any, key: Any) -> bool:
    if isinstance(holder, list):
        holder.insert(key, holder[key])
    return isinstance(holder, list)


CHANGES = (is_other, is_less, is_dropped, is_doubled)


def test_what_is_changed_in_a_cover_proves_no_more_than_is_true() -> None:
    """Beyond the depth nothing is accepted, whatever the cover says."""
    a, b, depth = DEEP["a box across the notch"]
    pair = pair_of(a, b)
    made = plain(cover_of(a, b, depth * 15 / 16))
    for other in changed(made):
        with pytest.raises((Rejected, ValidationError)):
            depth_is_at_least(convert(other, Cover), pair.a, pair.b, depth * 129 / 128)


def test_numbers_of_a_cover_are_needed() -> None:
    """Each claim of a cover that is changed alone ends it: corners of regions that leave a body,
    normals that no longer keep the surface off, facets, parts and the cube around them."""
    a, b, depth = DEEP["a box in an arm"]
    pair, shorter = pair_of(a, b), depth * 127 / 128
    made = cover_of(a, b, shorter)
    assert made is not None
    region = made.sets[0].a
    outside = replace(region, vertices=((1e3, 0.0, 0.0), *region.vertices))
    unseparated = replace(region, normals=((1.0, 0.0, 0.0),))
    turned = tuple(face[::-1] for face in made.sets[0].difference.faces)
    sets = [
        replace(made.sets[0], a=outside),
        replace(made.sets[0], a=unseparated),
        replace(made.sets[0], b=region),
        replace(made.sets[0], difference=replace(made.sets[0].difference, faces=turned)),
        replace(made.sets[0], difference=replace(made.sets[0].difference, faces=turned[1:])),
    ]
    false = [replace(made, sets=(one, *made.sets[1:])) for one in sets]
    false += [replace(made, half=made.half / 4), replace(made, parts=(FAR,) * len(made.parts))]
    false += [replace(made, parts=made.parts[:-1]), replace(made, parts=(*made.parts, FAR))]
    false += [replace(made, parts=(len(made.sets),) * len(made.parts))]
    for cover_ in false:
        with pytest.raises(Rejected):
            depth_is_at_least(cover_, pair.a, pair.b, shorter)


def test_the_outside_of_a_body_is_no_region() -> None:
    """No surface enters the box in the notch, and it lies outside."""
    a, b, depth = DEEP["a box in an arm"]
    made = cover_of(a, b, depth / 2)
    assert made is not None
    notch = [(x, y, z) for x in (2.5, 3.5) for y in (2.5, 3.5) for z in (1.0, 3.0)]
    ways = [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)]
    region = Region(tuple(notch), (*ways, (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)))
    with pytest.raises(Rejected, match="outside"):
        _is_in_solid(region, pair_of(a, b).a, (0.0, 0.0, 0.0))
    with pytest.raises(Rejected, match="no inside"):
        _is_in_solid(replace(region, vertices=tuple(notch[:4])), pair_of(a, b).a, (0.0, 0.0, 0.0))


def test_what_overflows_shows_nothing() -> None:
    a, b, depth = DEEP["a box in an arm"]
    pair, made = pair_of(a, b), cover_of(a, b, depth / 2)
    assert made is not None
    one = made.sets[0]
    for length in (1e308, 1e305):
        long = replace(one.a, normals=((length, length, length), (-length, 0.0, 0.0)))
        with pytest.raises(Rejected, match="too long"):
            depth_is_at_least(replace(made, sets=(replace(one, a=long),)), pair.a, pair.b, 0.25)
    large = replace(made, half=2.0**900, parts=(FAR,))
    with pytest.raises(Rejected, match="digits"):
        depth_is_at_least(large, pair.a, pair.b, 2.0**800)


@pytest.mark.parametrize("exponent", [-350, -300, -270, 0, 300])
def test_facets_bound_a_set_at_every_scale(exponent: int) -> None:
    """Squares of their areas are no floats."""
    a, b, depth = DEEP["a box in an arm"]
    scale = 2.0**exponent
    scaled = [([[scale * c for c in p] for p in points], faces) for points, faces in (a, b)]
    pair, made = pair_of(*scaled), cover_of(a, b, depth / 2)
    assert made is not None

    def region(of_one: Region) -> Region:
        return replace(of_one, vertices=tuple(tuple(scale * c for c in p) for p in of_one.vertices))

    sets = tuple(replace(one, a=region(one.a), b=region(one.b)) for one in made.sets)
    made = replace(made, half=scale * made.half, sets=sets)
    depth_is_at_least(made, pair.a, pair.b, scale * depth / 2)
    with pytest.raises(Rejected):
        depth_is_at_least(replace(made, half=16 * scale, parts=(0,)), pair.a, pair.b, 8 * scale)


@pytest.mark.parametrize("depth", [0.5, 2.0**-500, 2.0**-540, 2.0**-1000, 5e-324])
def test_no_part_at_the_origin_is_far(depth: float) -> None:
    pair, far = pair_of(unit_box(), unit_box(1.0)), Cover((0.0, 0.0, 0.0), 1.0, (), (FAR,))
    with pytest.raises(Rejected, match="leaves out"):
        depth_is_at_least(far, pair.a, pair.b, depth)


def test_a_pinched_body_is_free_where_its_surfaces_only_cross() -> None:
    """Two boxes that share an edge, put into the two corners that two others leave free."""
    a = pieces(unit_box(0.0, 0.0, 0.0, edge=2.0), unit_box(-2.0, -2.0, 0.0, edge=2.0))
    b = pieces(unit_box(-2.0, 0.0, 0.0, edge=2.0), unit_box(0.0, -2.0, 0.0, edge=2.0))
    for depth in (2.0**-20, 0.25, 1.0):
        assert cover_of(a, b, depth) is None
    # Moved a little it overlaps, and moved back it does not.
    assert cover_of(moved(a, 0.25, 0.0, 0.0), b, 0.3) is None


def test_a_wall_of_no_thickness_shows_nothing() -> None:
    a = pieces(unit_box(8.0), unit_box(), turned(unit_box()))
    assert cover_of(a, unit_box(0.5, 0.5, 0.5), 0.125) is None


def test_the_lattice_is_that_of_both() -> None:
    assert lattice(world_of(unit_box(0.125)).vertices) == 3
