"""`satcheck suggest`: what it writes can be pasted as it is, and says what it is worth."""

from __future__ import annotations

import json
import re
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from msgspec.structs import replace

from satcheck.audit.suggest import Suggestions
from satcheck.cli.commands.schema import text
from satcheck.cli.formats.suggest import srdf, toml
from satcheck.report.report import Tool
from satcheck.report.suggestions import Suggestion, SuggestionsReport, Unchecked
from satcheck.scene import Selector
from tests.cli.process import SAMPLES, Ran, satcheck
from tests.scene.robot.robots import joint, link, robot_of

PANDA = Path(__file__).parents[1] / "contract" / "data" / "scenes" / "panda"
PACKAGE = ("--package", f"moveit_resources_panda_description={PANDA}")
SAMPLED = ("--sample", "200", "--format", "srdf")
SCENE = """
schema = "satcheck.scene/1"
units = "mm"
[[bodies]]
id = "plate [1]"
shape = {type = "box", size = [10, 10, 2]}
[[bodies]]
id = "bolt"
shape = {type = "box", size = [2, 2, 2]}
position = [0, 0, 1.75]
"""


def tetrahedron(size: int, z: float = 0) -> str:
    """Its corners in OBJ, with the base around the z axis at this height."""
    corners = ((-size, -size, z), (size, -size, z), (0, size, z), (0, 0, z + size))
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners)


def contacts_of(ran: Ran) -> set[tuple[str, str]]:
    return {(one["a"], one["b"]) for one in ran.document["suggestions"] if one["why"] == "contact"}


def report(
    *pairs: Suggestion, poses: int = 0, unchecked: tuple[Unchecked, ...] = ()
) -> SuggestionsReport:
    return SuggestionsReport(
        tool=Tool("satcheck", "0"),
        units="mm",
        poses=poses,
        seed=0 if poses else None,
        held=(),
        suggestions=pairs,
        undecided=0,
        unchecked=unchecked,
    )


def found_of(*pairs: Suggestion, ids: tuple[str, ...] = (), **more: Any) -> Suggestions:
    """ids: of bodies beside those of the pairs."""
    known = dict.fromkeys((*ids, *(name for pair in pairs for name in (pair.a, pair.b))))
    return Suggestions(report(*pairs, **more), {None: tuple(known)}, {}, frozenset(), ())


def written(*named: tuple[str, str, float], ids: tuple[str, ...] = ()) -> list[dict[str, Any]]:
    """The rules about overlaps of these bodies, with this depth, which is also the limit."""
    pairs = [
        Suggestion(
            a, b, "contact", relation="penetrating", depth_bounds=(depth, depth), max_depth=depth
        )
        for a, b, depth in named
    ]
    rules: list[dict[str, Any]] = tomllib.loads(toml(found_of(*pairs, ids=ids), pairs))["rules"]
    return rules


def test_the_rules_can_be_given_beside_the_scene(tmp_path: Path) -> None:
    path = tmp_path / "cell.toml"
    path.write_text(SCENE, encoding="utf-8")
    assert satcheck(str(path)).code == 1
    ran = satcheck("suggest", str(path))
    assert ran.code == 0
    assert "1 pair suggested: confirm" in ran.err
    (rule,) = tomllib.loads(ran.out)["rules"]
    figures = "thickness 0.25 mm, depth 0.25 mm as placed; the limits add 10 %"
    assert rule["reason"] == f"suggested: penetrating, {figures}; confirm"
    assert (rule["max_thickness"], rule["max_depth"]) == (0.275, 0.275)
    assert "allowed" not in rule
    rules = tmp_path / "rules.toml"
    rules.write_text(ran.out, encoding="utf-8")
    ran = satcheck(str(path), str(rules))
    assert ran.code == 0
    assert "PASS" in ran.out
    again = satcheck("suggest", str(path), str(rules))
    nothing = {"schema": "satcheck.scene/1", "units": "mm", "bodies": [], "rules": []}
    assert tomllib.loads(again.out) == nothing


@pytest.mark.parametrize("body", ['say "hi"', "back\\slash", "a*[b]", "tab\there", "\x7f", "Ø"])
def test_any_id_survives_toml(body: str) -> None:
    (rule,) = written((body, "b", 1.0), ids=("other", body))
    assert Selector(rule["a"]).choose(["other", body, rule["a"]]) == (body,)
    assert rule["reason"].startswith("suggested: penetrating, depth 1 mm as placed;")


