"""The message of a finding and of a report: one sentence, the same in JSON and in every format."""

from __future__ import annotations

import html
import json
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.audit.baseline import beside_baseline, known_findings
from satcheck.audit.messages import with_messages
from satcheck.audit.samples import check_poses
from satcheck.cli.formats.registry import pieces
from satcheck.cli.formats.table import render as render_table
from satcheck.cli.output import PLAIN_PAGE
from satcheck.report.baseline import Baseline
from satcheck.report.json import render as render_json
from satcheck.scene import load_scene
from satcheck.scene.robot import read_poses
from tests.cli.reports import BLOCK, PENETRATING, SOUP, report

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
PUSHED = check([SAMPLES / "box.obj", SAMPLES / "box_pushed.stl"])
SAID = (
    "box and box_pushed overlap (thickness 1, 1 to pull apart); moving box by (-1, 0, 0) ends the "
    "overlap."
)


def test_json_states_them() -> None:
    document = json.loads("".join(render_json(PUSHED, timings=False)))
    assert [finding["message"] for finding in document["findings"]] == [SAID]
    assert document["message"] == "FAIL: box and box_pushed overlap (thickness 1, 1 to pull apart)."


@pytest.mark.parametrize("form", ["sarif", "junit", "github", "jsonl"])
def test_each_format_prints_them(form: str) -> None:
    told = replace(PUSHED.findings[0], message="what was composed")
    text = "".join(pieces({"all": replace(PUSHED, findings=(told,))}, form))
    assert "what was composed" in html.unescape(text)


def test_a_table_ends_with_that_of_the_report() -> None:
    told = replace(PUSHED, message="FAIL: what was composed.")
    assert "\nFAIL: what was composed.\nNext: " in render_table(
        told, PLAIN_PAGE, explain=False, timings=False
    )


def test_they_do_not_depend_on_the_order_of_the_stages() -> None:
    finding = PUSHED.findings[0]
    other = replace(finding, plan=finding.plan[::-1], message="")
    assert with_messages(replace(PUSHED, findings=(other,), message="")) == replace(
        PUSHED, findings=(replace(other, message=SAID),)
    )


def test_they_name_bodies_as_people_do() -> None:
    wall = replace(BLOCK, id="3cUk", name="Wall", path="3cUk")
    found = report(replace(PENETRATING, a="3cUk"), bodies=(wall, SOUP))
    assert found.findings[0].message.startswith("Wall (3cUk) ")
    assert found.findings[0].a == "3cUk"
    assert "Wall (3cUk) " in found.message


def test_a_baseline_changes_them() -> None:
    known = Baseline(findings=tuple(known_findings(PUSHED)))
    judged = beside_baseline(PUSHED, known, "b.json")
    assert judged.message == "PASS: no new or worse finding."
    assert judged.findings[0].message == SAID.replace("overlap.", "overlap [baseline: unchanged].")


def test_findings_of_poses_have_them() -> None:
    arm = load_scene([SAMPLES / "arm.urdf", SAMPLES / "arm.srdf"])
    poses = read_poses(str(SAMPLES / "arm_poses.json"))
    assert isinstance(poses, list)
    found = check_poses(arm, poses, Settings(depth=False))
    messages = [finding.message for sample in found.samples for finding in sample.findings]
    assert any("overlap" in message for message in messages)
    assert all(message.endswith(".") for message in messages)
