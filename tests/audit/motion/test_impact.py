"""The first time of impact against closed forms and rational truth, and against dense sampling.

The interval is wider than rounding by as much as A moves while it sinks in by the touch band.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from msgspec.structs import replace

from satcheck.audit.draft import Draft
from satcheck.audit.finding import examine
from satcheck.audit.motion.moving_pair import SHORTEST_STEP, overlaps
from satcheck.scene.motion import PosePath, Rotation, Translation, Waypoint
from tests.audit.motion.pairs import first_impact, hull_of, moving
from tests.audit.shapes import box, bracket, moved, unit_box
from tests.oracles.random_shapes import random_direction, random_hull, random_quaternion
from tests.oracles.translated_pair import overlap_times

ORIGIN = (0.0, 0.0, 0.0)
Z = (0.0, 0.0, 1.0)


def impact_of(a, path_a, b, path_b=None, **settings):
    settings.setdefault("tolerance", 0.0)
    pair = moving(a, path_a, b, path_b, **settings)
    return pair, first_impact(pair)


def assert_hit(pair, impact, truth, speed):
    """speed: how fast the bodies sink into each other. The probes after the contact double their
    steps, and the last of them is halved down again, so that both ends are known to the shortest
    step; between them the bodies sink in by the touch band."""
    assert impact.upper is not None
    width = 2 * SHORTEST_STEP + 2 * pair.tolerance / speed
    assert impact.lower <= truth <= impact.upper
    assert impact.upper - impact.lower <= width
    assert overlaps(pair.found_at(impact.upper))


@pytest.mark.parametrize("tolerance", [0.0, 1e-6, 1e-3])
def test_box_to_box(tolerance):
    path = Translation((10.0, 0.0, 0.0))
    pair, impact = impact_of(unit_box(), path, unit_box(3.0), tolerance=tolerance)
    assert_hit(pair, impact, 0.2, 10.0)


def test_both_move():
    to_each_other = Translation((1.0, 0.0, 0.0)), Translation((-3.0, 0.0, 0.0))
    pair, impact = impact_of(unit_box(), to_each_other[0], unit_box(3.0), to_each_other[1])
    assert_hit(pair, impact, 0.5, 4.0)


@pytest.mark.parametrize("concave", [False, True])
def test_a_needle_through_a_thin_plate(concave):
    """The plate is crossed in 1e-7 of the motion."""
    needle = box((0, 0, 0), (1e-3, 1e-3, 1.0))
    plate = box((-5, -5, 5), (5, 5, 5 + 1e-6))
    if (
        concave
    ):  # the bracket lies in z = 0 .. 4: made a sheet at z = 5, and the needle goes through
        points, faces = bracket()
        plate = [(x - 1, y - 1, 5 + z * 0.25e-6) for x, y, z in points], faces
    pair, impact = impact_of(needle, Translation((0.0, 0.0, 10.0)), plate)
    assert pair.convex is not concave
    assert_hit(pair, impact, 0.4, 10.0)


def blade_and_wedge():
    """The blade's front lies on the x axis; the wedge's near face on the ray at 60 degrees, from
    2.9 on, so that only the tip of the blade can reach it, and all of it at once."""
    blade = box((0, -0.1, 0), (3, 0, 1))
    inner, outer = 2.9 * np.array([0.5, math.sqrt(0.75)]), 3.6 * np.array([0.5, math.sqrt(0.75)])
    back = 3.6 * np.array([math.cos(math.radians(80)), math.sin(math.radians(80))])
    wedge = [(*map(float, p), z) for p in (inner, outer, back) for z in (0.25, 0.75)]
    return blade, hull_of(wedge)


@pytest.mark.parametrize("turns", [1, 5])
def test_a_turning_blade_clips_at_one_angle(turns):
    blade, wedge = blade_and_wedge()
    pair, impact = impact_of(blade, Rotation(ORIGIN, Z, 360.0 * turns), wedge)
    assert_hit(pair, impact, 60.0 / (360.0 * turns), 2 * math.pi * 2.9 * turns)


def test_a_shorter_blade_passes():
    blade, wedge = blade_and_wedge()
    short = [(x * 0.96, y, z) for x, y, z in blade[0]], blade[1]
    _, impact = impact_of(short, Rotation(ORIGIN, Z, 3600.0), wedge)
    assert impact.free
    assert impact.contact is None


def sphere(n, x):
    """Poles on the x axis; the corners are rounded, the poles are exact."""
    ring = [
        (math.cos(p), math.sin(p) * math.cos(q), math.sin(p) * math.sin(q))
        for p in (math.pi * k / n for k in range(1, n))
        for q in (2 * math.pi * k / n for k in range(n))
    ]
    return hull_of([(c[0] + x, c[1], c[2]) for c in [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), *ring]])


def test_spheres_meet_at_their_poles():
    pair, impact = impact_of(sphere(12, 0.0), Translation((8.0, 0.0, 0.0)), sphere(12, 4.0))
    # Near a pole the faces are steep: sinking in by a length takes little more than that length.
    assert_hit(pair, impact, 0.25, 8.0 * math.sin(math.pi / 24))


@pytest.mark.parametrize("seed", range(40))
def test_random_convex_pairs_against_rationals(seed):
    rng = np.random.default_rng(seed)
    a, b = random_hull(rng, 5), random_hull(rng, 6)
    v = random_direction(rng) * rng.uniform(1.0, 8.0)
    a = a - v * rng.uniform(0.0, 1.0) + random_direction(rng) * 0.8
    truth = overlap_times(a, b, v)
    path = Translation(tuple(map(float, v)))
    pair, impact = impact_of(hull_of(a), path, hull_of(b))
    hit = truth is not None and truth[0] < 1 and truth[1] > 0
    if not hit:
        assert impact.free
        return
    assert impact.lower <= truth[0] or impact.lower == impact.upper == 0.0
    assert impact.upper is None or max(truth[0], 0) <= impact.upper <= truth[1]
    # The overlap is missed only where it is never deeper than the band.
    assert impact.upper is not None or pair.tolerance > 1e-3 * float(truth[1] - truth[0])


def grid_body(rng):
    """A box or an L on a grid, so that faces, edges and corners meet often; and boxes it is made
    of, which together have its interior up to their common faces."""
    x, y, z = (int(c) for c in rng.integers(-6, 7, size=3))
    if rng.random() < 0.5:
        high = tuple(
            int(c) + int(s) for c, s in zip((x, y, z), rng.integers(1, 6, size=3), strict=True)
        )
        return box((x, y, z), high), [((x, y, z), high)]
    arms = [((x, y, z), (x + 6, y + 2, z + 4)), ((x, y, z), (x + 2, y + 6, z + 4))]
    return moved(bracket(), x, y, z), arms


def box_overlap(a, b, v):
    """The open interval of t in which the boxes a + t v and b have a common interior, or None."""
    start, end = Fraction(-1), Fraction(2)
    for axis in range(3):
        ahead, behind = b[0][axis] - a[1][axis], b[1][axis] - a[0][axis]
        if v[axis] == 0:
            if not ahead < 0 < behind:
                return None
            continue
        times = sorted((Fraction(ahead, v[axis]), Fraction(behind, v[axis])))
        start, end = max(start, times[0]), min(end, times[1])
    return (start, end) if start < end and start < 1 and end > 0 else None


@pytest.mark.parametrize("seed", range(80))
def test_bodies_on_a_grid_against_rationals(seed):
    """Slides, corners, edges on edges: contact is no impact, and none is left open."""
    rng = np.random.default_rng(seed)
    (a, parts_a), (b, parts_b) = grid_body(rng), grid_body(rng)
    v = [int(c) for c in rng.integers(-6, 7, size=3) * rng.integers(0, 2, size=3)]
    found = [box_overlap(p, q, v) for p in parts_a for q in parts_b]
    truth = min((max(times[0], Fraction(0)) for times in found if times), default=None)
    pair, impact = impact_of(a, Translation(tuple(map(float, v))), b)
    if truth is None:
        assert impact.free
    else:  # along the axis of the first overlap the speed is 1 at least
        width = 2 * SHORTEST_STEP + 2 * pair.tolerance
        assert impact.lower <= truth <= impact.upper <= truth + Fraction(width)


def helix(turns, rise, steps):
    """About z, in legs of less than half a turn."""
    return PosePath(
        tuple(
            Waypoint(
                k / steps,
                (0.0, 0.0, rise * k / steps),
                (
                    0.0,
                    0.0,
                    math.sin(math.pi * turns * k / steps),
                    math.cos(math.pi * turns * k / steps),
                ),
            )
            for k in range(steps + 1)
        )
    )


def test_a_screw():
    """A foot at radius 2 to 3 turns once while it rises by 4. The step has its near face on the ray
    at 90 degrees, where the foot has risen by 1; above 3.5 it has not come by yet."""
    foot = box((2, -0.5, 0), (3, 0, 0.5))
    path = helix(1.0, 4.0, 6)
    pair, impact = impact_of(foot, path, box((-1, 2.25, 1.25), (0, 2.75, 1.75)))
    assert_hit(pair, impact, 0.25, 2 * math.pi * 2)
    _, passed = impact_of(foot, path, box((-1, 2.25, 3.5), (0, 2.75, 4.5)))
    assert passed.free
    _, below = impact_of(foot, path, box((-1, 2.25, 0.0), (0, 2.75, 0.9)))
    assert below.free


@pytest.mark.parametrize(
    "path",
    [
        Translation(ORIGIN),
        Rotation((0.5, 0.5, 0.5), (0.0, 0.0, 2.0), 0.0),
        Rotation((0.5, 0.5, 0.5), Z, 360.0),  # the axis goes through the body
        Rotation((0.5, 0.5, 0.5), (1.0, 1.0, 1.0), -36000.0),
        PosePath((Waypoint(0.0, ORIGIN), Waypoint(1.0, ORIGIN))),
    ],
)
def test_degenerate_motions(path):
    _, impact = impact_of(unit_box(), path, unit_box(1.5))
    assert impact.free
    _, inside = impact_of(unit_box(), path, unit_box(0.25, 0.25, 0.25, edge=0.5))
    assert (inside.lower, inside.upper) == (0.0, 0.0)


def test_a_path_may_start_elsewhere():
    start = Waypoint(0.0, (5.0, 0.0, 0.0))
    path = PosePath((start, Waypoint(1.0, (9.0, 0.0, 0.0))))
    assert impact_of(unit_box(), path, unit_box(0.5))[1].free
    _, impact = impact_of(unit_box(), path, unit_box(5.5))
    assert (impact.lower, impact.upper) == (0.0, 0.0)


def test_more_turns_than_the_budget_allows():
    """Nothing is decided without having been looked at."""
    _, impact = impact_of(unit_box(), Rotation((9.0, 0.0, 0.0), Z, 3.6e8), unit_box(1.0 + 1e-6))
    assert not impact.free
    assert impact.upper is not None or "budget" in impact.reason or "not proven" in impact.reason


def random_path(rng, kind):
    if kind == "translation":
        return Translation(tuple(map(float, random_direction(rng) * rng.uniform(0.5, 9.0))))
    if kind == "rotation":
        point, axis = rng.normal(size=3) * 2, random_direction(rng)
        return Rotation(tuple(map(float, point)), tuple(map(float, axis)), rng.uniform(-700, 700))
    stops = [(*map(float, rng.normal(size=3) * 2),) for _ in range(4)]
    turns = [tuple(map(float, random_quaternion(rng))) for _ in range(4)]
    times = (0.0, 0.2, 0.7, 1.0)
    return PosePath(tuple(map(Waypoint, times, stops, turns)))


def deepest_at(pair, t):
    placed = pair.placed(t)
    finding = examine(Draft(replace(placed, settings=replace(placed.settings, depth=True))))
    return finding.depth_bounds[0]


@pytest.mark.parametrize("seed", range(36))
def test_sampling_finds_no_overlap_where_none_was_proven(seed):
    rng = np.random.default_rng(1000 + seed)
    kind = ("translation", "rotation", "path")[seed % 3]
    a = hull_of(random_hull(rng, 8)) if seed % 2 else moved(bracket(), -3, -3, -2)
    a = (
        [
            tuple(c * 0.4 + o for c, o in zip(p, rng.normal(size=3) * 0 + 2, strict=True))
            for p in a[0]
        ],
        a[1],
    )
    b = hull_of(random_hull(rng, 8)) if seed % 4 < 2 else moved(bracket(), -3, -3, -2)
    other = random_path(rng, "rotation") if seed % 5 == 0 else None
    pair, impact = impact_of(a, random_path(rng, kind), b, other)
    until = impact.reached
    for k in range(65 if until else 0):
        found = pair.found_at(until * k / 64)
        if overlaps(found):  # not shown to be within the band, where it is
            assert deepest_at(pair, until * k / 64) <= pair.tolerance
    if impact.upper is not None:
        assert impact.lower <= impact.upper
        assert overlaps(pair.found_at(impact.upper))
    else:
        assert impact.free


def test_a_hit_after_a_spent_budget_has_a_first_contact(monkeypatch):
    """No common point is possible before it: the boxes meet at t = 0.5."""
    monkeypatch.setattr("satcheck.audit.motion.moving_pair.STEPS", 1)
    pair = moving(unit_box(), Translation((2.0, 0.3, 0.1)), unit_box(2.0))
    impact = first_impact(pair)
    assert impact.upper is not None
    assert impact.contact is not None
    assert impact.contact <= 0.5
