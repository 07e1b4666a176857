"""A body that may lie inside one without an inside: not checked, and never a pass."""

from __future__ import annotations

import pytest

from satcheck.audit import Settings, check
from satcheck.core.frozen import replace
from satcheck.scene.rules import Rule, Selector
from tests.audit.shapes import open_box, scene_of, unit_box


def only(report):
    (finding,) = report.findings
    return finding


def double_sided(edge=4.0):
    points, faces = open_box(edge)
    return points, [*faces, *((face[0], *face[:0:-1]) for face in faces)]


@pytest.mark.parametrize("swapped", [False, True])
def test_a_box_in_an_open_box_was_not_checked(tmp_path, swapped):
    meshes = {"shell": open_box(), "part": unit_box(1, 1, 1)}
    report = check(scene_of(tmp_path, **dict(reversed(meshes.items()) if swapped else meshes)))
    finding = only(report)
    assert (finding.relation, finding.severity) == ("separated", "warning")
    assert finding.reason == "the inside of shell was not checked: it is not closed"
    assert (report.summary.verdict, report.summary.surfaces_only) == ("incomplete", 1)
    assert (report.summary.pairs.decided, report.summary.pairs.indeterminate) == (1, 0)


def test_touching_the_wall_from_inside_shows_no_more(tmp_path):
    report = check(scene_of(tmp_path, shell=open_box(), part=unit_box(1, 1, 0)))
    assert (only(report).relation, report.summary.verdict) == ("touching", "incomplete")


def test_a_double_sided_shell_says_so(tmp_path):
    finding = only(check(scene_of(tmp_path, shell=double_sided(), part=unit_box(1, 1, 1))))
    assert finding.severity == "warning"
    assert finding.reason == "the inside of shell was not checked: it is double-sided"


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("limit", ["max_depth", "tolerance"])
def test_a_short_way_out_may_lead_into_an_open_box(tmp_path, limit, swapped):
    """The part sticks in a wall, by less from within; closed, it would be deeper than the limit."""
    names = ("part", "shell") if swapped else ("shell", "part")
    meshes = {"shell": open_box(), "part": unit_box(3.25, 1, 1)}
    scene = scene_of(tmp_path, **{name: meshes[name] for name in names})
    rule = Rule(a=Selector("shell"), b=Selector("part"), **{limit: 0.5})
    report = check(replace(scene, rules=(rule,)), Settings(certificate=True))
    finding = only(report)
    assert (finding.severity, finding.undecided) == ("warning", "inside")
    assert finding.reason == "the inside of shell was not checked: it is not closed"
    assert report.summary.verdict == "incomplete"
    assert finding.certificate is not None  # the checker agrees
    allowed = check(replace(scene, rules=(rule,)), Settings(allow_open=True))
    assert (only(allowed).severity, allowed.summary.verdict) == ("note", "pass")


def test_allowed_open_bodies_are_a_note(tmp_path):
    scene = scene_of(tmp_path, shell=open_box(), part=unit_box(1, 1, 1))
    report = check(scene, Settings(allow_open=True))
    assert only(report).severity == "note"
    assert "not checked" in only(report).reason
    assert (report.summary.verdict, report.summary.surfaces_only) == ("pass", 0)


@pytest.mark.parametrize(
    ("shell", "part"),
    [
        (open_box(), unit_box(6, 1, 1)),
        (open_box(), unit_box(3.5, 1, 1, edge=0.25)),
        (unit_box(edge=4.0), open_box(1.0)),
        (([(0, 0, 0), (4, 0, 4), (4, 4, 4), (0, 4, 0)], [(0, 1, 2, 3)]), unit_box(2.5, 1, 0.5)),
    ],
    ids=["beside", "held", "the holder is the solid", "flat"],
)
def test_where_nothing_can_be_inside(tmp_path, shell, part):
    finding = only(check(scene_of(tmp_path, shell=shell, part=part)))
    held = finding.reason is not None and "not checked" in finding.reason
    assert held == (part == unit_box(3.5, 1, 1, edge=0.25))


def test_a_broken_clearance_stays_an_error(tmp_path):
    scene = scene_of(tmp_path, shell=open_box(), part=unit_box(1, 1, 1))
    report = check(scene, Settings(clearance=2.0))
    assert (only(report).relation, only(report).severity) == ("near", "error")
    assert "not checked" in only(report).reason
    assert report.summary.verdict == "fail"
