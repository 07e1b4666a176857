"""Scene files beside each other: groups are about the bodies of their own file alone, rules about
these and about what has no rules."""

from __future__ import annotations

import pytest

from satcheck.audit import check
from satcheck.scene import Refused, load_scene
from satcheck.scene.rules import Rule
from satcheck.scene.scene_file import joined
from tests.scene.scene_file.scenes import BOX, scene_of, write


def scenes(folder, *rules, groups=("g",), **more):
    """Two scenes of the same two bodies, of which the second has rules, and a mesh file."""
    bodies = [{"id": id_, "shape": BOX, "groups": list(groups)} for id_ in ("a", "b*")]
    return [
        write(folder, scene_of(*bodies, **more), name="one"),
        write(folder, scene_of(*bodies, rules=list(rules), **more), name="two"),
        folder / "cube.obj",
    ]


def pairs_of(scene, rule: Rule) -> set[frozenset[str]]:
    """The pairs that a rule is about, by its definition."""
    return {
        frozenset((x.id, y.id))
        for x in rule.a.select(scene.bodies)
        for y in rule.b.select(scene.bodies)
        if x is not y
    }


@pytest.mark.parametrize("a", ["a", "*", "group:g", "[a]"])
def test_a_rule_is_about_its_own_bodies_and_those_without_rules(tmp_path, a):
    rule = {"a": a, "b": "b*", "allowed": True, "reason": "glued"}
    scene = load_scene(scenes(tmp_path, rule))
    assert [body.id for body in scene.bodies] == ["a", "b*", "a-2", "b*-2", "cube"]
    about = set().union(*(pairs_of(scene, rule) for rule in scene.rules))
    beside = {frozenset(("cube", "b*-2"))} if a == "*" else set()
    assert about == {frozenset(("a-2", "b*-2"))} | beside
    assert {(rule.reason, rule.where.split(":")[0]) for rule in scene.rules} == {
        ("glued", (tmp_path / "two.json").as_posix())
    }


def test_rules_without_bodies_are_about_everybody(tmp_path):
    rule = {"a": "a*", "b": "*", "allowed": True, "reason": "glued"}
    rules = write(tmp_path, scene_of(rules=[rule]), name="rules")
    scene = load_scene([*scenes(tmp_path), rules])
    about = pairs_of(scene, scene.rules[0])
    assert about == {
        frozenset((a, b))
        for a in ("a", "a-2")
        for b in ("a", "b*", "a-2", "b*-2", "cube")
        if a != b
    }


def test_a_rule_about_nobody_stays_to_be_told(tmp_path):
    rule = {"a": "a", "b": "nobody", "allowed": True, "reason": "glued"}
    scene = load_scene(scenes(tmp_path, rule))
    assert [rule.b.text for rule in scene.rules] == ["nobody"]
    issues = check(scene).issues
    assert [issue.code for issue in issues if issue.severity == "warning"] == ["unused-rule"]


def test_a_rule_that_another_file_alone_has_bodies_for_is_told(tmp_path):
    """Rules are about the bodies of their own file: b is no body of it, and not without rules."""
    rule = {"a": "a", "b": "b", "allowed": True, "reason": "glued"}
    first = write(tmp_path, scene_of({"id": "a", "shape": BOX}, rules=[rule]))
    second = write(tmp_path, scene_of({"id": "b", "shape": BOX}), name="second")
    report = check(load_scene([first, second]))
    assert [issue.code for issue in report.issues if issue.severity == "warning"] == ["unused-rule"]
    assert [finding.relation for finding in report.findings] == ["coincident"]


def test_a_rule_that_means_the_same_beside_other_inputs_stays_as_it_is(tmp_path):
    bodies = [{"id": f"arm/{k}", "shape": BOX} for k in range(3)]
    rule = {"a": "arm/*", "b": "arm/*", "clearance": 1}
    path = write(tmp_path, scene_of(*bodies, rules=[rule]))
    (alone,) = load_scene([path]).rules
    (beside,) = load_scene([path, tmp_path / "cube.obj"]).rules
    assert alone == beside
    assert alone.a.text == "arm/*"


def test_groups_of_two_files_are_two_groups(tmp_path):
    paths = scenes(tmp_path, {"a": "group:g", "b": "*", "clearance": 1}, ignore_within_groups=["g"])
    scene = load_scene(paths[:2])
    groups = [body.groups for body in scene.bodies]
    assert groups == [("g",), ("g",), ("g-2",), ("g-2",)]
    assert scene.ignore_within_groups == {"g", "g-2"}


def test_too_many_pairs_are_refused_with_the_rule(tmp_path, monkeypatch):
    monkeypatch.setattr(joined, "MOST_PAIRS", 3)
    with pytest.raises(Refused, match=r"two.json:\d+: beside the other inputs"):
        load_scene(scenes(tmp_path, {"a": "*", "b": "*", "clearance": 1}))