def test_bytes_that_are_no_text_are_matched() -> None:
    (rule,) = written(("caf\udce9", "b", 1.0))
    assert Selector(rule["a"]).choose(["cafe", "caf\udce9"]) == ["caf\udce9"]


def test_names_that_differ_in_a_number_are_one_rule() -> None:
    bolts = ((f"bolt.{k:03d}", "plate", 1.0 + 0.01 * k) for k in range(9))
    (rule,) = written(*bolts, ids=("nut.001",))
    assert (rule["a"], rule["b"], rule["max_depth"]) == ("bolt.*", "plate", 1.08)
    assert rule["reason"].startswith("suggested: 9 pairs, penetrating, depth 1.08 mm as placed")


def test_both_names_may_differ_in_a_number() -> None:
    pairs = [(f"rail 2 ({i})", f"Schraube M6x20 ({k})", 1.0) for i in range(2) for k in range(3)]
    (rule,) = written(*pairs)
    assert (rule["a"], rule["b"]) == ("rail 2 (*)", "Schraube M6x20 (*)")


@pytest.mark.parametrize(
    ("second", "ids"),
    [
        (1.2, ()),  # its limit is beyond the margin
        (1.0, ("bolt.3",)),  # one that is apart
        (1.0, ("bolt.head",)),
    ],
)
def test_a_pattern_catches_no_other_body_and_no_other_limit(
    second: float, ids: tuple[str, ...]
) -> None:
    rules = written(("bolt.1", "plate", 1.0), ("bolt.2", "plate", second), ids=ids)
    assert [(rule["a"], rule["max_depth"]) for rule in rules] == [("bolt.1", 1), ("bolt.2", second)]


def test_a_pattern_catches_no_other_pair() -> None:
    """Each bolt is in a nut of its own, and apart from the other one."""
    rules = written(("bolt.1", "nut.1", 1.0), ("bolt.2", "nut.2", 1.0))
    assert [(rule["a"], rule["b"]) for rule in rules] == [("bolt.1", "nut.1"), ("bolt.2", "nut.2")]


def test_one_body_is_no_group() -> None:
    (rule,) = written(("bolt.1", "plate", 1.0))
    assert rule["a"] == "bolt.1"


def test_figures_of_other_kinds_are_no_group() -> None:
    """An open mesh has no thickness: its rule can limit the depth alone."""
    closed = Suggestion("bolt.1", "plate", "contact", max_thickness=1.0, max_depth=1.0)
    open_ = Suggestion("bolt.2", "plate", "contact", max_depth=1.0)
    rules = tomllib.loads(toml(found_of(closed, open_), [closed, open_]))["rules"]
    assert ["max_thickness" in rule for rule in rules] == [True, False]


def test_never_says_that_it_is_no_proof() -> None:
    pair = Suggestion("a", "b", "never", contacts=0)
    (rule,) = tomllib.loads(toml(found_of(pair, poses=1000), [pair]))["rules"]
    assert "never in contact in 1,000 random poses, which is no proof" in rule["reason"]


def test_an_srdf_for_a_robot(tmp_path: Path) -> None:
    path = tmp_path / "arm.srdf"
    options = ("--sample", "30", "--never", "--format", "srdf", "-o", str(path))
    ran = satcheck("suggest", "arm.urdf", *options)
    assert ran.code == 0, ran.err
    root = ElementTree.fromstring(path.read_text(encoding="utf-8"))
    reasons = {(e.get("link1"), e.get("link2")): e.get("reason") for e in root}
    assert reasons["base", "turret"] == "Adjacent"
    assert ("left", "right") not in reasons  # they touch as placed, and not in all poses
    assert reasons["turret", "left"] == "Never"
    assert ("base", "upper") not in reasons
    assert len(reasons) == len(list(root))
    touching = [
        json.loads(satcheck("arm.urdf", *more, "--format", "json").out)["summary"]["by_relation"]
        for more in ((), (str(path),))
    ]
    assert touching[0]["touching"] > 0
    assert touching[1]["touching"] == 1  # of left and right
    base = '<disable_collisions link1="base" link2="turret" reason="Adjacent"/>'
    assert f"  {base} <!-- a joint connects them, touching as placed, in contact in 30 of" in (
        path.read_text(encoding="utf-8")
    )


