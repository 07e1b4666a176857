"""Curved shapes against each other, against convex meshes, against concave ones."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from msgspec.structs import replace

from satcheck import core
from satcheck.audit import Settings, check
from satcheck.audit.body import PlacedBody, SharedMesh
from satcheck.audit.stages import curved
from satcheck.core import Mesh
from satcheck.core.curved.nesting import is_within_hull, shape_holds
from satcheck.core.curved.placed import curved_shape
from satcheck.core.curved.signed import convex_pair
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import Box, Capsule, Cone, Cylinder, Ellipsoid, Primitive, Sphere
from satcheck.scene import Body, Rule, Scene, Selector
from tests.core.curved.bodies import ask, bracket, hollow_box, moved, shape, tilted
from tests.scene.planar.flat import body as mesh_body

# Figures below are sums and differences of coordinates below 8, turned once at most.
ROUNDING = 64 * 2.0**-50
# Bounds of curved shapes close to this fraction of the coordinates (kCurvedGap of the core).
CLOSED = 8 * 1e-11
# Enough for a way out; a search for the least depth in a sheet would spend any budget.
LITTLE = 0.05


@pytest.mark.parametrize(("limit", "severity"), [(None, "error"), (0.125, "error"), (0.25, "note")])
def test_an_overlap_is_proven_where_only_its_kind_is_not(
    limit: float | None, severity: str
) -> None:
    """Two cylinders in one place: which holds the other is not known, how deep they overlap is."""
    bodies = [shape(id_, Cylinder(1.0, 0.2)) for id_ in "ab"]
    rule = Rule(a=Selector("a"), b=Selector("b"), max_depth=limit, severity="error")
    scene = Scene("shapes", None, tuple(bodies), rules=(rule,))
    (found,) = check(scene, Settings(depth=True)).findings
    assert (found.relation, found.quality) == ("penetrating", "estimate")
    assert (found.severity, found.undecided) == (severity, None)
    assert "they overlap" in str(found.reason)


def test_a_gap_is_on_its_side_of_the_tolerance() -> None:
    """The bounds of a gap of 4e-17 are wider than the tolerance: exact signs are not."""
    a, b = shape("a", Sphere(1.0)), shape("b", Sphere(1.0), moved(1.2, 1.6, 0.0))
    found = ask(a, b, clearance=1.0)
    assert (found.relation, found.exact_relation) == ("touching", "separated")
    assert found.distance is not None
    assert 0.0 < found.distance <= found.tolerance
    beyond = ask(a, b, clearance=1.0, tolerance=1e-17)
    assert beyond.relation == "near"
    assert beyond.distance >= 1e-17
    short = ask(a, b, clearance=1e-15, tolerance=0.0)
    assert (short.relation, short.severity) == ("near", "error")
    assert short.distance <= 1e-15


@pytest.mark.parametrize(
    ("x", "relation", "depth"),
    [
        (2.5, "separated", None),
        (2.0, "touching", None),
        (1.5, "penetrating", 0.5),
        (math.nextafter(2.0, 3.0), "separated", None),
        (math.nextafter(2.0, 0.0), "penetrating", 2.0 - math.nextafter(2.0, 0.0)),
    ],
)
def test_spheres_are_decided_to_the_last_digit(
    x: float, relation: str, depth: float | None
) -> None:
    found = ask(shape("a", Sphere(1.0)), shape("b", Sphere(1.0), moved(x, 0, 0)), tolerance=0.0)
    assert found.exact_relation == relation
    if depth is not None:
        assert found.depth == pytest.approx(depth, rel=1e-9)
        assert found.mtv_verified


@pytest.mark.parametrize(
    ("primitive", "transform", "gap"),
    [
        (Sphere(0.5), moved(2.5, 0.0, 2.5), 1.0),
        (Sphere(0.5), moved(-1.0, 0.0, 2.0), 0.5),
        (Capsule(0.25, 1.0), moved(2.5, 0.0, 3.0), 1.25),
        (Cylinder(0.5, 1.0), moved(2.0, 0.0, 3.0), 0.5),
        (Cylinder(0.5, 1.0), tilted(90.0, 2.5, 0.0, 3.0), 1.0),
        (Cone(0.5, 1.0), moved(3.0, 0.0, 2.0), 0.5),
        (Ellipsoid((0.5, 1.0, 0.25)), moved(2.0, 0.0, 2.0), 0.5),
    ],
)
def test_gaps_to_a_concave_mesh(
    primitive: Primitive, transform: tuple[float, ...], gap: float
) -> None:
    """In the notch of the bracket, whose walls are x = 1 and z = 1, and beside it."""
    for found in (
        ask(shape("a", primitive, transform), bracket(), clearance=2.0),
        ask(bracket(), shape("a", primitive, transform), clearance=2.0),
    ):
        assert found.exact_relation == "separated"
        assert found.distance == pytest.approx(gap, abs=CLOSED)
        assert found.witness is not None
        assert found.normal is not None
        for w, v, n in zip(found.witness.b, found.witness.a, found.normal, strict=True):
            assert w - v == pytest.approx(gap * n, abs=CLOSED)


@pytest.mark.parametrize(
    ("primitive", "transform", "depth"),
    [
        (Sphere(0.5), moved(2.5, 0.0, 1.25), 0.25),
        (Capsule(0.25, 1.0), moved(2.5, 0.0, 1.5), 0.25),
        (Cylinder(0.5, 1.0), moved(2.5, 0.0, 1.25), 0.25),
        (Cylinder(0.5, 1.0), tilted(90.0, 2.5, 0.0, 1.25), 0.25),
    ],
)
def test_depth_in_a_concave_mesh(
    primitive: Primitive, transform: tuple[float, ...], depth: float
) -> None:
    for found in (
        ask(shape("a", primitive, transform), bracket()),
        ask(bracket(), shape("a", primitive, transform)),
    ):
        assert found.exact_relation == "penetrating"
        assert found.depth_bounds is not None
        lower, upper = found.depth_bounds
        assert lower - CLOSED <= depth <= upper + CLOSED
        assert upper - lower < 0.02
        assert found.mtv_verified


def test_a_sphere_that_rests_in_the_notch_touches() -> None:
    found = ask(shape("a", Sphere(0.5), moved(1.5, 0.0, 1.5)), bracket(), tolerance=0.0)
    assert found.relation == "touching"


def test_nesting() -> None:
    small, large = shape("s", Sphere(0.25), moved(0.5, 0.0, 0.5)), shape("l", Sphere(9.0))
    assert ask(small, bracket()).exact_relation == "inside"
    assert ask(bracket(), small).exact_relation == "contains"
    assert ask(large, bracket()).exact_relation == "contains"
    assert ask(small, large).exact_relation == "inside"
    assert ask(shape("b", Box((1.0, 1.0, 1.0))), large).exact_relation == "inside"
    box = shape("b", Box((1.0, 1.0, 1.0)))
    assert ask(shape("c", Cylinder(0.25, 0.5)), box).exact_relation == "inside"


def test_a_cavity_is_no_material() -> None:
    assert ask(shape("s", Sphere(0.5)), hollow_box()).exact_relation == "separated"
    assert ask(shape("s", Sphere(1.25)), hollow_box()).exact_relation == "penetrating"
    wall = shape("s", Sphere(0.25), moved(1.5, 0.0, 0.0))
    assert ask(wall, hollow_box()).exact_relation == "inside"


@pytest.mark.parametrize(
    "primitive",
    [
        Sphere(1.0),
        Capsule(0.5, 1.0),
        Cylinder(0.75, 1.5),
        Cone(1.0, 2.0),
        Ellipsoid((1.0, 0.5, 0.75)),
    ],
)
def test_random_poses_against_the_meshes_inside_and_around(primitive: Primitive) -> None:
    """What overlaps the mesh inside overlaps the shape; what misses the one around misses it."""
    from satcheck.core import Surface, mesh_relation
    from satcheck.core.shape_mesh import mesh_around, mesh_of
    from tests.core.curved.bodies import l_bracket

    rng = np.random.default_rng(17)
    target, seen = Surface(l_bracket(), True), set()
    for _ in range(60):
        transform = tilted(rng.uniform(0, 360), *rng.uniform(-2, 5, 3))
        found = ask(shape("a", primitive, transform), bracket(), depth=False).exact_relation
        inner, outer = (
            mesh_relation(Surface(mesh.transformed(transform), True), target).relation
            for mesh in (mesh_of(primitive), mesh_around(primitive))
        )
        if outer == "separated":
            assert found == "separated"
        if inner in ("penetrating", "inside"):
            assert found in ("penetrating", "inside")
        seen.add(found)
    assert {"separated", "penetrating"} <= seen


@pytest.mark.parametrize("swapped", [False, True])
def test_a_shape_that_touches_a_wall_from_within_is_not_said_to_be_inside(swapped: bool) -> None:
    """It lies between the two walls of the hollow box, tangent to both."""
    pair = shape("ball", Sphere(0.5), moved(1.5, 0, 0)), hollow_box()
    found = ask(*(pair[::-1] if swapped else pair))
    assert found.relation == "penetrating"
    assert found.exact_relation == "penetrating"
    assert found.severity == "error"


@pytest.mark.parametrize("radius", [0.125, 0.5])
def test_a_shape_in_a_box_without_a_lid_is_inside_whatever_closes_it(radius: float) -> None:
    box = mesh_of(Box((2.0, 2.0, 2.0)))
    open_box = mesh_body("box", Mesh(box.vertices, box.triangles[:-2].copy()))
    found = ask(shape("ball", Sphere(radius)), open_box)
    assert (found.relation, found.quality) == ("inside", "bounded")
    sheet = ask(shape("ball", Sphere(radius)), open_box, allow_open=True)
    assert (sheet.relation, sheet.quality) == ("separated", "exact")


def test_a_shape_in_a_hole_is_not_decided() -> None:
    """A small ball in the middle of each face of a cube: one face is missing."""
    cube = mesh_of(Box((1.0, 1.0, 1.0)))
    open_cube = mesh_body("cube", Mesh(cube.vertices, np.asarray(cube.triangles)[:-2]))
    middles = [tuple(0.5 * s * (m == axis) for m in range(3)) for axis in range(3) for s in (-1, 1)]
    seen = [ask(shape("ball", Sphere(0.25), moved(*middle)), open_cube) for middle in middles]
    (found,) = [f for f in seen if f.relation == "indeterminate"]
    assert found.severity == "warning"
    assert "the hole of cube" in (found.reason or "")
    assert [f.relation for f in seen].count("penetrating") == 5


def test_a_ball_on_an_open_sheet_touches_it() -> None:
    floor = Mesh(
        np.array([(-4.0, -4.0, 0.0), (4.0, -4.0, 0.0), (4.0, 4.0, 0.0), (-4.0, 4.0, 0.0)]),
        np.array([(0, 1, 2), (0, 2, 3)], dtype=np.uint32),
    )
    found = ask(shape("ball", Sphere(0.5), moved(0.25, 0.5, 0.5)), mesh_body("floor", floor))
    assert (found.relation, found.quality) == ("touching", "exact")
    low = shape("ball", Sphere(0.5), moved(0.25, 0.5, 0.25))
    into = ask(low, mesh_body("floor", floor), budget=LITTLE)
    assert (into.relation, into.severity) == ("penetrating", "error")


def test_a_sheet_within_a_solid_is_no_boundary_to_a_ball() -> None:
    box = mesh_of(Box((4.0, 4.0, 4.0)))
    square = np.array([(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0)])
    first = len(box.vertices)
    triangles = [
        *np.asarray(box.triangles),
        (first, first + 1, first + 2),
        (first, first + 2, first + 3),
    ]
    both = Mesh(np.vstack([box.vertices, square]), np.array(triangles, dtype=np.uint32))
    found = ask(shape("ball", Sphere(0.5)), mesh_body("both", both))
    assert found.severity == "error"
    assert found.exact_relation in ("inside", None)


def test_no_distance_is_taken_from_the_mesh_within_a_shape() -> None:
    """Beside the corner of the notch: boxes within the clearance, triangles beyond it."""
    ball = shape("ball", Sphere(0.5), moved(3.0, 0.0, 3.0))
    found = ask(ball, bracket(), clearance=1.2)
    assert (found.relation, found.distance) == ("separated", None)


@pytest.mark.parametrize("swapped", [False, True])
def test_a_clearance_within_the_bounds_of_a_gap_is_not_decided(swapped: bool) -> None:
    """3e-3 apart: what float64 proves of the gap is much wider than 1e-9 of it."""
    a = shape("a", Cylinder(1.0, 2.0), tilted(54.0, 0.0, 0.0, 0.0))
    b = shape("b", Ellipsoid((1.0, 0.7, 0.4)), tilted(64.0, 0.3, 1.856, 0.4))
    pair = (b, a) if swapped else (a, b)
    placed = [PlacedBody(body, SharedMesh(body.file, Settings())) for body in pair]
    bounds = convex_pair(placed[0], placed[1])
    assert bounds is not None
    assert 0 < bounds.lower < bounds.distance * (1 - 4e-9) < 0.01
    found = ask(*pair, clearance=0.5 * (bounds.lower + bounds.distance))
    assert (found.relation, found.exact_relation) == ("separated", "separated")
    assert (found.severity, found.rule, found.undecided) == ("warning", "clearance", "limit")
    assert ask(*pair, clearance=bounds.lower).undecided is None
    near = ask(*pair, clearance=2 * bounds.upper)
    assert (near.relation, near.severity, near.undecided) == ("near", "error", None)


def finned(*fin: tuple[int, int, int]) -> Body:
    """A box from 0 to 2 with a fin of no thickness beside it, in the plane z = 2."""
    corners = [(x, y, z) for z in (0.0, 2.0) for y in (0.0, 2.0) for x in (0.0, 2.0)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    tips = [(4.0, 0.0, 2.0), (4.0, 2.0, 2.0)]
    mesh = Mesh(np.array(corners + tips), np.array([*faces, *fin], dtype=np.uint32))
    return mesh_body("fin", mesh)


TWINS = ((5, 8, 9), (5, 9, 7), (8, 5, 9), (9, 5, 7))
CROSSWISE = ((5, 8, 9), (5, 9, 7), (8, 5, 7), (8, 7, 9))


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("fin", [TWINS, CROSSWISE])
@pytest.mark.parametrize(
    ("x", "z", "relation"),
    [
        (3.0, 2.0, "penetrating"),
        (2.1, 2.0, "penetrating"),
        (3.0, 2.25, "touching"),
        (3.0, 2.5, "separated"),
    ],
)
def test_a_fin_of_no_thickness_is_material(
    x: float, z: float, relation: str, fin: tuple[tuple[int, int, int], ...], swapped: bool
) -> None:
    pair = shape("ball", Sphere(0.25), moved(x, 1.0, z)), finned(*fin)
    found = ask(*(pair[::-1] if swapped else pair), tolerance=0.0, budget=LITTLE)
    assert (found.relation, found.exact_relation) == (relation, relation)
    if relation == "penetrating":
        assert found.mtv_verified


def test_bounds_that_do_not_close_leave_the_relation_open(monkeypatch: pytest.MonkeyPatch) -> None:
    pair = shape("a", Sphere(1.0)), shape("b", Sphere(1.0), moved(1.5, 0.0, 0.0))
    monkeypatch.setattr(curved, "convex_pair", lambda *_, **__: None)
    found = ask(*pair)
    assert (found.relation, found.severity, found.undecided) == (
        "indeterminate",
        "warning",
        "relation",
    )
    assert "did not close" in (found.reason or "")


def test_the_rounding_of_a_placement_counts_in_depths_and_nesting() -> None:
    turned = shape("capsule", Capsule(0.25, 1.0), tilted(180.0, 2.5, 0.0, 1.5))
    slack = curved_shape(Capsule(0.25, 1.0), tilted(180.0, 2.5, 0.0, 1.5)).slack
    found = ask(turned, bracket())
    assert found.depth_bounds is not None
    assert slack > 0.0
    assert found.depth_bounds[0] <= 0.25 - slack
    outer, body = curved_shape(Sphere(2.0), None), shape("inner", Sphere(1.0))
    inner = PlacedBody(body, SharedMesh(body.file, Settings()))
    assert shape_holds(outer, inner)
    assert inner.curved is not None
    inner.curved = replace(inner.curved, slack=1.0)
    assert shape_holds(outer, inner) is None


def test_the_normal_of_a_sliver_is_not_trusted_to_the_last_digit() -> None:
    """A ball 1e-10 within a box. A face of it is cut so that one triangle is 1e-12 high: its plane
    is known to some 1e-4 of its size only."""
    ball, box = curved_shape(Sphere(1.0 - 1e-10), None), mesh_of(Box((2.0, 2.0, 2.0)))
    assert is_within_hull(ball, box.convex_hull())
    ends = [(-1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (0.0, 1.0 - 1e-12, 1.0)]
    vertices = np.concatenate((box.vertices, ends))
    faces = np.concatenate((box.triangles, [np.arange(3)[::-1] + box.vertex_count]))
    cut = SimpleNamespace(vertices=vertices, triangles=faces)
    assert is_within_hull(ball, cast("core.Polytope", cut)) is None
