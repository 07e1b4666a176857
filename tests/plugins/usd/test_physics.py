"""Colliders, and the rules of USD physics."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path

import pytest

from satcheck.core.shapes import HalfSpace
from satcheck.scene import Scene
from tests.cli.process import satcheck
from tests.plugins.usd.files import bounds_of, cube, load, said, stage

COLLIDER = '"PhysicsCollisionAPI"'


def body(name: str, *content: str, more: str = "") -> str:
    inside = "\n".join(content)
    return (
        f'def Xform "{name}" (\n prepend apiSchemas = ["PhysicsRigidBodyAPI"]\n)\n'
        f"{{\n{more}\n{inside}\n}}\n"
    )


FILTER = '"PhysicsFilteredPairsAPI"'
A, B = body("A", cube("Box", api=COLLIDER)), body("B", cube("Box", api=COLLIDER))
FILTERED = A.replace(
    '"PhysicsRigidBodyAPI"]\n)\n{',
    '"PhysicsRigidBodyAPI", "PhysicsFilteredPairsAPI"]\n)\n{\n rel physics:filteredPairs = </B>',
)


def joint(more: str = "") -> str:
    return (
        'def PhysicsFixedJoint "J" {\n rel physics:body0 = </A>\n rel physics:body1 = </B>\n'
        f"{more}\n}}"
    )


def group(name: str, member: str, more: str = "") -> str:
    return (
        f'def PhysicsCollisionGroup "{name}" {{\n'
        f" rel collection:colliders:includes = <{member}>\n{more}\n}}"
    )


def allowed(scene: Scene) -> dict[tuple[str, str], str]:
    """Pairs that no rule takes back -> the reason why they may overlap."""
    pairs = {}
    for rule in scene.rules:
        chosen = [rule.a.select(scene.bodies), rule.b.select(scene.bodies)]
        for one, other in combinations(scene.bodies, 2):
            if (one in chosen[0] and other in chosen[1]) or (
                other in chosen[0] and one in chosen[1]
            ):
                pairs[one.id, other.id] = rule.reason
    return pairs


@pytest.mark.parametrize("geometry", ["visual", "collision"])
@pytest.mark.parametrize(
    ("prims", "reason"),
    [
        ((A, B), None),
        ((FILTERED, B), "filteredPairs of /A"),
        ((A, B, joint()), "joint /J"),
        ((A, B, joint("bool physics:collisionEnabled = 1")), None),
        ((A, B, joint("bool physics:jointEnabled = 0")), None),
        ((A, B, group("G", "/A", "rel physics:filteredGroups = </H>"), group("H", "/B")),
         "collision groups /G and /H"),
        ((A, B, group("G", "/A"), group("H", "/B")), None),
    ],
)  # fmt: skip
def test_a_pair_that_no_simulator_collides_is_a_rule(
    tmp_path: Path, prims: tuple[str, ...], reason: str | None, geometry: str
) -> None:
    scene = load(tmp_path, stage(*prims), geometry=geometry)
    wanted = {("/A/Box", "/B/Box"): f"USD: {reason}"} if reason else {}
    assert allowed(scene) == wanted


def test_parts_of_one_rigid_body_are_no_pair(tmp_path: Path) -> None:
    one = body("A", cube("L"), cube("R"))
    assert allowed(load(tmp_path, stage(one))) == {("/A/L", "/A/R"): "USD: one rigid body /A"}
    off = body("A", cube("L"), cube("R"), more="bool physics:rigidBodyEnabled = 0")
    assert allowed(load(tmp_path, stage(off))) == {}


def test_each_instance_is_a_rigid_body_of_its_own(tmp_path: Path) -> None:
    instancer = (
        'def PointInstancer "P" {\n rel prototypes = [</P/A>]\n int[] protoIndices = [0, 0]\n'
        " point3f[] positions = [(0,0,0), (9,0,0)]\n" + body("A", cube("L"), cube("R")) + "}"
    )
    assert allowed(load(tmp_path, stage(instancer))) == {
        (f"/P[{i}]:A/L", f"/P[{i}]:A/R"): f"USD: one rigid body /P[{i}]:A" for i in range(2)
    }


def test_colliders_are_bodies_whether_they_are_drawn_or_not(tmp_path: Path) -> None:
    text = stage(
        cube("Drawn"),
        cube("Guide", 'uniform token purpose = "guide"', api=COLLIDER),
        cube("Hidden", 'token visibility = "invisible"', api=COLLIDER),
        cube("Disabled", "bool physics:collisionEnabled = 0", api=COLLIDER),
    )
    assert {one.id for one in load(tmp_path, text, geometry="collision").bodies} == {
        "/Guide",
        "/Hidden",
    }
    assert {one.id for one in load(tmp_path, text).bodies} == {"/Drawn", "/Disabled"}


def test_a_hull_is_computed_and_other_approximations_are_named(tmp_path: Path) -> None:
    api = f'{COLLIDER}, "PhysicsMeshCollisionAPI"'
    hull = cube("Hull", 'uniform token physics:approximation = "convexHull"', api)
    notched = hull.replace("[0,1,3,2,", "[0,1,3,3,")
    assert not load(tmp_path, stage(notched)).bodies[0].file.health.closed
    box = cube("Box", 'uniform token physics:approximation = "sdf"', api)
    scene = load(tmp_path, stage(notched, box), geometry="collision")
    assert scene.bodies[0].file.health.closed
    assert "/Box" in said(scene)["simplified-mesh"]
    assert "sdf" in said(scene)["simplified-mesh"]


@pytest.mark.parametrize("kind", ["boundingCube", "boundingSphere"])
def test_an_approximation_that_reaches_out_of_the_mesh_blocks_a_pass(
    tmp_path: Path, kind: str
) -> None:
    api = f'{COLLIDER}, "PhysicsMeshCollisionAPI"'
    box = cube("Box", f'uniform token physics:approximation = "{kind}"', api)
    assert kind in said(load(tmp_path, stage(box), geometry="collision"))["unread"]
    assert "unread" not in said(load(tmp_path, stage(box)))


def test_a_plane_is_a_half_space_to_a_simulator(tmp_path: Path) -> None:
    plane = 'def Plane "Floor" (\n prepend apiSchemas = ["PhysicsCollisionAPI"]\n)\n{\n}\n'
    scene = load(tmp_path, stage(plane, A), geometry="collision")
    floor = next(body for body in scene.bodies if body.id == "/Floor")
    assert isinstance(floor.shape, HalfSpace)
    assert floor.static
    assert not scene.unreadable


def scattered(*prims: str, more: str = "") -> str:
    """A point instancer with two instances of a prototype of these prims."""
    inside = f'def Xform "Post"\n{{\n{"".join(prims)}}}\n{more}'
    places = (
        "int[] protoIndices = [0, 0]\npoint3f[] positions = [(0,0,0), (0.5,0,0)]\n"
        "rel prototypes = </Scatter/Post>\n"
    )
    return f'def PointInstancer "Scatter"\n{{\n{places}{inside}}}\n'


def excused(scene: Scene) -> set[tuple[str, str]]:
    return {
        (a.id, b.id)
        for rule in scene.rules
        for a in rule.a.select(scene.bodies)
        for b in rule.b.select(scene.bodies)
    }


def test_filtered_pairs_of_a_prototype_hold_within_each_instance(tmp_path: Path) -> None:
    filtered = cube("A", "rel physics:filteredPairs = </Scatter/Post/B>", FILTER)
    scene = load(tmp_path, stage(scattered(filtered, cube("B"))))
    first, second = (f"/Scatter[{k}]:Post" for k in range(2))
    assert excused(scene) == {(f"{one}/A", f"{one}/B") for one in (first, second)}


def test_filtered_pairs_of_a_prototype_and_a_prim_outside(tmp_path: Path) -> None:
    filtered = cube("A", "rel physics:filteredPairs = </Wall>", FILTER)
    scene = load(tmp_path, stage(scattered(filtered), cube("Wall")))
    assert excused(scene) == {(f"/Scatter[{k}]:Post/A", "/Wall") for k in range(2)}
    back = cube("Wall", "rel physics:filteredPairs = </Scatter/Post/A>", FILTER)
    scene = load(tmp_path, stage(scattered(cube("A")), back))
    assert excused(scene) == {("/Wall", f"/Scatter[{k}]:Post/A") for k in range(2)}


def test_filtered_pairs_of_two_prototypes_are_not_applied_and_named(tmp_path: Path) -> None:
    filtered = cube("A", "rel physics:filteredPairs = </Scatter/Rail>", FILTER)
    text = scattered(filtered, more=cube("Rail"))
    text = text.replace("</Scatter/Post>\n", "[</Scatter/Post>, </Scatter/Rail>]\n")
    scene = load(tmp_path, stage(text.replace("protoIndices = [0, 0]", "protoIndices = [0, 1]")))
    assert excused(scene) == set()
    assert "/Scatter/Post/A" in said(scene)["ignored-opinion"]


def test_a_collider_that_joins_what_is_below_cannot_be_checked(tmp_path: Path) -> None:
    merged = f'def Xform "M" (\n prepend apiSchemas = [{COLLIDER}]\n)\n{{\n{cube("A")}}}\n'
    scene = load(tmp_path, stage(merged, cube("B", api=COLLIDER)), geometry="collision")
    assert [lost.id for lost in scene.unreadable] == ["/M"]
    assert list(bounds_of(scene)) == ["/B"]


def test_the_options_of_the_command_reach_the_reader(tmp_path: Path) -> None:
    path = tmp_path / "a.usda"
    moves = (
        "double3 xformOp:translate.timeSamples = {\n 0: (5,0,0),\n 9: (0,0,0)\n }\n"
        'uniform token[] xformOpOrder = ["xformOp:translate"]'
    )
    proxy = cube("Proxy", 'uniform token purpose = "proxy"')
    path.write_text(stage(cube("A"), cube("B", moves), proxy))
    for options, code, bodies in (
        ((), 0, 2),
        (("--read", "time=9"), 1, 2),
        (("--read", "purpose=proxy"), 1, 3),
    ):
        ran = satcheck("--format", "json", *options, str(path))
        assert (ran.code, len(json.loads(ran.out)["bodies"])) == (code, bodies)


@pytest.mark.parametrize("paths", [("box.obj", "cube.off"), ("gripper.glb",), ("building.ifc",)])
def test_a_time_without_a_usd_file_is_refused(paths: tuple[str, ...]) -> None:
    ran = satcheck("--read", "time=9", *paths)
    assert ran.code == 2
    assert "no reader of these files has the option time" in ran.err


def test_the_certificates_of_colliders_are_accepted(tmp_path: Path) -> None:
    path, report = tmp_path / "a.usda", tmp_path / "report.json"
    path.write_text(stage(A, cube("Guide", 'uniform token purpose = "guide"', api=COLLIDER)))
    ran = satcheck(
        "--geometry", "collision", "--certificate", "--format", "json", "-o", str(report), str(path)
    )
    assert ran.code == 1, ran.err
    accepted = satcheck("verify", str(report))
    assert accepted.code == 0, accepted.err


def test_switches_of_rules_count_at_the_time_of_the_check(tmp_path: Path) -> None:
    off = body(
        "W",
        cube("A", api=COLLIDER),
        cube("B", api=COLLIDER),
        more="bool physics:rigidBodyEnabled.timeSamples = {0: 0, 1: 1}",
    )
    assert not load(tmp_path, stage(off), geometry="collision").rules
    assert load(tmp_path, stage(off), geometry="collision", time=1.0).rules
    colliding = joint("bool physics:collisionEnabled.timeSamples = {0: 1, 1: 0}")
    assert not load(tmp_path, stage(A, B, colliding), geometry="collision").rules
    assert load(tmp_path, stage(A, B, colliding), geometry="collision", time=1.0).rules
    loose = joint("bool physics:jointEnabled.timeSamples = {0: 0, 1: 1}")
    assert not load(tmp_path, stage(A, B, loose), geometry="collision").rules


def test_a_switch_that_is_no_truth_blocks_a_pass(tmp_path: Path) -> None:
    one = body("W", cube("A", api=COLLIDER), more='string physics:rigidBodyEnabled = "false"')
    scene = load(tmp_path, stage(one), geometry="collision")
    assert "'false'" in said(scene)["unread"]


def test_an_unknown_expansion_rule_blocks_a_pass(tmp_path: Path) -> None:
    group = (
        'def PhysicsCollisionGroup "G" (\n prepend apiSchemas = ["CollectionAPI:colliders"]\n) {\n'
        ' uniform token collection:colliders:expansionRule = "{}"\n'
        " rel collection:colliders:includes = [</A>]\n}\n"
    )
    boxes = stage(A, group.replace("{}", "explicitOny", 1))
    assert "explicitOny" in said(load(tmp_path, boxes, geometry="collision"))["unread"]
    known = stage(A, group.replace("{}", "explicitOnly", 1))
    assert "unread" not in said(load(tmp_path, known, geometry="collision"))


def test_an_approximation_without_its_api_blocks_a_pass(tmp_path: Path) -> None:
    box = cube("Box", 'uniform token physics:approximation = "convexHull"', COLLIDER)
    scene = load(tmp_path, stage(box), geometry="collision")
    assert "PhysicsMeshCollisionAPI" in said(scene)["unread"]


def test_deformable_bodies_collide_without_the_api_of_colliders(tmp_path: Path) -> None:
    soft = cube("Soft", api='"PhysxDeformableBodyAPI"')
    boxes = stage(cube("Box", api=COLLIDER), soft)
    scene = load(tmp_path, boxes, geometry="collision")
    assert "PhysxDeformableBodyAPI" in said(scene)["unread"]
    assert "unread" not in said(load(tmp_path, boxes))