def test_only_links_that_always_meet_are_the_default(tmp_path: Path) -> None:
    """Of the Panda, link5 and link7 meet as placed, and in one pose of eleven; MoveIt checks them.
    A base around the links of a robot meets all of them in all poses."""
    ran = satcheck("suggest", str(PANDA / "panda.urdf"), *PACKAGE, *SAMPLED, "-o", "-")
    assert ran.code == 0, ran.err
    lines = {
        (e.get("link1"), e.get("link2")): e.get("reason") for e in ElementTree.fromstring(ran.out)
    }
    assert "Default" not in lines.values()
    assert ("panda_link5", "panda_link7") not in lines
    ours = satcheck("suggest", str(PANDA / "panda.urdf"), *PACKAGE, "--sample", "200")
    (rule,) = [
        rule
        for rule in tomllib.loads(ours.out)["rules"]
        if (rule["a"], rule["b"]) == ("panda_link5", "panda_link7")
    ]
    assert "allowed" not in rule
    assert re.search(r"in contact in \d\d of 200 random poses", rule["reason"])

    shape = '<collision><geometry><box size="{} 1 1"/></geometry></collision>'
    turn = '<axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
    links = [link(name, shape.format(size)) for name, size in (("base", 9), ("mid", 1), ("tip", 1))]
    joints = [
        joint("j", "base", "mid", "revolute", turn),
        joint("k", "mid", "tip", "revolute", turn),
    ]
    (tmp_path / "r.urdf").write_text(robot_of(*links, *joints), encoding="utf-8")
    ran = satcheck("suggest", str(tmp_path / "r.urdf"), *SAMPLED)
    assert '"base" link2="tip" reason="Default"/> <!-- ' in ran.out
    assert "in contact in 200 of 200 random poses -->" in ran.out


def test_a_link_pair_that_may_meet_is_not_called_never() -> None:
    pair = Suggestion("a/1", "b", "never", ("a", "b"), contacts=0)
    found = found_of(pair, poses=10)
    assert "Never" in srdf(found, [pair], "arm")
    met = replace(found, may_meet=frozenset({frozenset(("a", "b"))}))
    assert srdf(met, [pair], "arm") == '<robot name="arm">\n</robot>\n'


def test_what_was_not_checked_is_not_suggested(tmp_path: Path) -> None:
    """The mesh of the arm is missing."""
    limit = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
    shape = "<collision><geometry>{}</geometry></collision>"
    robot = robot_of(
        link("base", shape.format('<box size="1 1 1"/>')),
        link("arm", shape.format('<mesh filename="gone.stl"/>')),
        link("tip", shape.format('<box size="1 1 1"/>')),
        joint("j", "base", "arm", "revolute", limit),
        joint("k", "base", "tip", "revolute", limit),
    )
    (tmp_path / "r.urdf").write_text(robot, encoding="utf-8")
    ran = {
        form: satcheck("suggest", str(tmp_path / "r.urdf"), "--sample", "2", "--format", form)
        for form in ("srdf", "toml", "json")
    }
    for one in ran.values():
        assert one.code == 2
        assert "1 pair suggested" in one.err
        assert "Not suggested, as not checked: 1 pair with a joint between" in one.err
    (line,) = ElementTree.fromstring(ran["srdf"].out)
    assert (line.get("link1"), line.get("link2")) == ("base", "tip")
    why = "a joint connects them, but they could not be checked: "
    assert f"<!-- not suggested: base and arm: {why}" in ran["srdf"].out
    (rule,) = tomllib.loads(ran["toml"].out)["rules"]
    assert (rule["a"], rule["b"]) == ("base", "tip")
    assert f"\n# not suggested: base and arm: {why}" in ran["toml"].out
    Draft202012Validator(json.loads(text("suggestions"))).validate(ran["json"].document)
    assert [one["b"] for one in ran["json"].document["suggestions"]] == ["tip"]
    unchecked = ran["json"].document["unchecked"]
    assert [(one["a"], one["b"], one["adjacent"]) for one in unchecked] == [
        ("base", "arm", True),
        ("arm", "tip", False),
    ]


