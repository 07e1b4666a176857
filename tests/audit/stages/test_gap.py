"""Distances: only where a clearance asks for them, with normal and witness points."""

from __future__ import annotations

import pytest

from satcheck.audit import Settings, check
from tests.audit.shapes import box, bracket, moved, open_box, scene_of, unit_box


def only(report):
    (finding,) = report.findings
    return finding


def near_box(tmp_path, **settings):
    return only(check(scene_of(tmp_path, a=unit_box(), b=unit_box(1.5)), Settings(**settings)))


def test_no_clearance_no_distance(tmp_path):
    finding = near_box(tmp_path)
    assert (finding.relation, finding.distance, finding.witness) == ("separated", None, None)


def test_below_the_clearance(tmp_path):
    finding = near_box(tmp_path, clearance=0.75)
    assert (finding.relation, finding.severity, finding.rule) == ("near", "error", "clearance")
    assert finding.distance == 0.5
    assert finding.normal == (1.0, 0.0, 0.0)
    assert finding.witness.b[0] - finding.witness.a[0] == 0.5
    assert finding.exact_relation == "separated"


def test_the_clearance_itself_is_kept(tmp_path):
    finding = near_box(tmp_path, clearance=0.5)
    assert (finding.relation, finding.severity) == ("separated", "none")


def test_beyond_the_clearance_nothing_is_measured(tmp_path):
    finding = near_box(tmp_path, clearance=0.25)
    assert [stage.stage for stage in finding.plan] == ["aabb"]


def test_bodies_that_touch_keep_no_clearance(tmp_path):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(1.0))
    assert only(check(scene)).severity == "note"
    finding = only(check(scene, Settings(clearance=0.1)))
    assert (finding.relation, finding.severity) == ("touching", "error")


@pytest.mark.parametrize(
    ("shift", "clearance", "broken", "distance"),
    [
        (1.25, 0.5, True, 0.25),
        (1.25, 0.25, False, 0.25),
        (1.25, 0.125, False, 0.25),
        (1.0, 0.125, True, 0.0),
        (1.0, 0.0, False, 0.0),
        (0.75, 0.125, True, None),
    ],
)
def test_a_wide_band_hides_no_broken_clearance(tmp_path, shift, clearance, broken, distance):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(shift))
    for depth in (True, False):
        finding = only(check(scene, Settings(tolerance=1.0, clearance=clearance, depth=depth)))
        assert finding.relation == "touching"
        expected = ("error", "clearance") if broken else ("note", None)
        assert (finding.severity, finding.rule) == expected
        assert finding.distance == (distance and pytest.approx(distance))


@pytest.mark.parametrize(("clearance", "severity"), [(0.75, "error"), (0.5, "note")])
def test_a_concave_gap_within_the_band(tmp_path, clearance, severity):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(2.5, 3, 1))
    finding = only(check(scene, Settings(tolerance=1.0, clearance=clearance)))
    assert (finding.relation, finding.severity, finding.distance) == ("touching", severity, 0.5)


@pytest.mark.parametrize(("clearance", "relation"), [(0.75, "near"), (0.25, "separated")])
def test_concave_distance(tmp_path, clearance, relation):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(2.5, 3, 1))
    finding = only(check(scene, Settings(clearance=clearance)))
    assert finding.relation == relation
    assert finding.distance == 0.5
    assert finding.normal == (1.0, 0.0, 0.0)
    assert "distance" in [stage.stage for stage in finding.plan]


@pytest.mark.parametrize("depth", [True, False])
@pytest.mark.parametrize("body", [unit_box(1.5, 0.5, 0.5), moved(bracket(), 1, 1, 1)])
def test_an_overlap_has_no_distance(tmp_path, body, depth):
    """It has a depth, whether the bodies are convex or not and the depth is asked for or not."""
    scene = scene_of(tmp_path, a=box((0, 0, 0), (2, 2, 2)), b=body)
    finding = only(check(scene, Settings(clearance=0.5, depth=depth)))
    assert (finding.relation, finding.distance) == ("penetrating", None)


