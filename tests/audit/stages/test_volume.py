"""The common volume: only where it is asked for and measured only where nothing else says it."""

from __future__ import annotations

import pytest

from satcheck.audit import Settings, check
from satcheck.core.errors import SatcheckError
from tests.audit.shapes import (
    bracket,
    moved,
    open_box,
    placed_scene,
    pose,
    scene_of,
    unit_box,
    write,
)

ASKED = Settings(volume=True, depth=False)


def only(report):
    (finding,) = report.findings
    return finding


def measured(tmp_path, settings=ASKED, **meshes):
    return only(check(scene_of(tmp_path, **meshes), settings))


def stages(finding):
    return [stage.stage for stage in finding.plan]


def result(finding):
    return next(stage.result for stage in finding.plan if stage.stage == "volume")


def test_not_asked_not_measured(tmp_path):
    finding = measured(tmp_path, Settings(), a=unit_box(), b=unit_box(0.5))
    assert (finding.volume, finding.volume_error) == (None, None)
    assert "volume" not in stages(finding)


@pytest.mark.parametrize("x", [9.0, 1.0], ids=["apart", "touching"])
def test_nothing_in_common_is_exactly_nothing(tmp_path, x):
    finding = measured(tmp_path, a=unit_box(), b=unit_box(x))
    assert (finding.volume, finding.volume_error) == (0.0, 0.0)
    assert "volume" not in stages(finding)


def test_convex_bodies(tmp_path):
    finding = measured(tmp_path, a=unit_box(), b=unit_box(0.5, 0.25, 0.125))
    assert abs(finding.volume - 0.5 * 0.75 * 0.875) <= finding.volume_error < 1e-10
    assert result(finding) == "measured"
    assert finding.quality == "exact"  # of the relation: the volume has an error of its own


def test_concave_bodies(tmp_path):
    finding = measured(tmp_path, a=bracket(), b=moved(unit_box(edge=3.0), 1.0, 1.0, 0.5))
    assert abs(finding.volume - (9 - 4) * 3) <= finding.volume_error < 1e-8


@pytest.mark.parametrize("inner_first", [False, True])
def test_a_body_within_another_has_its_own_volume(tmp_path, inner_first):
    outer, inner = unit_box(edge=4.0), unit_box(1.0, 1.0, 1.0, 0.5)
    a, b = (inner, outer) if inner_first else (outer, inner)
    finding = measured(tmp_path, a=a, b=b)
    assert abs(finding.volume - 0.125) <= finding.volume_error < 1e-12
    assert result(finding) == "of the mesh"


def test_the_same_body_twice(tmp_path):
    finding = measured(tmp_path, a=bracket(), b=bracket())
    assert finding.relation == "coincident"
    assert abs(finding.volume - 20 * 4) <= finding.volume_error


def test_the_touch_band_hides_no_volume(tmp_path):
    settings = Settings(volume=True, tolerance=0.5)
    finding = measured(tmp_path, settings, a=unit_box(), b=unit_box(0.75))
    assert finding.relation == "touching"
    assert abs(finding.volume - 0.25) <= finding.volume_error


def test_placed_bodies(tmp_path):
    write(tmp_path, box=unit_box())
    bodies = [("a", "box.obj", pose(turn=45.0)), ("b", "box.obj", pose(x=0.25, y=0.5, turn=-30.0))]
    finding = only(check(placed_scene(tmp_path, bodies), ASKED))
    mirrored = only(check(placed_scene(tmp_path, bodies[::-1]), ASKED))
    assert 0.1 < finding.volume < 0.9
    assert abs(finding.volume - mirrored.volume) <= finding.volume_error


def refused(tmp_path, code, **meshes):
    """The one issue about it, and the finding."""
    report = check(scene_of(tmp_path, **meshes), ASKED)
    finding = only(report)
    assert (finding.volume, finding.volume_error) == (None, None)
    assert result(finding) == "refused"
    (issue,) = (issue for issue in report.issues if issue.code == code)
    assert issue.severity == "warning"
    return issue, finding


def test_an_open_mesh_has_no_volume(tmp_path):
    issue, finding = refused(
        tmp_path, "volume-of-no-solid", a=unit_box(3.5, 1.0, 1.0), b=open_box()
    )
    assert issue.body == "b"
    assert "no solid" in finding.reason


def test_far_from_an_open_mesh_there_is_nothing_all_the_same(tmp_path):
    finding = measured(tmp_path, a=unit_box(9.0), b=open_box())
    assert (finding.volume, finding.volume_error) == (0.0, 0.0)


def test_a_mesh_that_overlaps_itself_is_refused(tmp_path):
    """Its signed volume counts what is covered twice, twice."""
    points, faces = unit_box()
    more, _ = unit_box(0.5, 0.25, 0.125)
    twice = (points + more, faces + [tuple(k + 8 for k in face) for face in faces])
    issue, finding = refused(tmp_path, "volume-of-self-overlap", a=twice, b=unit_box(0.25))
    assert issue.body == "a"
    assert finding.reason == f"no volume: body 'a': {issue.message}"


def test_a_failure_is_a_reason_not_an_end(tmp_path):
    settings = Settings(volume=True, depth=False, volume_seconds=1e-3)
    meshes = {"a": unit_box(), "b": unit_box(0.5), "c": unit_box(0.75)}
    report = check(scene_of(tmp_path, **meshes), settings)
    assert [finding.volume for finding in report.findings] == [None, None, None]
    assert {issue.code for issue in report.issues} == {"volume-failed"}
    assert all(finding.relation == "penetrating" for finding in report.findings)


def test_a_volume_needs_triangles():
    with pytest.raises(SatcheckError, match="triangles") as caught:
        Settings(volume=True, accuracy="hull")
    assert caught.value.code == "bad-setting"
