"""Bodies in a picture where they stand along a motion, or in one of several poses."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from msgspec.structs import replace

from satcheck.audit import check
from satcheck.audit.samples import check_poses
from satcheck.cli.formats.picture.html import picture_data
from satcheck.cli.formats.picture.moments import Moments, moments_of
from satcheck.cli.formats.picture.poses import all_poses, one_pose, worst_pose
from satcheck.cli.formats.picture.shown import Shows
from satcheck.core.errors import SatcheckError
from satcheck.report.samples import SamplesTruncated
from satcheck.scene import Scene, load_scene
from satcheck.scene.robot import RandomPoses, posed, read_path, with_joint_path
from tests.cli.process import SAMPLES, satcheck

ARM = [str(SAMPLES / name) for name in ("arm.urdf", "arm.srdf")]
BOX = {"type": "box", "size": [1, 1, 1]}


def moving(folder: Path, motion: dict[str, Any]) -> Scene:
    """Two unit cubes 2 apart, of which the first one moves."""
    bodies = [{"id": "a", "shape": BOX}, {"id": "b", "shape": BOX, "position": [3, 0, 0]}]
    scene = {"schema": "satcheck.scene/1", "bodies": bodies, "motion": [motion]}
    (folder / "scene.json").write_text(json.dumps(scene))
    return load_scene([str(folder / "scene.json")])


def test_a_hit_is_shown_when_it_happens(tmp_path: Path) -> None:
    scene = moving(tmp_path, {"bodies": ["a"], "translation": [8, 0, 0]})
    report = check(scene)
    (finding,) = report.findings
    moments = moments_of(report, scene)
    number = moments.of[finding.id]
    assert moments.names[0] == "t = 0"
    assert moments.placed["a"][number][0, 3] == pytest.approx(2.0, abs=1e-6)
    assert list(moments.placed) == ["a"]
    (shown,) = picture_data(report, scene)["findings"]
    assert shown["moment"] == number
    assert [label[0] for label in shown["labels"][2:]] == ["hit at 2 of travel"]


def test_a_way_that_starts_elsewhere_has_the_placement_first(tmp_path: Path) -> None:
    waypoints = [{"time": 0, "position": [0, 5, 0]}, {"time": 1, "position": [9, 5, 0]}]
    scene = moving(tmp_path, {"bodies": ["a"], "path": waypoints})
    moments = moments_of(check(scene), scene)
    assert moments.names[:2] == ("as placed", "t = 0")
    assert moments.placed["a"][0].tolist() == np.eye(4).tolist()
    assert moments.placed["a"][1][:3, 3].tolist() == [0, 5, 0]


def test_the_links_of_a_path_stand_as_in_its_pose() -> None:
    scene = with_joint_path(load_scene(ARM), read_path(str(SAMPLES / "arm_poses.json")), {})
    report = check(scene)
    moments = moments_of(report, scene)
    hit = next(f for f in report.findings if f.id in moments.of and f.motion and f.motion.joints)
    assert hit.motion is not None
    assert hit.motion.joints is not None
    pose = {
        name: tuple(value) if isinstance(value, list) else (value,)
        for name, value in hit.motion.joints.items()
    }
    labels = Shows(report, scene, moments, "z").of(hit).labels
    assert "hit at t = 0.984, between poses 2 and 3" in " ".join(label.text for label in labels)
    there = moments.scene_at(scene, moments.of[hit.id])
    for body, expected in zip(there.bodies, posed(scene, pose).bodies, strict=True):
        assert body.transform == pytest.approx(expected.transform, abs=1e-12)


def sampled(count: int) -> tuple[Any, Scene]:
    scene = load_scene(ARM)
    return check_poses(scene, RandomPoses([r.robot for r in scene.robots], count, 0)), scene


@pytest.mark.parametrize("count", [60, 1200])
def test_each_pose_with_a_finding_is_where_it_was(count: int) -> None:
    """1200: of so many the report lists those with a finding alone."""
    report, scene = sampled(count)
    worst = worst_pose(report)
    assert worst is not None
    stated, there, moments = one_pose(report, scene, worst.number)
    pose = {n: tuple(v) if isinstance(v, list) else (v,) for n, v in worst.pose.items()}
    for body, expected in zip(there.bodies, posed(scene, pose).bodies, strict=True):
        assert body.transform == pytest.approx(expected.transform, abs=1e-12)
    assert stated.findings == worst.findings
    assert moments.note == f"pose {worst.number}"


def test_all_poses_have_the_worst_finding_of_each_pair() -> None:
    report, scene = sampled(60)
    stated, _, moments = all_poses(report, scene)
    failing = {(pair.a, pair.b) for pair in report.pairs if pair.fails}
    assert {(f.a, f.b) for f in stated.findings} >= failing
    assert len({f.id for f in stated.findings}) == len(stated.findings)
    for finding in stated.findings:
        assert finding.message.startswith(moments.names[moments.of[finding.id]].capitalize())


def test_a_pose_without_a_finding_says_what_to_run() -> None:
    report, scene = sampled(60)
    free = next(sample for sample in report.samples if not sample.findings)
    with pytest.raises(SatcheckError, match=r"has no finding: --pose '\{") as caught:
        one_pose(report, scene, free.number)
    assert caught.value.code == "not-drawable"
    with pytest.raises(SatcheckError, match="is not in the report"):
        one_pose(report, scene, 61)
    first = min(report.pairs, key=lambda pair: pair.first_overlap or 999)
    bare = replace(report, samples=(), truncated=SamplesTruncated(60, "too many"))
    said = rf"comes after those .*: --pose '{re.escape(json.dumps(first.first_pose))}' -o pose.html"
    with pytest.raises(SatcheckError, match=said):
        one_pose(bare, scene, first.first_overlap or 0)


@pytest.mark.parametrize(
    ("more", "end"),
    [
        (("60",), "shows the poses in 3-D; --depth finds the deepest of each pair.\n"),
        (("60", "--depth"), "shows the poses in 3-D.\n"),
        (
            ("1001", "--seed", "3"),
            " poses with a finding, of 1,001; --depth finds the deepest of each pair.\n",
        ),
    ],
)
def test_the_last_line_says_which_poses_a_page_shows(more: tuple[str, ...], end: str) -> None:
    ran = satcheck(*ARM, "--sample", *more, env={"COLUMNS": "400"})
    assert ran.out.endswith(end)


def test_poses_are_drawn_and_viewed_alike(tmp_path: Path) -> None:
    poses = (*ARM, "--sample", "60")
    direct, stored, later = (tmp_path / name for name in ("a.html", "s.json", "b.html"))
    assert satcheck(*poses, "-o", str(direct)).code == 1
    satcheck(*poses, "-o", str(stored))
    assert satcheck("view", str(stored), "-o", str(later), "--allow-outside").code == 0
    assert direct.read_text() == later.read_text()
    number = str(next(s["number"] for s in json.loads(stored.read_text())["samples"] if s["moved"]))
    image, model = tmp_path / "x.png", tmp_path / "x.glb"
    files = ("-o", str(image), "-o", str(model), "--allow-outside")
    assert satcheck("view", str(stored), "--pose", number, *files).code == 0
    assert image.read_bytes().startswith(b"\x89PNG")
    assert len(trimesh.load_scene(model).geometry) > 0


def test_a_model_of_a_path_is_that_of_the_first_hit(tmp_path: Path) -> None:
    model = tmp_path / "x.glb"
    satcheck(*ARM, "--path", str(SAMPLES / "arm_poses.json"), "-o", str(model))
    names = set(trimesh.load_scene(model).graph.nodes_geometry)
    assert "hit: turret and fore/palm" in names


def test_a_stored_path_says_what_to_run(tmp_path: Path) -> None:
    stored = tmp_path / "x.json"
    satcheck(*ARM, "--path", str(SAMPLES / "arm_poses.json"), "-o", str(stored))
    ran = satcheck("view", str(stored), "-o", str(tmp_path / "x.html"), "--allow-outside")
    assert ran.code == 3
    assert "satcheck ROBOT --path FILE" in ran.err
    assert satcheck("view", str(stored), "--pose", "1", "-o", str(tmp_path / "y.png")).code == 2


def test_a_still_scene_has_no_moments() -> None:
    scene = load_scene([str(SAMPLES / "rack.3mf")])
    assert moments_of(check(scene), scene) == Moments()
