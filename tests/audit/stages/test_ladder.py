"""What ran for which pair: only the rungs that the question needed."""

from __future__ import annotations

import subprocess
import sys

import pytest

from satcheck.audit import Settings, check
from tests.audit.shapes import bracket, placed_scene, pose, scene_of, unit_box, write


def stages(finding):
    """Rungs that did something; a skipped one says why and costs nothing."""
    return [stage.stage for stage in finding.plan if stage.result != "skipped"]


def only(report):
    (finding,) = report.findings
    return finding


def test_boxes_apart_need_nothing_else(tmp_path):
    finding = only(check(scene_of(tmp_path, a=unit_box(), b=unit_box(3))))
    assert (finding.relation, finding.quality) == ("separated", "exact")
    assert stages(finding) == ["aabb"]


def test_turned_boxes_are_told_apart_by_their_oriented_boxes(tmp_path):
    write(tmp_path, bar=([(x * 10, y, z) for x, y, z in unit_box()[0]], unit_box()[1]))
    bodies = [("a", "bar.obj", pose(turn=45)), ("b", "bar.obj", pose(2, 0, 0, turn=45))]
    finding = only(check(placed_scene(tmp_path, bodies)))
    assert finding.relation == "separated"
    assert stages(finding) == ["aabb", "obb"]


def test_convex_pair_is_settled_by_its_hulls(tmp_path):
    finding = only(check(scene_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25))))
    assert finding.relation == finding.exact_relation == "penetrating"
    assert stages(finding) == ["aabb", "hull", "verify", "thickness"]


def test_no_depth_no_verification(tmp_path):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25))
    finding = only(check(scene, Settings(depth=False)))
    assert stages(finding) == ["aabb", "hull"]
    assert finding.depth is None
    assert finding.mtv is None


def test_nested_convex_pair(tmp_path):
    finding = only(check(scene_of(tmp_path, a=unit_box(edge=4.0), b=unit_box(1, 1, 1))))
    assert finding.relation == "contains"
    assert "containment" in stages(finding)
    swapped = only(check(scene_of(tmp_path, a=unit_box(1, 1, 1), b=unit_box(edge=4.0))))
    assert swapped.relation == "inside"


def test_coincident(tmp_path):
    finding = only(check(scene_of(tmp_path, a=unit_box(), b=unit_box())))
    assert finding.relation == "coincident"
    assert finding.depth == 1.0


def test_inside_the_notch_triangles_decide_and_nothing_more(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(3, 3, 1))
    finding = only(check(scene, Settings(tolerance=0.0)))
    assert (finding.relation, finding.quality) == ("separated", "exact")
    assert stages(finding) == ["aabb", "hull", "triangles"]


def test_the_touch_band_asks_whether_the_gap_is_within_it(tmp_path):
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(3, 3, 1))))
    assert stages(finding) == ["aabb", "hull", "triangles", "touch-band"]
    assert finding.plan[-1].result == "beyond"
    assert finding.distance is None


def test_hulls_apart_need_no_triangles(tmp_path):
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(5, 5, 1))))
    assert finding.relation == "separated"
    assert stages(finding) == ["aabb", "hull"]


def test_concave_overlap_without_depth_asks_for_no_parts(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0))
    report = check(scene, Settings(depth=False))
    finding = only(report)
    assert finding.relation == "penetrating"
    assert not {"parts", "depth", "search", "verify", "distance"} & set(stages(finding))
    assert all(body.parts is None for body in report.bodies)


def test_box_inside_the_material_of_a_concave_body(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(0.5, 4, 1))
    assert only(check(scene, Settings(depth=False))).relation == "contains"


@pytest.mark.parametrize(
    ("accuracy", "relation", "quality", "allowed"),
    [
        ("aabb", "penetrating", "estimate", {"aabb"}),
        ("obb", "penetrating", "estimate", {"aabb"}),
        ("hull", "penetrating", "estimate", {"aabb", "hull"}),
        ("exact", "separated", "exact", {"aabb", "hull", "triangles"}),
    ],
)
def test_accuracy_caps_the_ladder(tmp_path, accuracy, relation, quality, allowed):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(3, 3, 1))
    finding = only(check(scene, Settings(accuracy=accuracy, depth=False, tolerance=0.0)))
    assert (finding.relation, finding.quality) == (relation, quality)
    assert set(stages(finding)) == allowed
    assert finding.exact_relation == ("separated" if accuracy == "exact" else None)


@pytest.mark.parametrize("accuracy", ["aabb", "obb", "hull", "parts"])
def test_separated_is_proven_on_any_rung(tmp_path, accuracy):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(7))
    finding = only(check(scene, Settings(accuracy=accuracy)))
    assert (finding.relation, finding.quality) == ("separated", "exact")


def test_parts_rung_stops_short_of_triangles(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.25, 3, 1, edge=2.0))
    finding = only(check(scene, Settings(accuracy="parts", depth=False, cache=False)))
    assert finding.relation == "penetrating"
    assert "parts" in stages(finding)
    assert "triangles" not in stages(finding)


def test_two_convex_meshes_import_nothing_heavy(tmp_path):
    paths = write(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25))
    code = (
        "import sys; from satcheck.audit import check; "
        f"check({[str(path) for path in paths]!r}); "
        "print(sorted({name.split('.')[0] for name in sys.modules}), "
        "[name for name in sys.modules if name.startswith('satcheck.decompose')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    for name in (
        "numpy",
        "trimesh",
        "coacd",
        "concurrent",
        "multiprocessing",
        "asyncio",
        "cascadio",
    ):
        assert f"'{name}'" not in done.stdout
    assert done.stdout.rstrip().endswith("[]")
