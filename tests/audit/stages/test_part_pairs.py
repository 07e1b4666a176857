"""The convex parts of pairs: judged by the triangles of the parts, and never the judge."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import pytest
from msgspec.structs import replace

from satcheck import core, decompose
from satcheck.audit import Settings, check
from satcheck.audit.stages import part_pairs
from satcheck.core.errors import SatcheckError
from satcheck.report.part_pairs import PartPairs
from satcheck.report.report import Finding, Report
from satcheck.scene import Scene, load_scene
from tests.audit.shapes import Mesh, bracket, moved, open_box, scene_of, unit_box, write

QUICK = Settings(parts=True, depth=False, tolerance=0.0)
SPHERE = {"type": "sphere", "radius": 1.0}


@pytest.fixture(autouse=True, scope="module")
def one_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """CoACD splits each mesh once for all these tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SATCHECK_CACHE_DIR", str(tmp_path_factory.mktemp("cache")))
        yield


def only(report: Report) -> Finding:
    (finding,) = report.findings
    return finding


def parts_of(finding: Finding) -> PartPairs:
    assert finding.part_pairs is not None
    return finding.part_pairs


def turned(x: float, y: float, z: float, degrees: float = 0.0, scale: float = 1.0) -> list[float]:
    c, s = scale * math.cos(math.radians(degrees)), scale * math.sin(math.radians(degrees))
    return [c, -s, 0.0, x, s, c, 0.0, y, 0.0, 0.0, scale, z, 0.0, 0.0, 0.0, 1.0]


def placed(folder: Path, a: Mesh, b: Mesh, matrix: list[float]) -> Scene:
    write(folder, a=a, b=b)
    rows = [matrix[k : k + 4] for k in range(0, 16, 4)]
    bodies = [{"id": "a", "mesh": "a.obj"}, {"id": "b", "mesh": "b.obj", "matrix": rows}]
    return scene_file(folder, *bodies)


def scene_file(folder: Path, *bodies: object) -> Scene:
    path = folder / "scene.json"
    content = {"schema": "satcheck.scene/1", "units": "mm", "bodies": bodies}
    path.write_text(json.dumps(content), "utf-8")
    return load_scene([path])


def judged_by_triangles(scene: Scene) -> dict[tuple[str, str], str]:
    """The relation of each two parts, as those of meshes; separated ones are left out."""
    split = []
    for body in scene.bodies:
        made = decompose.decompose(body.file.mesh, cache=decompose.user_cache())
        meshes = [part.to_mesh() for part in made.parts]
        if body.transform is not None:
            meshes = [mesh.transformed(body.transform).convex_hull().to_mesh() for mesh in meshes]
        names = (f"{body.id}#{number}" for number in range(1, len(meshes) + 1))
        split.append([(n, core.Surface(m, True)) for n, m in zip(names, meshes, strict=True)])
    found = {}
    for (name_a, a), (name_b, b) in product(*split):
        relation = core.mesh_relation(a, b).relation
        if relation != "separated":
            found[name_a, name_b] = "touching" if relation == "touching" else "penetrating"
    return found


@pytest.mark.parametrize("method", ["auto", "sat", "gjk"])
@pytest.mark.parametrize(
    "matrix",
    [
        turned(1.0, 1.0, 1.0),
        turned(5.0, 0.5, 1.0, 30.0),
        turned(2.0, 2.0, 0.0),  # flush in the notch
        turned(4.5, 4.5, 0.5, 200.0, 0.75),
        turned(4.0, 1.0, 1.0, 40.0, 2.5),
    ],
    ids=["moved", "turned", "flush", "smaller", "larger"],
)
def test_the_triangles_of_the_parts_agree(tmp_path, matrix, method):
    scene = placed(tmp_path, bracket(), bracket(), matrix)
    found = parts_of(only(check(scene, replace(QUICK, method=method))))
    truth = judged_by_triangles(scene)
    assert {(pair.a, pair.b): pair.relation for pair in found.pairs} == truth
    assert truth
    assert found.overlapping == sum(said == "penetrating" for said in truth.values())
    assert (found.parts, found.undecided, found.untested) == ((2, 2), 0, 0)
    depths = [pair.depth for pair in found.pairs]
    assert depths == sorted(depths, reverse=True)