def test_two_links_with_a_pair_that_was_not_checked_have_no_line() -> None:
    met = Suggestion("a/1", "b", "always", ("a", "b"), relation="touching")
    lost = Unchecked("a/2", "b", adjacent=False, links=("a", "b"), reason="no -- file\n")
    found = found_of(met, unchecked=(lost,))
    text_ = srdf(found, [met], "arm")
    assert list(ElementTree.fromstring(text_)) == []
    assert "<!-- not suggested: a/2 and b: they could not be checked: no - - file? -->" in text_


def test_a_mesh_outside_is_read_with_leave(tmp_path: Path) -> None:
    text_ = (SAMPLES / "arm.urdf").read_text().replace('filename="', f'filename="{SAMPLES}/')
    (tmp_path / "arm.urdf").write_text(text_)
    refused = satcheck("suggest", str(tmp_path / "arm.urdf"))
    assert refused.code == 2
    assert "--allow-outside" in refused.err
    assert satcheck("suggest", "--allow-outside", str(tmp_path / "arm.urdf")).code == 0


def test_a_mesh_is_taken_apart() -> None:
    alone = satcheck("suggest", "rack.3mf", "--split", "none")
    assert alone.err.rstrip().endswith("--split components")
    ran = satcheck("suggest", "rack.3mf", "--split", "components")
    assert ran.code == 0, ran.err


def test_a_state_places_the_robot_and_stays_in_random_poses() -> None:
    still = satcheck("suggest", "arm.urdf", "arm.srdf", "--state", "folded", "--format", "json")
    at_rest = satcheck("suggest", "arm.urdf", "arm.srdf", "--format", "json")
    assert contacts_of(still) > contacts_of(at_rest)
    given = ("--state", "folded", "--sample", "5")
    ran = satcheck("suggest", "arm.urdf", "arm.srdf", *given, "--format", "json")
    assert ran.document["held"] == ["elbow"]
    ran = satcheck("suggest", "arm.urdf", "arm.srdf", *given)
    assert "of 5 random poses with 1 joint held" in ran.out


def test_given_poses_are_not_called_random() -> None:
    ran = satcheck("suggest", "arm.urdf", "--pose", "arm_poses.json", "--never")
    assert ran.code == 0, ran.err
    poses = len(json.loads((SAMPLES / "arm_poses.json").read_text()))
    assert f"never in contact in {poses} poses, which is no proof" in ran.out
    assert "random" not in ran.out + ran.err


def test_never_has_to_be_asked_for() -> None:
    ran = satcheck("suggest", "arm.urdf", "--sample", "30", "--seed", "2")
    assert "never" not in ran.out
    assert "never met in 30 random poses, which proves nothing: --never" in ran.err


def test_json_follows_its_schema() -> None:
    ran = satcheck("suggest", "arm.urdf", "--sample", "5", "--format", "json")
    Draft202012Validator(json.loads(text("suggestions"))).validate(ran.document)
    assert {one["why"] for one in ran.document["suggestions"]} >= {"adjacent", "never"}
    assert (ran.document["poses"], ran.document["seed"]) == (5, 0)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ((), "give two or more mesh files"),
        (("cell.toml", "--format", "srdf"), "about one robot"),
        (("cell.toml", "--sample", "3"), "no robot to pose"),
        (("arm.urdf", "--seed", "3"), "add --sample"),
    ],
)
def test_wrong_usage(arguments: tuple[str, ...], complaint: str) -> None:
    ran = satcheck("suggest", *arguments)
    assert ran.code == 2
    assert complaint in ran.err
    assert ran.out == ""


def test_an_unreadable_body_is_an_error(tmp_path: Path) -> None:
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 nan\nf 1 1 1\n", encoding="utf-8")
    assert satcheck("suggest", "box.obj", str(broken)).code == 2


def test_what_is_undecided_makes_it_incomplete(tmp_path: Path) -> None:
    """A tetrahedron in the hole where a tent has no floor."""
    (tmp_path / "tent.obj").write_text(tetrahedron(9) + "f 1 2 4\nf 2 3 4\nf 3 1 4\n")
    (tmp_path / "seed.obj").write_text(
        tetrahedron(1, -0.5) + "f 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n"
    )
    ran = satcheck("suggest", *(str(tmp_path / name) for name in ("tent.obj", "seed.obj")))
    assert ran.code == 3
    assert "\nNot decided: tent and seed: the hole of tent, in a box" in ran.err
