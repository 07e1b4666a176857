"""Overlaps of links that no joint connects, as the rule of the validator finds them."""

from __future__ import annotations

import ast
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from pxr import Gf, Sdf, Usd

from satcheck.plugins.usd.links import link_problems
from satcheck.scene.errors import Refused
from tests.plugins.usd.files import at, cube, stage

ROOT = Path(__file__).parents[3]
COLLIDER = '"PhysicsCollisionAPI"'
PAIR = ("/Robot/Link1/col", "/Robot/Link3/col")


def link(name: str, x: float, *content: str, api: str = "", more: str = "") -> str:
    inside = "\n".join(content or (cube("col", api=COLLIDER),))
    schemas = ", ".join(filter(None, ('"PhysicsRigidBodyAPI"', api)))
    head = f"prepend apiSchemas = [{schemas}]"
    return f'def Xform "{name}" ({head})\n{{\n{at(x)}\n{more}\n{inside}\n}}\n'


def joint(a: str, b: str, more: str = "") -> str:
    ends = f"rel physics:body0 = </Robot/{a}>\n rel physics:body1 = </Robot/{b}>"
    return f'def PhysicsRevoluteJoint "{a}_{b}" {{\n {ends}\n {more}\n}}'


CHAIN = joint("Link1", "Link2"), joint("Link2", "Link3")


def opened(*inside: str, beside: str = "", unit: str = "1") -> Any:
    """A stage in memory whose default prim, /Robot, holds these."""
    robot = 'def Xform "Robot" {\n' + "\n".join(inside) + "\n}"
    head = f'metersPerUnit = {unit}\nupAxis = "Z"\ndefaultPrim = "Robot"'
    layer = Sdf.Layer.CreateAnonymous(".usda")
    assert layer.ImportFromString(stage(robot, beside, head=head))
    return Usd.Stage.Open(layer)


def overlapping(third: str = "", *more: str) -> Any:
    """Link1 and Link3, which no joint connects, share 0.25 m; each overlaps Link2."""
    return opened(link("Link1", 0), link("Link2", 0.9), third or link("Link3", 0.75), *CHAIN, *more)


def pairs(stage: Any) -> list[tuple[str, ...]]:
    """The pairs of colliders that overlap; nothing is left open."""
    found = link_problems(stage)
    assert not any(problem.stops for problem in found), found
    return [problem.bodies for problem in found]


def left_open(stage: Any) -> list[tuple[tuple[str, ...], str]]:
    """The bodies, and what is said, of problems that stop a pass; no overlap is found."""
    found = link_problems(stage)
    assert all(problem.stops for problem in found), found
    return [(problem.bodies, problem.message) for problem in found]


def test_links_that_no_joint_connects_may_not_overlap() -> None:
    (problem,) = link_problems(overlapping())
    assert problem.bodies == PAIR
    assert (problem.level, problem.stops) == ("error", False)
    assert f"{PAIR[0]} and {PAIR[1]} overlap" in problem.message
    assert "0.25 m" in problem.message


def test_links_of_a_joint_may_overlap_even_if_it_lets_them_collide() -> None:
    colliding = "bool physics:collisionEnabled = true"
    links = link("Link1", 0), link("Link2", 0.9), link("Link3", 1.8)
    joints = joint("Link1", "Link2", colliding), joint("Link2", "Link3")
    assert pairs(opened(*links, *joints)) == []
    assert len(pairs(opened(*links))) == 2


def test_links_that_are_apart_or_touch_are_no_problem() -> None:
    for step in (2, 1):
        links = (link(f"Link{k}", step * k) for k in range(3))
        assert pairs(opened(*links)) == []


def test_pairs_that_a_simulator_does_not_collide_are_no_problem() -> None:
    filtered = "rel physics:filteredPairs = </Robot/Link1>"
    third = link("Link3", 0.75, api='"PhysicsFilteredPairsAPI"', more=filtered)
    assert pairs(overlapping(third)) == []
    group = (
        'def PhysicsCollisionGroup "G" {\n rel collection:colliders:includes = </Robot>\n'
        " rel physics:filteredGroups = </Robot/G>\n}"
    )
    assert pairs(overlapping("", group)) == []
    two = cube("a", api=COLLIDER) + cube("b", api=COLLIDER)
    assert pairs(opened(link("Link1", 0, two))) == []


