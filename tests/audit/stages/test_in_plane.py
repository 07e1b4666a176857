"""Checks in a plane against truth in the plane."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from satcheck.audit import Finding, Settings, check
from satcheck.core import Mesh, Surface
from satcheck.core.errors import SatcheckError
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box, Sphere
from satcheck.report.judge import EXACT_WIDTH
from satcheck.scene import Body, Scene, load_scene
from satcheck.scene.inspect import shape_file
from satcheck.scene.planar.flat_scene import flat_scene
from satcheck.scene.rules import Rule, Selector
from tests.oracles.exact_polygons import convex, signed_square
from tests.oracles.free_directions import along, is_free
from tests.scene.planar.flat import Corners, scene, sheet

SAMPLE_MESHES = Path(__file__).resolve().parents[3] / "sample_meshes"

# Comparing lengths that two methods got from coordinates below 8: an ulp of 8 for each operation of
# either, of which there are fewer than 32.
ROUNDING = 32 * 2.0**-50


def ask(meshes: Scene, plane: str = "xy", **settings: object) -> Finding:
    asked = Settings(planar=plane, tolerance=0.0, depth=True, **settings)  # type: ignore[arg-type]
    (finding,) = check(meshes, asked).findings
    return finding


def polygon(rng: np.random.Generator, corners: int, about: tuple[float, float]) -> Corners:
    """Convex: corners on a circle. Multiples of 1/1024, so that touching happens."""
    angles = np.sort(rng.uniform(0, 2 * math.pi, corners))
    x, y = 2 * np.cos(angles) + about[0], 2 * np.sin(angles) + about[1]
    return [(round(p * 1024) / 1024, round(q * 1024) / 1024) for p, q in zip(x, y, strict=True)]


def test_convex_polygons_agree_with_rational_arithmetic() -> None:
    """Depth too: of the polygons by their edges, and found on the prisms over them."""
    rng = np.random.default_rng(3)
    seen = set()
    for _ in range(150):
        a = polygon(rng, int(rng.integers(3, 9)), (0.0, 0.0))
        b = polygon(rng, int(rng.integers(3, 9)), tuple(rng.uniform(-3, 3, 2)))
        if not (convex(a) and convex(b)):  # after rounding
            continue
        found = ask(scene(sheet(a), sheet(b)))
        square = float(signed_square(np.array(a), np.array(b)))
        expected = {"separated" if square > 0 else "touching"}
        if square < 0:
            expected = {"penetrating", "contains", "inside"}
            # As wide as the interval of an exact figure may be.
            assert found.depth == pytest.approx(math.sqrt(-square), rel=EXACT_WIDTH)
            assert found.mtv is not None
            assert found.mtv[2] == 0.0
            assert found.mtv_verified
        assert found.exact_relation in expected
        seen.add(found.exact_relation)
    assert {"separated", "penetrating"} <= seen


def star(rng: np.random.Generator, spikes: int, about: tuple[float, float]) -> Corners:
    """Star-shaped about a point of its inside, and in general not convex."""
    angles = np.arange(spikes) * 2 * math.pi / spikes
    radii = rng.uniform(0.4, 2.0, spikes)
    x, y = radii * np.cos(angles) + about[0], radii * np.sin(angles) + about[1]
    return [(round(p * 64) / 64, round(q * 64) / 64) for p, q in zip(x, y, strict=True)]


def sheet_about(corners: Corners, about: tuple[float, float]) -> Mesh:
    count = len(corners)
    fan = [(count, k, (k + 1) % count) for k in range(count)]
    return sheet([*corners, about], fan)


def side(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> int:
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in p] for p in (a, b, c))
    value = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (value > 0) - (value < 0)


def cross(a: Corners, b: Corners) -> bool:
    """Whether two edges cross in their inner points."""
    return any(
        side(p, q, r) * side(p, q, s) < 0 and side(r, s, p) * side(r, s, q) < 0
        for p, q in pairwise([*a, a[0]])
        for r, s in pairwise([*b, b[0]])
    )


def edges_meet(a: Corners, b: Corners) -> bool:
    def between(p: tuple[float, float], q: tuple[float, float], r: tuple[float, float]) -> bool:
        inside = all(min(u, v) <= w <= max(u, v) for u, v, w in zip(p, q, r, strict=True))
        return side(p, q, r) == 0 and inside

    return cross(a, b) or any(
        between(p, q, r) or between(p, q, s) or between(r, s, p) or between(r, s, q)
        for p, q in pairwise([*a, a[0]])
        for r, s in pairwise([*b, b[0]])
    )


def holds(a: Corners, point: tuple[float, float]) -> bool:
    """For points that lie on no edge: parity of the edges to the right, exactly."""
    x, y = point
    hits = 0
    for (px, py), (qx, qy) in pairwise([*a, a[0]]):
        if (py > y) != (qy > y):
            up = side((px, py), (qx, qy), (x, y))
            hits += up > 0 if qy > py else up < 0
    return hits % 2 == 1


def test_stars_agree_with_exact_crossings() -> None:
    rng = np.random.default_rng(11)
    seen = set()
    for _ in range(80):
        about = tuple(np.round(rng.uniform(-2.5, 2.5, 2) * 64) / 64)
        small = rng.uniform() < 0.3
        a = star(rng, 9, (0.0, 0.0))
        b = star(rng, 7, (0.0, 0.0))
        if small:
            b = [(x / 8, y / 8) for x, y in b]
        b = [(x + about[0], y + about[1]) for x, y in b]
        found = ask(scene(sheet_about(a, (0.0, 0.0)), sheet_about(b, about)), width=0.5)
        if cross(a, b):
            assert found.exact_relation == "penetrating"
        elif edges_meet(a, b):
            assert found.exact_relation in ("touching", "penetrating")
        elif holds(a, b[0]):
            assert found.exact_relation == "contains"
        elif holds(b, a[0]):
            assert found.exact_relation == "inside"
        else:
            assert found.exact_relation == "separated"
        if found.depth is not None:
            assert found.mtv is not None
            assert found.mtv[2] == 0.0
            assert found.mtv_verified
        seen.add(found.exact_relation)
    assert {"separated", "penetrating", "contains"} <= seen


SQUARE = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]


@pytest.mark.parametrize(
    ("shift", "relation", "depth"),
    [
        ((2.0, 0.0), "touching", None),
        ((2.0, 2.0), "touching", None),
        ((0.0, 0.0), "coincident", 2.0),
        ((1.5, 1.0), "penetrating", 0.5),
        ((math.nextafter(2.0, 3.0), 0.0), "separated", None),
        ((math.nextafter(2.0, 0.0), 0.0), "penetrating", 2.0 - math.nextafter(2.0, 0.0)),
    ],
)
def test_squares(shift: tuple[float, float], relation: str, depth: float | None) -> None:
    other = [(x + shift[0], y + shift[1]) for x, y in SQUARE]
    found = ask(scene(sheet(SQUARE), sheet(other)))
    assert (found.exact_relation, found.depth) == (relation, depth)


@pytest.mark.parametrize(("plane", "relation"), [("xy", "contains"), ("yz", "touching")])
def test_bodies_that_only_touch_in_space_may_overlap_in_a_plane(plane: str, relation: str) -> None:
    """A post that stands on a plate."""
    plate = mesh_of(Box((8.0, 8.0, 1.0)))
    post = mesh_of(Box((1.0, 1.0, 6.0))).translated((0.0, 0.0, 3.5))
    assert ask(scene(plate, post), plane).exact_relation == relation


@pytest.mark.parametrize("plane", ["xy", "yz", "xz"])
def test_the_way_out_lies_in_the_plane(plane: str) -> None:
    a, b = mesh_of(Box((1.0, 2.0, 4.0))), mesh_of(Box((1.0, 2.0, 4.0)))
    found = ask(scene(a, b.translated((0.5, 1.25, 2.5))), plane)
    axis = "xyz".index(({"x", "y", "z"} - set(plane)).pop())
    assert found.mtv is not None
    assert found.mtv[axis] == 0.0
    assert found.depth == min(
        d for d, name in ((0.5, "x"), (0.75, "y"), (1.5, "z")) if name in plane
    )


@pytest.mark.parametrize("plane", ["xy", "yz", "xz"])
def test_deep_outlines_have_narrow_intervals(plane: str) -> None:
    """Thousands of edges, concave and with holes; no sampled way out in the plane is shorter."""
    paths = [str(SAMPLE_MESHES / name) for name in ("kettle.obj", "snowflake.obj")]
    scene = load_scene(paths)
    (found,) = check(scene, Settings(planar=plane, depth=True)).findings
    assert found.depth_bounds is not None
    assert found.mtv is not None
    lower, upper = found.depth_bounds
    assert upper - lower <= 0.01 * upper
    across = "xyz".index(({"x", "y", "z"} - set(plane)).pop())
    assert found.mtv[across] == 0.0
    a, b = (body.file.mesh for body in flat_scene(scene, plane).bodies)
    other = Surface(b, True)
    assert is_free(a, other, found.mtv)
    for k in range(32):
        way = [math.cos(k * math.pi / 16), math.sin(k * math.pi / 16)]
        way.insert(across, 0.0)
        for share in (0.25, 0.5, 0.75, 1.0):
            t = along((way[0], way[1], way[2]), share * lower * (1 - 1e-12))
            assert not is_free(a, other, t)


def test_convex_outlines_are_settled_by_their_boxes_or_hulls() -> None:
    far = [(x + 2.5, y + 0.5) for x, y in SQUARE]
    diamond = [(4.1, 1.0), (6.0, 3.0), (4.1, 5.0), (2.2, 3.0)]
    for other, stages in ((far, ["aabb"]), (diamond, ["aabb", "obb", "hull"])):
        triangle = [(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)]
        found = ask(scene(sheet(triangle if other is diamond else SQUARE), sheet(other)))
        assert [stage.stage for stage in found.plan] == stages
        assert found.exact_relation == "separated"


def test_seen_edge_on_is_unreadable() -> None:
    report = check(
        scene(sheet(SQUARE), mesh_of(Box((1.0, 1.0, 1.0)))), Settings(planar="xz", tolerance=0.0)
    )
    assert [finding.relation for finding in report.findings] == ["indeterminate"]
    assert [issue.code for issue in report.issues if issue.severity == "error"] == ["no-outline"]


@pytest.mark.parametrize("asked", ["volume", "contacts", "cross_check"])
def test_what_is_about_space_is_refused(asked: str) -> None:
    with pytest.raises(SatcheckError, match="planar"):
        Settings(planar="xy", **{asked: True})  # type: ignore[arg-type]


def test_a_volume_in_a_plane_is_refused() -> None:
    rule = Rule(a=Selector("a"), b=Selector("b"), max_volume=1.0, where="cell.toml:3")
    flat = replace(scene(sheet(SQUARE), sheet(SQUARE)), rules=(rule,))
    with pytest.raises(SatcheckError, match=r"cell\.toml:3: max_volume"):
        check(flat, Settings(planar="xy"))


def ball(id_: str, radius: float, transform: tuple[float, ...]) -> Body:
    shape = Sphere(radius)
    return Body(id_, id_, shape_file(shape, "scene.toml"), transform, shape=shape)


def moved(x: float, y: float, scale: float = 1.0) -> tuple[float, ...]:
    return (scale, 0, 0, x, 0, scale, 0, y, 0, 0, scale, 0, 0, 0, 0, 1)


@pytest.mark.parametrize("overlap", [1e-3, 1e-4, 1e-5])
def test_no_ball_is_apart_by_its_polygon_alone(overlap: float) -> None:
    """Between two corners the polygons leave a gap where the discs overlap."""
    step = math.pi / 256
    apart = 2.0 - overlap
    bodies = (
        ball("a", 1.0, moved(0.0, 0.0)),
        ball("b", 1.0, moved(apart * math.cos(step), apart * math.sin(step))),
    )
    (found,) = check(Scene("discs", None, bodies), Settings(planar="xy")).findings
    assert found.relation in ("penetrating", "touching")
    assert overlap <= found.tolerance or found.relation == "penetrating"
    assert found.tolerance < 1e-3


def test_a_distant_body_widens_no_touch_band() -> None:
    """It makes all prisms higher, which says nothing of the size of the others."""
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    right = [(x + 0.98, y) for x, y in corners]
    far = [(x * 1e4, y * 1e4 + 100) for x, y in corners]
    two, three = scene(sheet(corners), sheet(right)), scene(*map(sheet, (corners, right, far)))
    found = [
        check(_written_coarsely(one), Settings(planar="xy")).findings[0] for one in (two, three)
    ]
    assert [one.relation for one in found] == ["penetrating", "penetrating"]
    assert found[0].tolerance == found[1].tolerance == 1e-3 * math.sqrt(2)


def _written_coarsely(flat: Scene) -> Scene:
    coarse = [replace(body, file=replace(body.file, resolution=0.01)) for body in flat.bodies]
    return replace(flat, bodies=tuple(coarse))


@pytest.mark.parametrize("scale", [1e60, 1e-200])
def test_a_body_that_cannot_be_placed_costs_its_own_pairs(scale: float) -> None:
    bodies = (
        ball("a", 1.0, moved(0.0, 0.0)),
        ball("b", 1.0, moved(0.0, 0.0, scale)),
        replace(ball("c", 1.0, moved(1.0, 0.0)), static=True),
    )
    report = check(Scene("discs", None, bodies), Settings(planar="xy"))
    relations = {(one.a, one.b): one.relation for one in report.findings}
    assert relations == {
        ("a", "b"): "indeterminate",
        ("a", "c"): "penetrating",
        ("b", "c"): "indeterminate",
    }


def test_a_static_body_without_outline_stays_static() -> None:
    on_edge = sheet([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 1.0)], [(0, 1, 3), (1, 2, 3)])
    flat = scene(on_edge, on_edge, on_edge)
    bodies = tuple(replace(body, static=body.id != "a") for body in flat.bodies)
    report = check(replace(flat, bodies=bodies, check_static=False), Settings(planar="yz"))
    assert [(one.a, one.b) for one in report.findings] == [("a", "b"), ("a", "c")]
