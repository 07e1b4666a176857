"""A baseline over the life of an asset repository, and what counts as worse."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit.baseline import absent_from, beside_baseline, known_findings, updated
from satcheck.report.baseline import Baseline, KnownFinding
from satcheck.report.report import Finding, Relation
from tests.cli.process import SAMPLES, Ran, satcheck
from tests.cli.reports import BOUNDED, PENETRATING, SEPARATED, UNDECIDED, report

DEEPER = replace(BOUNDED, relation="penetrating")
KNOWN = KnownFinding(
    a=DEEPER.a, b=DEEPER.b, relation="penetrating", depth=DEEPER.depth, reason="a press fit"
)


def state(known: KnownFinding, finding: Finding) -> str | None:
    judged = beside_baseline(report(finding), Baseline(findings=(known,)), "b.json")
    return judged.findings[0].baseline_state


def at_least(depth: float) -> Finding:
    return replace(DEEPER, depth_bounds=(depth, 2.0), depth=2.0)


def test_no_worse_than_known_is_unchanged() -> None:
    assert DEEPER.depth is not None
    assert DEEPER.tolerance is not None
    assert state(KNOWN, DEEPER) == "unchanged"
    assert state(KNOWN, at_least(DEEPER.depth + DEEPER.tolerance)) == "unchanged"
    assert state(KNOWN, at_least(DEEPER.depth + 2 * DEEPER.tolerance)) == "worse"


@pytest.mark.parametrize(
    ("before", "now", "expected"),
    [
        ("penetrating", "contains", "worse"),
        ("near", "penetrating", "worse"),
        ("coincident", "penetrating", "unchanged"),
    ],
)
def test_a_graver_relation_is_worse(before: Relation, now: Relation, expected: str) -> None:
    assert state(replace(KNOWN, relation=before), replace(DEEPER, relation=now)) == expected


def test_the_order_of_the_bodies_does_not_matter() -> None:
    assert state(replace(KNOWN, a=KNOWN.b, b=KNOWN.a), DEEPER) == "unchanged"


def test_a_depth_that_is_not_measured_again_is_not_accepted() -> None:
    assert state(KNOWN, replace(DEEPER, depth=None, depth_bounds=None)) == "unmeasured"


def test_what_passes_or_is_open_has_no_state() -> None:
    known = replace(KNOWN, a="block", b="soup")
    assert state(known, SEPARATED) is None
    judged = beside_baseline(report(UNDECIDED), Baseline(findings=(known,)), "b.json")
    assert judged.findings[0].baseline_state is None
    assert judged.summary.verdict == "incomplete"


def test_only_new_and_worse_findings_fail() -> None:
    checked = report(DEEPER, PENETRATING)
    known = Baseline(findings=tuple(known_findings(checked)))
    accepted = beside_baseline(checked, known, "b.json")
    assert (accepted.summary.verdict, accepted.summary.accepted) == ("pass", 2)
    one = beside_baseline(checked, Baseline(findings=known.findings[:1]), "b.json")
    assert (one.summary.verdict, one.summary.accepted) == ("fail", 1)


def test_a_finding_is_absent_only_if_its_pair_was_checked() -> None:
    gone, elsewhere = replace(KNOWN, a="block", b="soup"), replace(KNOWN, a="block", b="moon")
    baseline = Baseline(findings=(gone, elsewhere, replace(gone, asset="other.glb")))
    assert absent_from(report(SEPARATED), baseline) == [gone]
    assert absent_from(report(UNDECIDED), baseline) == []


def test_an_update_keeps_reasons() -> None:
    new = replace(KNOWN, depth=9.0, reason="")
    assert updated(Baseline(findings=(KNOWN,)), [new]).findings == (replace(KNOWN, depth=9.0),)


class Repository:
    """A folder of assets, and the commands of its CI."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        shutil.copy(SAMPLES / "gripper.glb", folder)
        shutil.copy(SAMPLES / "box.obj", folder)

    def run(self, *arguments: str) -> Ran:
        return satcheck(*arguments, cwd=self.folder)

    def report(self) -> None:
        self.run("each", ".", "--depth", "-o", "report.json")

    def gate(self) -> Ran:
        return self.run("each", ".", "--depth", "--baseline", "known.json")

    def known(self) -> list[str]:
        document = json.loads((self.folder / "known.json").read_text())
        return [finding["asset"] for finding in document["findings"]]


def test_the_life_of_a_baseline(tmp_path: Path) -> None:
    repository = Repository(tmp_path)
    repository.report()
    assert repository.run("baseline", "write", "known.json", "report.json").code == 0
    assert repository.run("baseline", "write", "known.json", "report.json").code == 2
    assert repository.known() == ["gripper.glb"]
    assert repository.gate().code == 0

    shutil.copy(SAMPLES / "rack.3mf", tmp_path)
    assert repository.gate().code == 1
    repository.report()
    repository.run("baseline", "update", "known.json", "report.json", "--reason", "to be mended")
    assert repository.known() == ["gripper.glb", "rack.3mf"]
    assert repository.gate().code == 0

    apart = json.loads((tmp_path / "report.json").read_text())
    assert {each["verdict"] for each in apart["assets"]} == {"pass", "fail"}
    shutil.copy(SAMPLES / "arm_beam.stl", tmp_path / "gripper.stl")
    (tmp_path / "gripper.glb").unlink()
    repository.report()
    assert "0 removed" in repository.run("baseline", "prune", "known.json", "report.json").out


@pytest.mark.parametrize("text", ["{}", "[]", "{", '{"schema": "satcheck.baseline/2"}'])
def test_what_is_no_baseline(text: str, tmp_path: Path) -> None:
    path = tmp_path / "b.json"
    path.write_text(text)
    ran = satcheck("box.obj", "cube.off", "--baseline", str(path))
    assert (ran.code, "bad-baseline" in ran.err) == ((0, False) if text == "{}" else (2, True))