def test_only_links_below_the_default_prim_count() -> None:
    ground = cube("Ground", at(0.5), api=COLLIDER)
    assert pairs(opened(link("Link1", 0), ground)) == []
    prop = link("Prop", 0.5)
    assert pairs(opened(link("Link1", 0), beside=prop)) == []
    everywhere = opened(link("Link1", 0), beside=prop)
    everywhere.ClearDefaultPrim()
    assert pairs(everywhere) == [("/Robot/Link1/col", "/Prop/col")]


def test_a_pair_that_a_hole_leaves_undecided_is_left_open() -> None:
    holed = overlapping()
    for name in ("Link1", "Link3"):
        mesh = holed.GetPrimAtPath(f"/Robot/{name}/col")
        mesh.GetAttribute("faceVertexCounts").Set([4] * 5)
        corners = list(mesh.GetAttribute("faceVertexIndices").Get())
        mesh.GetAttribute("faceVertexIndices").Set(corners[:4] + corners[8:])
    ((bodies, message),) = left_open(holed)
    assert bodies == PAIR
    assert "undecided" in message


def test_a_collider_that_is_not_read_is_left_open_and_the_others_are_checked() -> None:
    patch = f'def NurbsPatch "patch" (prepend apiSchemas = [{COLLIDER}])\n{{\n}}\n'
    found = link_problems(overlapping("", link("Link4", 9, patch)))
    assert [each.bodies for each in found if not each.stops] == [PAIR]
    unread = [each for each in found if each.stops and each.bodies == ("/Robot/Link4/patch",)]
    assert "NurbsPatch is not read" in unread[0].message


def test_what_may_be_a_collider_is_left_open() -> None:
    lost = 'def Xform "Lost" (prepend references = @gone.usda@)\n{\n}\n'
    found = left_open(opened(link("Link1", 0), link("Link2", 5), lost))
    assert any("gone.usda" in message for _, message in found)
    ops = 'def Xform "X" (prepend apiSchemas = ["OddAPI"])\n{\n' + link("L", 9) + "}\n"
    ((bodies, message),) = left_open(opened(link("Link1", 0), link("Link2", 5), ops))
    assert bodies == ()
    assert "OddAPI is not read" in message


def test_without_colliders_there_is_nothing_to_say() -> None:
    assert link_problems(Usd.Stage.CreateInMemory()) == []
    drawn = cube("Box"), cube("Other")
    assert link_problems(opened(*drawn)) == []
    assert link_problems(opened(*drawn, unit="0")) == []
    off = cube("col", "bool physics:collisionEnabled = false", api=COLLIDER)
    assert link_problems(opened(link("Link1", 0, off), link("Link2", 0, off))) == []


def test_a_stage_that_cannot_be_read_is_an_error() -> None:
    with pytest.raises(Refused, match="metersPerUnit is 0"):
        link_problems(opened(link("Link1", 0), unit="0"))


def test_edits_that_are_not_saved_count(tmp_path: Path) -> None:
    file = tmp_path / "robot.usda"
    clean = overlapping(link("Link3", 2.5))
    clean.GetRootLayer().Export(str(file))
    saved = Usd.Stage.Open(str(file))
    assert pairs(saved) == []
    moved = saved.GetPrimAtPath("/Robot/Link3").GetAttribute("xformOp:translate")
    with Usd.EditContext(saved, saved.GetSessionLayer()):
        moved.Set(Gf.Vec3d(0.5, 0, 0))
    assert pairs(saved) == [PAIR]
    saved.GetSessionLayer().Clear()
    assert pairs(saved) == []
    moved.Set(Gf.Vec3d(0.5, 0, 0))
    assert pairs(saved) == [PAIR]