def test_a_capped_ladder_cannot_measure(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(4.5, 4.5, 1))
    finding = only(check(scene, Settings(accuracy="hull", clearance=5.0)))
    assert (finding.relation, finding.quality) == ("near", "estimate")
    assert finding.distance is None
    assert finding.reason == "the gap is not proven at --accuracy hull"
    assert finding.exact_relation == "separated"


def test_a_gap_ends_at_a_wall_without_thickness(tmp_path):
    """A pocket whose open side is closed by the faces of both boxes it is made of."""
    outer, inner = box((0, 0, 0), (5, 5, 5)), box((1, 1, 2), (4, 4, 5))
    offset = len(outer[0])
    inward = [tuple(offset + k for k in reversed(face)) for face in inner[1]]
    pocket = (outer[0] + inner[0], outer[1] + inward)
    scene = scene_of(tmp_path, a=pocket, b=box((2, 2, 3), (3, 3, 4.75)))
    finding = only(check(scene, Settings(clearance=0.5)))
    assert (finding.relation, finding.exact_relation) == ("near", "separated")
    assert (finding.quality, finding.distance) == ("exact", 0.25)
    through = scene_of(tmp_path, a=pocket, b=box((2, 2, 3), (3, 3, 7)))
    assert only(check(through, Settings())).relation == "penetrating"


def test_a_gap_ends_where_the_fill_of_a_hole_may_be(tmp_path):
    """The box is 1 away from the lid that is missing, and farther from the rim around it."""
    a, b = open_box(), box((1.5, 1.5, 5), (2.5, 2.5, 6))
    report = check(scene_of(tmp_path, a=a, b=b), Settings(clearance=1.25))
    assert (only(report).relation, only(report).undecided) == ("separated", "limit")
    assert report.summary.verdict == "incomplete"
    assert check(scene_of(tmp_path, a=a, b=b), Settings(clearance=0.75)).summary.verdict == "pass"
    sheets = Settings(clearance=1.25, allow_open=True)
    assert check(scene_of(tmp_path, a=a, b=b), sheets).summary.verdict == "pass"


def test_surfaces_as_far_apart_as_the_clearance_say_nothing_of_a_hole_between(tmp_path):
    """The box is 1.25 away from the rim, and 0.75 from the lid that is missing."""
    scene = scene_of(tmp_path, a=open_box(), b=box((1, 1, 4.75), (3, 3, 6)))
    report = check(scene, Settings(clearance=1.25))
    assert (only(report).distance, only(report).undecided) == (1.25, "limit")
    assert report.summary.verdict == "incomplete"
    touching = check(scene, Settings(tolerance=1.25))
    assert only(touching).relation == "touching"


@pytest.mark.parametrize("tip", [(0.5, -1.0, 0.5), (0.0, -2.0, 0.0)])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("order", ["ab", "ba"])
def test_a_wall_without_thickness_hides_no_body_as_near(tmp_path, tip, turned, order):
    """A fin, one triangle and its reverse, at the edge of a box that is nearest to the other."""
    points, faces = unit_box()
    fin = (1, 5, len(points))
    meshes = {"a": ([*points, tip], [*faces, fin, fin[::-1]]), "b": moved(bracket(), 2, -6, -1)}
    if turned:  # half a turn about z: the trees meet the triangles in another order
        meshes = {k: ([(-x, -y, z) for x, y, z in v], f) for k, (v, f) in meshes.items()}
    scene = scene_of(tmp_path, **{name: meshes[name] for name in order})
    finding = only(check(scene, Settings(clearance=1.5)))
    assert (finding.relation, finding.distance) == ("near", 1.0)
    assert only(check(scene, Settings(tolerance=1.5))).relation == "touching"