def test_figures_are_those_of_convex_bodies(tmp_path):
    """Two boxes: the part is the body. The axis is the normal of the finding, as mtv = -depth *
    normal."""
    finding = only(
        check(scene_of(tmp_path, a=unit_box(), b=unit_box(0.75)), replace(QUICK, depth=True))
    )
    (pair,) = parts_of(finding).pairs
    assert (pair.a, pair.b, pair.relation) == ("a#1", "b#1", "penetrating")
    assert (pair.depth, pair.axis) == (0.25, (1.0, 0.0, 0.0))
    assert (pair.depth, pair.axis) == (finding.depth, finding.normal)
    assert (pair.method, pair.axes_tested > 0, pair.iterations) == ("sat", True, 0)
    by_gjk = parts_of(
        only(
            check(scene_of(tmp_path, a=unit_box(), b=unit_box(0.75)), replace(QUICK, method="gjk"))
        )
    )
    assert (by_gjk.pairs[0].method, by_gjk.pairs[0].axes_tested) == ("gjk+epa", 0)
    assert by_gjk.pairs[0].iterations > 0


def test_not_asked_nothing_is_split(tmp_path, monkeypatch):
    monkeypatch.delattr(decompose, "decompose")
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(1.0)), Settings(depth=False)))
    assert finding.part_pairs is None


@pytest.mark.parametrize("accuracy", ["aabb", "obb", "hull", "parts", "exact"])
@pytest.mark.parametrize(
    "b", [unit_box(5.5, 0.5, 1.0), unit_box(2.5, 2.5, 1.0), unit_box(2.0, 2.0)]
)
def test_parts_change_no_verdict(tmp_path, accuracy, b):
    scene = scene_of(tmp_path, a=bracket(), b=b)
    without, beside = (
        check(scene, replace(QUICK, accuracy=accuracy, parts=asked)) for asked in (False, True)
    )
    finding = only(beside)
    plain = replace(finding, part_pairs=None, plan=())
    assert plain == replace(only(without), plan=())
    assert (beside.summary, beside.issues) == (without.summary, without.issues)
    assert parts_of(finding).parts == (2, 1)


def test_an_overlap_within_the_tolerance_touches(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(5.9, 0.5, 1.0))
    finding = only(check(scene, replace(QUICK, tolerance=0.2)))
    assert finding.relation == "touching"
    found = parts_of(finding)
    assert (found.overlapping, found.touching, found.remark) == (0, 1, None)
    assert found.pairs[0].depth == pytest.approx(0.1, abs=1e-12)


def test_pruned_pairs_have_none(tmp_path):
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(9.0)), QUICK))
    assert (finding.relation, finding.part_pairs) == ("separated", None)


def test_parts_that_stick_out_are_said_to_explain_it(tmp_path):
    """At this threshold the bracket is one part, its hull, which fills the notch."""
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(2.5, 2.5, 1.0))
    report = check(scene, replace(QUICK, part_threshold=1.0))
    finding, (a, b) = only(report), report.bodies
    found = parts_of(finding)
    assert (finding.relation, found.parts, found.overlapping) == ("separated", (1, 1), 1)
    assert report.summary.verdict == "pass"
    assert a.part_error is not None
    assert a.part_error.outside >= math.sqrt(8) / 2
    assert b.parts is None
    assert found.remark is not None
    assert found.remark.startswith(
        "parts overlap by up to 2.01 where the bodies are apart; parts of a"
    )
    assert "of b" not in found.remark


def test_parts_that_fall_short_are_said_to_explain_it(tmp_path, monkeypatch):
    real = decompose.decompose

    def thin(mesh, **how):
        made = real(mesh, **how)
        parts = tuple(part for part in made.parts if part.to_mesh().bounds[1][1] > 3.0)
        return replace(made, parts=parts, missing=4.0)

    monkeypatch.setattr(decompose, "decompose", thin)
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(5.5, 0.5, 1.0)), QUICK))
    found = parts_of(finding)
    assert (finding.relation, found.overlapping) == ("penetrating", 0)
    said = "no parts overlap where the bodies do; a sticks out of its parts by up to 4"
    assert found.remark == said


def test_errors_of_a_larger_copy_are_larger(tmp_path):
    scene = placed(tmp_path, unit_box(), bracket(), turned(0.0, 0.0, 0.0, 0.0, 3.0))
    asked = replace(QUICK, part_threshold=1.0)
    (_, large), alone = (
        check(scene, asked).bodies,
        decompose.decompose(scene.bodies[1].file.mesh, threshold=1.0),
    )
    assert large.part_error is not None
    assert large.part_error.outside == pytest.approx(3.0 * alone.outside, rel=1e-12)


@pytest.mark.parametrize(
    ("meshes", "why"),
    [
        ({"a": open_box(), "b": moved(unit_box(), 3.5, 1.0, 1.0)}, "not solid"),
        ({"a": bracket(), "b": ([*unit_box()[0]], [(0, 2, 3, 1)])}, "not solid"),
    ],
    ids=["open", "sheet"],
)
def test_what_is_not_solid_has_none(tmp_path, meshes, why):
    report = check(scene_of(tmp_path, **meshes), QUICK)
    found = parts_of(only(report))
    assert (found.parts, found.pairs) == ((0, 0), ())
    assert why in (found.remark or "")
    (effect,) = [effect for effect in report.effects if effect.effect == "part-pairs"]
    assert (effect.pairs, effect.not_run) == (0, {"no answer": 1})


