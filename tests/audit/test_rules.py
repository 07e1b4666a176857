"""Rules of a scene, from the pair they are about to the verdict of the check."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import combinations

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.report.report import Finding, Report
from satcheck.scene import Rule, Scene, Selector, load_scene
from tests.audit.shapes import bracket, open_box, placed_scene, pose, scene_of, unit_box, write
from tests.audit.test_kettle import KETTLE, SNOWFLAKE


def rule(a: str = "*", b: str = "*", **keys) -> Rule:
    keys.setdefault("where", "scene.toml:7")
    return Rule(a=Selector(a), b=Selector(b), **keys)


def ruled(scene: Scene, *rules: Rule, **changes) -> Scene:
    return replace(scene, rules=rules, **changes)


def boxes(folder, x: float) -> Scene:
    return scene_of(folder, a=unit_box(), b=unit_box(x))


def only(report: Report) -> Finding:
    (finding,) = report.findings
    return finding


def judgement(report: Report):
    finding = only(report)
    return finding.severity, finding.rule, finding.undecided, report.summary.verdict


def stages(report: Report) -> set[str]:
    return {stage.stage for finding in report.findings for stage in finding.plan}


# The boxes overlap by exactly 0.25.
DEPTHS = {
    "within": (0.5, ("note", "scene.toml:7", None, "pass")),
    "equal": (0.25, ("note", "scene.toml:7", None, "pass")),
    "deeper": (0.2, ("error", "scene.toml:7", None, "fail")),
    "none at all": (0.0, ("error", "scene.toml:7", None, "fail")),
}


@pytest.mark.parametrize("case", DEPTHS)
def test_max_depth(tmp_path, case):
    limit, expected = DEPTHS[case]
    report = check(ruled(boxes(tmp_path, 0.75), rule(max_depth=limit)))
    assert judgement(report) == expected
    assert only(report).depth == 0.25


def test_max_depth_asks_for_the_depth_of_its_pairs_alone(tmp_path):
    write(tmp_path, box=unit_box())
    bodies = [(f"b{k}", "box.obj", pose(0.75 * k)) for k in range(3)]
    scene = ruled(placed_scene(tmp_path, bodies), rule("b0", "b1", max_depth=1.0))
    found = {(f.a, f.b): f.depth for f in check(scene, Settings(depth=False)).findings}
    assert found == {("b0", "b1"): 0.25, ("b0", "b2"): None, ("b1", "b2"): None}


# The depth of the samples is proven to lie between 0.488 and 0.493.
CONCAVE = {0.5: "note", 0.48: "error"}


@pytest.mark.parametrize("limit", CONCAVE)
def test_the_interval_is_narrowed_until_it_is_on_one_side_of_the_limit(limit):
    scene, wide = load_scene([KETTLE, SNOWFLAKE]), Settings(width=0.3)
    low, high = only(check(scene, wide)).depth_bounds
    assert low < 0.48 < 0.5 < high
    report = check(ruled(scene, rule(max_depth=limit)), wide)
    assert judgement(report)[:3] == (CONCAVE[limit], "scene.toml:7", None)
    low, high = only(report).depth_bounds
    assert not low <= limit <= high
    assert only(report).mtv_verified
    assert high == pytest.approx(math.hypot(*only(report).mtv), rel=1e-9)


def test_a_limit_that_the_budget_does_not_decide_leaves_the_check_incomplete(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1, edge=2.0))
    settings = Settings(budget=1e-6)
    low, high = only(check(scene, settings)).depth_bounds
    assert low < high
    report = check(ruled(scene, rule(max_depth=0.5 * (low + high))), settings)
    assert judgement(report) == ("warning", "scene.toml:7", "limit", "incomplete")
    assert report.summary.limits_undecided == 1
    assert "between" in only(report).reason


# The boxes share exactly 0.25.
VOLUMES = {0.3: "note", 0.2: "error"}


@pytest.mark.parametrize("limit", VOLUMES)
def test_max_volume(tmp_path, limit):
    report = check(ruled(boxes(tmp_path, 0.75), rule(max_volume=limit)))
    assert only(report).severity == VOLUMES[limit]
    assert only(report).volume == pytest.approx(0.25)


# Boxes that share little: the estimate is off by more than a limit is granted.
CORNERS = {
    "equal": (Fraction(1, 64) ** 3, ("note", "pass")),
    "just below": (Fraction(1, 64) ** 3 * (1 - Fraction(1, 10**8)), ("error", "fail")),
    "just above": (Fraction(1, 64) ** 3 * (1 + Fraction(1, 10**8)), ("note", "pass")),
}


@pytest.mark.parametrize("case", CORNERS)
def test_a_volume_about_its_limit_is_decided(tmp_path, case):
    limit, (severity, verdict) = CORNERS[case]
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(*[1 - 1 / 64] * 3))
    report = check(ruled(scene, rule(max_volume=float(limit))))
    assert judgement(report) == (severity, "scene.toml:7", None, verdict)
    assert (only(report).volume, only(report).volume_error) == (2**-18, 0.0)


def test_a_volume_that_is_refused_leaves_its_limit_undecided(tmp_path):
    scene = scene_of(tmp_path, a=open_box(edge=1.0), b=unit_box(0.5))
    report = check(ruled(scene, rule(max_volume=0.3)))
    assert judgement(report) == ("warning", "scene.toml:7", "limit", "incomplete")


def test_a_volume_is_not_measured_below_exact(tmp_path):
    report = check(ruled(boxes(tmp_path, 0.75), rule(max_volume=0.3)), Settings(accuracy="hull"))
    assert judgement(report)[2:] == ("limit", "incomplete")
    assert only(report).volume is None


@pytest.mark.parametrize(("volume", "severity"), [(0.3, "note"), (0.2, "error")])
def test_of_two_limits_both_have_to_be_kept(tmp_path, volume, severity):
    report = check(ruled(boxes(tmp_path, 0.75), rule(max_depth=0.5), rule(max_volume=volume)))
    assert only(report).severity == severity


def test_a_clearance_of_its_own(tmp_path):
    write(tmp_path, box=unit_box())
    bodies = [("a", "box.obj", pose()), ("b", "box.obj", pose(1.5)), ("c", "box.obj", pose(-3.0))]
    scene = placed_scene(tmp_path, bodies)
    near = ruled(scene, rule("a", "c", clearance=2.5))
    found = {(f.a, f.b): f for f in check(near).findings}
    assert found["a", "c"].relation == "near"
    assert (found["a", "c"].severity, found["a", "c"].rule) == ("error", "scene.toml:7")
    assert found["a", "c"].distance == 2.0
    assert found["a", "b"].relation == "separated"
    assert found["a", "b"].distance is None
    freed = ruled(scene, rule("a", "b", clearance=0.0))
    found = {(f.a, f.b): f for f in check(freed, Settings(clearance=1.0)).findings}
    assert {f.relation for f in found.values()} == {"separated"}


def test_many_bodies_with_clearances_are_pruned_pair_by_pair(tmp_path):
    """Whatever one pair is asked, the others are pruned as if nobody had asked it."""
    write(tmp_path, box=unit_box())
    bodies = [(f"b{k:02}", "box.obj", pose(3.0 * k)) for k in range(20)]
    scene = placed_scene(tmp_path, bodies)
    report = check(
        ruled(scene, rule("b00", "b19", clearance=100.0), rule("b0?", "b01", tolerance=5))
    )
    assert [(f.a, f.b, f.relation) for f in report.findings] == [
        ("b00", "b01", "touching"),
        ("b00", "b19", "near"),
        ("b01", "b02", "touching"),
        ("b01", "b03", "touching"),
    ]
    assert report.summary.pairs.pruned == 190 - 4


def test_a_tolerance_of_its_own(tmp_path):
    scene = ruled(boxes(tmp_path, 0.99), rule(tolerance=0.02))
    finding = only(check(scene))
    assert (finding.relation, finding.tolerance) == ("touching", 0.02)


@pytest.mark.parametrize(
    ("fail_on", "severity", "verdict"),
    [
        ("error", "error", "fail"),
        ("error", "warning", "pass"),
        ("warning", "warning", "fail"),
        ("warning", "note", "pass"),
        ("note", "note", "fail"),
        ("note", "silenced", "pass"),
    ],
)
def test_severity_and_what_fails(tmp_path, fail_on, severity, verdict):
    asked = "none" if severity == "silenced" else severity
    scene = ruled(boxes(tmp_path, 0.75), rule(severity=asked))
    report = check(scene, Settings(fail_on=fail_on))
    assert judgement(report) == (severity, "scene.toml:7", None, verdict)


@pytest.mark.parametrize("severity", ["none", "note", "error"])
@pytest.mark.parametrize("fail_on", ["error", "warning", "note"])
def test_what_cannot_be_decided_stays_a_warning(tmp_path, severity, fail_on):
    scene = scene_of(tmp_path, a=open_box(), b=unit_box(1, 1, 3.5))
    report = check(ruled(scene, rule(severity=severity)), Settings(fail_on=fail_on))
    assert judgement(report) == ("warning", None, "relation", "incomplete")


def test_what_is_allowed_is_not_looked_at(tmp_path):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(0.5), c=unit_box(0.25))
    report = check(ruled(scene, rule("a", "*", allowed=True), rule("c", "*", allowed=False)))
    pairs = report.summary.pairs
    assert (pairs.total, pairs.allowed, pairs.decided) == (3, 1, 2)
    assert [(f.a, f.b) for f in report.findings] == [("a", "c"), ("b", "c")]


def test_pairs_of_static_bodies_are_asked_where_the_scene_says_so(tmp_path):
    write(tmp_path, box=unit_box())
    scene = placed_scene(tmp_path, [(k, "box.obj", pose(0.25 * i)) for i, k in enumerate("abc")])
    bodies = tuple(replace(body, static=body.id != "c") for body in scene.bodies)
    for check_static, asked in ((True, 3), (False, 2)):
        report = check(replace(scene, bodies=bodies, check_static=check_static))
        assert report.summary.pairs.total == len(report.findings) == asked
        assert report.exempt.static_pairs is not check_static


def test_a_rule_about_no_pair_is_a_warning(tmp_path):
    scene = ruled(boxes(tmp_path, 0.75), rule("a", "nut*", allowed=True), rule(max_depth=1.0))
    (issue,) = check(scene).issues
    assert (issue.code, issue.severity) == ("unused-rule", "warning")
    assert "scene.toml:7" in issue.message


def test_the_counts_add_up_whatever_the_rules(tmp_path):
    write(tmp_path, box=unit_box())
    bodies = [
        (f"b{k}", "box.obj", pose(0.75 * k), "even" if k % 2 == 0 else "odd") for k in range(9)
    ]
    scene = placed_scene(tmp_path, bodies, ignore_within_groups=["odd"])
    rules = [
        rule("group:even", "*", allowed=True),
        rule("b0", "*", allowed=False),
        rule("b2", "b0", allowed=True),
        rule("b3", "b4", max_depth=0.5),
    ]
    for chosen in [c for n in range(5) for c in combinations(rules, n)]:
        pairs = check(ruled(scene, *chosen)).summary.pairs
        assert pairs.total == 30
        assert pairs.total == pairs.pruned + pairs.decided + pairs.allowed + pairs.indeterminate
