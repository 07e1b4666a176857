"""What is counted of poses that a report does not list is what their own reports say."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from satcheck.audit import Settings, check, sample_results, samples
from satcheck.audit.samples import check_poses
from satcheck.report.samples import SamplesReport
from satcheck.scene import Scene, load_scene
from satcheck.scene.robot import Pose, RandomPoses, posed
from tests.audit.test_posed_pairs import QUICK, SHAPES, compare, meshes, open_cups, plain, spider
from tests.scene.robot.robots import joint, link, robot_of


@pytest.fixture
def few_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reports of more than 50 poses list the first five with a finding."""
    monkeypatch.setattr(sample_results, "LISTED_NOTED", 5)
    monkeypatch.setattr(samples, "LISTED_SAMPLES", 50)
    monkeypatch.setattr(samples, "BATCH", 16)


def poses_of(scene: Scene) -> RandomPoses:
    return RandomPoses([robot.robot for robot in scene.robots], 60, 3)


def listed(found: SamplesReport, number: int) -> list[tuple[int, list[dict[str, object]]]]:
    noted = [sample for sample in found.samples if sample.findings]
    return [(s.number, list(map(plain, s.findings))) for s in noted[:number]]


@pytest.mark.parametrize(
    "rules",
    ["", '[[rules]]\na = "part*"\nb = "part[0-4]"\nseverity = "warning"\n'],
)
def test_a_report_of_many_poses_counts_all_and_lists_the_first(
    tmp_path: Path, request: pytest.FixtureRequest, rules: str
) -> None:
    scene = spider(tmp_path, [*meshes(tmp_path)[:3], *SHAPES[:2], *open_cups(tmp_path)], rules)
    whole = check_poses(scene, poses_of(scene), QUICK)
    request.getfixturevalue("few_listed")
    short = check_poses(scene, poses_of(scene), QUICK)
    assert len(whole.samples) == 60
    assert len(short.samples) == 5
    assert listed(short, 5) == listed(whole, 5)
    assert short.summary == whole.summary
    assert short.pairs == whole.pairs
    assert any(pair.undecided > 1 for pair in short.pairs)
    left_out = short.truncated
    assert left_out is not None
    assert left_out.samples == 55
    assert whole.truncated is None


@pytest.mark.usefixtures("few_listed")
def test_the_number_of_jobs_changes_nothing(tmp_path: Path) -> None:
    scene = spider(tmp_path, [*meshes(tmp_path)[:3], *SHAPES[:2], *open_cups(tmp_path)])
    one, two = (
        check_poses(scene, poses_of(scene), Settings(depth=False, jobs=jobs)) for jobs in (1, 2)
    )
    assert one.summary == two.summary
    assert one.pairs == two.pairs
    assert listed(one, 5) == listed(two, 5)


def test_a_listed_pose_climbs_only_what_the_sort_does_not_prove(tmp_path: Path) -> None:
    """A block slides into a wall: across its face, and wholly inside. Only the boxes of the first
    pose show that neither body holds the other."""
    wall, block = (
        '<geometry><box size="4 4 4"/></geometry>',
        '<geometry><box size="1 1 1"/></geometry>',
    )
    slide = '<axis xyz="1 0 0"/><limit lower="0" upper="9"/>'
    text = robot_of(
        link("wall", f"<collision>{wall}</collision>"),
        link("block", f"<collision>{block}</collision>"),
        joint("slide", "wall", "block", "prismatic", slide),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    poses: list[Pose] = [{"slide": (2.0,)}, {"slide": (0.5,)}, {"slide": (5.0,)}]
    found = check_poses(scene, poses, QUICK)
    first, second = (sample.findings[0] for sample in found.samples[:2])
    assert [stage.stage for stage in first.plan] == ["sort"]
    assert (first.relation, second.relation) == ("penetrating", "contains")
    assert second.plan[0].stage == "aabb"
    assert not found.samples[2].findings
    for sample, pose in zip(found.samples[:2], poses, strict=False):
        (own,) = check(posed(scene, pose), QUICK).findings
        assert plain(sample.findings[0]) == plain(own)
    measured = check_poses(scene, poses, Settings(depth=True)).samples[0].findings[0]
    assert measured.depth == pytest.approx(0.5)


def test_the_sort_proves_turned_curved_and_open_bodies(tmp_path: Path) -> None:
    """Boxes and discs that are turned against the axes of the world, and cups: what the sort lists
    without a climb says what a check of the pose says."""
    scene = spider(tmp_path, [*SHAPES, *SHAPES[:3], *open_cups(tmp_path)])
    relations = compare(scene, QUICK, 25)
    assert relations >= {"penetrating", "contains", "indeterminate"}
    samples = check_poses(scene, poses_of(scene), QUICK).samples
    stages = Counter(
        (finding.relation, finding.plan[0].stage)
        for sample in samples
        for finding in sample.findings
    )
    assert stages["penetrating", "sort"] > 2 * stages["penetrating", "aabb"]


def test_the_hole_between_two_open_bodies_is_that_of_a_check_of_the_pose(tmp_path: Path) -> None:
    """Either body has a hole in the way of the other one, and only one is named."""
    open_cups(tmp_path)
    cup = (tmp_path / "cup.obj").read_text()
    (tmp_path / "bowl.obj").write_text(cup + "f 2 4 8 6\nf 3 7 8 4\n")  # without its lid
    scales = ("1 1 1", "0.9 0.8 0.95", "0.7 0.7 0.7", "1.1 0.6 0.8")
    geometries = [
        f'<mesh filename="{name}.obj" scale="{scale}"/>'
        for name, scale in zip(("bowl", "cup") * 2, scales, strict=True)
    ]
    assert "indeterminate" in compare(spider(tmp_path, geometries), QUICK, 60)