def test_a_half_space_has_none(tmp_path):
    floor = {"id": "floor", "shape": {"type": "half-space"}}
    ball = {"id": "ball", "shape": SPHERE}
    finding = only(check(scene_file(tmp_path, floor, ball), QUICK))
    assert parts_of(finding).remark == "no convex parts: a half space has no end: floor"


def test_a_curved_shape_is_its_own_part(tmp_path):
    write(tmp_path, a=bracket())
    balls = {"id": "ball", "shape": SPHERE, "position": [6.5, 1.0, 2.0]}
    found = parts_of(only(check(scene_file(tmp_path, {"id": "a", "mesh": "a.obj"}, balls), QUICK)))
    assert (found.parts, found.overlapping) == ((2, 1), 1)
    assert found.pairs[0].b == "ball#1"
    assert found.pairs[0].depth == pytest.approx(0.5, abs=1e-9)
    assert found.pairs[0].axis == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)


def test_a_mesh_that_cannot_be_split_leaves_the_verdict(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0))
    report = check(scene, replace(QUICK, part_seconds=1e-3, cache=False))
    finding = only(report)
    assert (finding.relation, finding.quality) == ("penetrating", "exact")
    assert report.summary.verdict == "fail"
    assert parts_of(finding).remark == "no convex parts: a could not be split, see the issues"
    assert [issue.body for issue in report.issues if issue.severity == "warning"] == ["a"]


def test_parts_that_the_tolerance_hides_are_no_error_of_theirs(tmp_path, monkeypatch):
    monkeypatch.setattr(part_pairs, "_relation", lambda *_: "touching")
    finding = only(check(scene_of(tmp_path, a=bracket(), b=unit_box(5.5, 0.5, 1.0)), QUICK))
    assert finding.relation == "penetrating"
    assert parts_of(finding).remark == "parts only touch where the bodies overlap"


def test_the_deepest_are_listed_and_all_are_counted(tmp_path, monkeypatch):
    scene = placed(tmp_path, bracket(), bracket(), turned(1.0, 1.0, 1.0))
    whole = parts_of(only(check(scene, QUICK)))
    monkeypatch.setattr(part_pairs, "LISTED", 1)
    listed = parts_of(only(check(scene, QUICK)))
    assert len(whole.pairs) > 1
    assert listed == replace(whole, pairs=whole.pairs[:1])
    monkeypatch.setattr(part_pairs, "MAX_TESTED", 1)
    tested = parts_of(only(check(scene, QUICK)))
    assert len(tested.pairs) == 1
    assert tested.untested == len(whole.pairs) - 1


def test_what_is_undecided_is_no_disagreement(tmp_path, monkeypatch):
    nothing = dict.fromkeys(("lower", "upper", "distance", "normal"))
    counts = dict.fromkeys(("axes_tested", "gjk_iterations", "epa_iterations"), 0)
    left_open = SimpleNamespace(outcome="undecided", method="none", **nothing, **counts)
    monkeypatch.setattr(core, "check_pair", lambda *_, **__: left_open)
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(5.5, 0.5, 1.0))
    found = parts_of(only(check(scene, QUICK)))
    assert (found.overlapping, found.undecided, found.remark) == (0, 1, None)
    assert (found.pairs[0].relation, found.pairs[0].depth) == ("indeterminate", None)


@pytest.mark.parametrize(("tolerance", "relation"), [(0.25, "touching"), (0.2499, "penetrating")])
def test_the_tolerance_itself_still_touches(tmp_path, tolerance, relation):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.75, 0.125, 0.125))
    finding = only(check(scene, replace(QUICK, tolerance=tolerance)))
    assert (finding.relation, parts_of(finding).pairs[0].relation) == (relation, relation)


def test_threads_and_runs_change_nothing(tmp_path):
    write(tmp_path, part=bracket())
    bodies = [
        {"id": f"b{k}", "mesh": "part.obj", "position": [1.5 * k, 0.25 * k, 0.5 * (k % 2)]}
        for k in range(6)
    ]
    scene = scene_file(tmp_path, *bodies)
    made = [check(scene, replace(QUICK, jobs=jobs)).to_dict(False) for jobs in (1, 2, 4, 1)]
    assert made.count(made[0]) == len(made)
    assert sum(finding["part_pairs"] is not None for finding in made[0]["findings"]) >= 8


def test_not_in_a_plane():
    with pytest.raises(SatcheckError, match="parts needs bodies in space"):
        Settings(parts=True, planar="xy")