def test_the_variant_that_the_stage_selects_counts() -> None:
    variants = "".join(
        f'"{name}" {{\n{link("Link3", x)}}}\n' for name, x in (("far", 5), ("in", 0.5))
    )
    held = (
        'def Xform "Held" (\n prepend variantSets = "place"\n'
        ' variants = {\n string place = "far"\n }\n)\n{\n'
        f' variantSet "place" = {{\n{variants} }}\n}}\n'
    )
    robot = opened(link("Link1", 0), held)
    assert pairs(robot) == []
    with Usd.EditContext(robot, robot.GetSessionLayer()):
        robot.GetPrimAtPath("/Robot/Held").GetVariantSet("place").SetVariantSelection("in")
    assert pairs(robot) == [("/Robot/Link1/col", "/Robot/Held/Link3/col")]


def test_the_entry_point_names_the_plugin() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    module, _, name = project["entry-points"]["usd_validation_nvidia"]["satcheck"].partition(":")
    file = ROOT / Path(*module.removeprefix("satcheck.").split(".")).with_suffix(".py")
    classes = {
        each.name for each in ast.parse(file.read_text()).body if isinstance(each, ast.ClassDef)
    }
    assert name in classes
    assert not any("validation" in needed for needed in project["dependencies"])
    extras = project["optional-dependencies"].values()
    assert not any("validation" in needed for extra in extras for needed in extra)


@pytest.fixture
def issues() -> Iterator[Any]:
    """What the validator of NVIDIA finds with our rule in a stage, and under which requirement."""
    nvidia = pytest.importorskip(
        "usd_validation_nvidia", reason="the validator, which is no dependency, is not installed"
    )
    from satcheck.plugins.usd.validator import NonAdjacentCollidersOverlap, Plugin

    plugin = Plugin()
    plugin.on_startup()

    def found(stage: Any) -> list[tuple[str, str, str]]:
        engine = nvidia.ValidationEngine(init_rules=False, variants=False)
        engine.enable_rule(NonAdjacentCollidersOverlap)
        issues = engine.validate(stage).issues()
        return [(each.severity.name, each.message, each.at.as_str()) for each in issues]

    yield found
    plugin.on_shutdown()
    assert NonAdjacentCollidersOverlap not in nvidia.CategoryRuleRegistry().rules


def test_the_validator_runs_the_rule(issues: Any) -> None:
    ((severity, message, place),) = issues(overlapping())
    assert severity == "FAILURE"
    assert "/Robot/Link1/col and /Robot/Link3/col overlap" in message
    assert "/Robot/Link1/col" in place
    assert issues(overlapping(link("Link3", 2.5))) == []


def test_the_validator_warns_of_what_is_undecided(issues: Any) -> None:
    lost = 'def Xform "Lost" (prepend references = @gone.usda@)\n{\n}\n'
    found = issues(opened(link("Link1", 0), link("Link2", 5), lost))
    assert found
    assert {severity for severity, _, _ in found} == {"WARNING"}


def test_the_validator_goes_on_after_a_stage_that_cannot_be_read(issues: Any) -> None:
    ((severity, message, _),) = issues(opened(link("Link1", 0), unit="0"))
    assert severity == "FAILURE"
    assert "metersPerUnit is 0" in message


def test_the_rule_takes_the_requirement_whenever_it_is_defined(issues: Any) -> None:
    import usd_validation_nvidia as nvidia

    from satcheck.plugins.usd.validator import NonAdjacentCollidersOverlap

    class Placeholder(nvidia.BaseRuleChecker):  # type: ignore[misc]
        pass

    class Definition:
        code, version, display_name = "com.nvidia.simready.BA.002", "9.0.0", "BA.002"
        message = path = ""
        compatibility, validator, tags, parameters, examples = "", None, (), (), ()

    requirement = Definition()
    registry = nvidia.RequirementsRegistry()
    for _ in range(2):  # simready-validate does so each time
        nvidia.register_requirements(requirement, override=True)(Placeholder)
        assert registry.get_validator(requirement) is NonAdjacentCollidersOverlap
        assert [severity for severity, *_ in issues(overlapping())] == ["FAILURE"]
        del registry[registry.create_key(requirement)]
