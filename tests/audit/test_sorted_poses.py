"""What is counted of poses that a report does not list is what their own reports say."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import Settings, sample_results, samples
from satcheck.audit.samples import check_poses
from satcheck.report.samples import SamplesReport
from satcheck.scene import Scene
from satcheck.scene.robot import RandomPoses
from tests.audit.test_posed_pairs import QUICK, SHAPES, meshes, open_cups, plain, spider


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
