"""What a URDF says, and each way in which it can be wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.core.shapes import Box, Capsule, Cylinder, HalfSpace, Sphere
from satcheck.scene.robot.model import Limits, MeshReference, Mimic, Refusal
from tests.scene.robot.robots import (
    BOX,
    SAMPLES,
    joint,
    link,
    read,
    read_robot,
    read_with_issues,
    refusal,
    robot_of,
)

LIMIT = '<limit lower="-1" upper="2"/>'


def geometry(shape: str, beside: str = "") -> str:
    return link("a", f"<collision>{beside}<geometry>{shape}</geometry></collision>")


def test_the_sample() -> None:
    robot, issues = read_robot(SAMPLES / "arm.urdf", "arm.urdf")
    assert (robot.name, list(robot.roots), issues) == ("arm", ["base"], ())
    assert [j.name for j in robot.joints][:4] == ["turn", "shoulder", "elbow", "grip"]
    assert {j.name: j.kind for j in robot.joints if j.free} == {
        "turn": "continuous",
        "shoulder": "revolute",
        "elbow": "revolute",
        "grip": "prismatic",
    }
    (right,) = (j for j in robot.joints if j.name == "grip_right")
    assert right.mimic == Mimic("grip", -1.0, 0.0)
    assert right.limits == Limits(-0.1875, 0.0)
    assert [one.name for one in robot.links["fore"].collisions] == ["beam", "palm"]
    assert robot.links["right"].collisions[0].geometry == MeshReference(
        "arm_finger.obj", (1.0, -1.0, 1.0)
    )
    assert robot.links["camera"].unused
    assert not robot.links["camera"].collisions


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        ('<box size="1 2 3"/>', Box((1.0, 2.0, 3.0))),
        ('<sphere radius="2"/>', Sphere(2.0)),
        ('<cylinder radius="1" length="3"/>', Cylinder(1.0, 3.0)),
        ('<capsule radius="1" length="3"/>', Capsule(1.0, 3.0)),
        ('<mesh filename="x.stl"/>', MeshReference("x.stl", (1.0, 1.0, 1.0))),
        ('<mesh filename="x.stl" scale="1 -1 .5e-3"/>', MeshReference("x.stl", (1.0, -1.0, 5e-4))),
    ],
)
def test_shapes(tmp_path: Path, shape: str, expected: object) -> None:
    assert read(tmp_path, robot_of(geometry(shape))).links["a"].collisions[0].geometry == expected


def test_a_plane_is_a_half_space_along_its_normal(tmp_path: Path) -> None:
    plane = (
        '<collision><origin xyz="0 0 2" rpy="0 0 0"/><geometry><plane normal="0 -3 0"/></geometry>'
        "</collision>"
    )
    robot = read(tmp_path, robot_of(link("floor", plane)))
    (part,) = robot.links["floor"].collisions
    assert part.geometry == HalfSpace()
    assert (part.origin[2::4][:3], part.origin[3::4][:3]) == ((0, -1, 0), (0, 0, 2))
    path = tmp_path / "drawn.urdf"
    path.write_text(robot_of(link("floor", plane.replace("collision>", "visual>"))))
    drawn, _ = read_robot(path, geometry="visual")
    assert isinstance(drawn.links["floor"].collisions[0].geometry, Refusal)
    for wrong in ('normal="0 0 0"', ""):
        text = robot_of(link("floor", plane.replace('normal="0 -3 0"', wrong)))
        (part,) = read(tmp_path, text).links["floor"].collisions
        assert isinstance(part.geometry, Refusal)


def test_a_shape_that_is_not_read_is_no_reason_to_refuse_the_robot(tmp_path: Path) -> None:
    robot = read(tmp_path, robot_of(geometry("<torus/>")))
    shape = robot.links["a"].collisions[0].geometry
    assert isinstance(shape, Refusal)
    assert shape.code == "unsupported-feature"
    assert shape.message.startswith("<torus>: ")
    assert robot.links["a"].collisions[0].line == 2


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        ('<sphere radius="1"/><sphere radius="1"/>', "should hold one shape, not 2"),
        ('<box size="1 2"/>', 'size="1 2" should be 3 numbers'),
        ('<box size="1 2 nan"/>', 'size="nan" is not a finite number'),
        ('<box size="1 2 1e999"/>', 'size="1e999" is not a finite number'),
        ('<box size="1 2 1_0"/>', 'size="1_0" is not a finite number'),
        ('<box size="1,0 2 3"/>', 'size="1,0" is not a finite number'),
        ('<box size="1 2 0"/>', "should be positive"),
        ('<cylinder radius="0" length="1"/>', "should be positive"),
        ('<sphere radius="x"/>', "is not a finite number"),
        ('<box sise="1 2 3"/>', 'attribute "size" is missing'),
        ("<box/>", 'attribute "size" is missing'),
        ('<sphere radius="-1"/>', "should be positive"),
        ('<cylinder radius="1"/>', 'attribute "length" is missing'),
        ("<mesh/>", 'attribute "filename" is missing'),
        ('<mesh filename="a.stl" scale="1 0 1"/>', "scale 0 flattens the mesh"),
        ('<mesh filename="a.stl" scale="2"/>', 'scale="2" should be 3 numbers'),
    ],
)
def test_a_wrong_shape_costs_its_body_only(tmp_path: Path, shape: str, said: str) -> None:
    robot = read(tmp_path, robot_of("", geometry(shape), link("b"), joint("j", "a", "b")))
    assert isinstance(robot.links["b"].collisions[0].geometry, Box)
    found = robot.links["a"].collisions[0].geometry
    assert isinstance(found, Refusal)
    assert robot.links["a"].collisions[0].line == 3
    assert said in found.message


@pytest.mark.parametrize(
    ("collision", "said"),
    [
        ("<collision/>", "a <collision> without geometry: no body"),
        ("<collision><geometry/></collision>", "a <collision> without geometry: no body"),
        (geometry('<box size="0 0 0"/>')[len('<link name="a">') : -7], "a <box> of size 0"),
        (geometry('<sphere radius="0.0"/>')[len('<link name="a">') : -7], "a <sphere> of size 0"),
    ],
)
def test_what_has_no_extent_has_no_body(tmp_path: Path, collision: str, said: str) -> None:
    robot, issues = read_with_issues(tmp_path, robot_of(link("a", collision + collision)))
    assert robot.links["a"].collisions == ()
    (found,) = issues
    assert found.code == "no-shape"
    assert found.severity == "warning"
    assert found.message.startswith("line 2: ")
    assert said in found.message
    assert found.message.endswith("(2 times)")


def test_a_misspelt_geometry_is_not_passed_over(tmp_path: Path) -> None:
    text = robot_of(link("a", '<collision><geometri><box size="1 1 1"/></geometri></collision>'))
    found = read(tmp_path, text).links["a"].collisions[0].geometry
    assert isinstance(found, Refusal)
    assert "unknown geometri (did you mean geometry?)" in found.message
    text = robot_of(link("a", '<collision><shape><box size="1 1 1"/></shape></collision>'))
    robot, issues = read_with_issues(tmp_path, text)
    found = robot.links["a"].collisions[0].geometry
    assert isinstance(found, Refusal)
    assert "<geometry> is missing" in found.message
    assert [issue.code for issue in issues] == ["unread"]


@pytest.mark.parametrize("inside", ["a.stl", "<geometry>box 2 2 2</geometry>"])
def test_a_shape_in_words_is_not_passed_over(tmp_path: Path, inside: str) -> None:
    text = robot_of(link("a", f"<collision>{inside}</collision>"))
    found = read(tmp_path, text).links["a"].collisions[0].geometry
    assert isinstance(found, Refusal)
    assert found.message.endswith("should hold one shape, not 0")


@pytest.mark.parametrize(
    ("origin", "said"),
    [
        ('<origin xyz="1 2 3 4"/>', "should be 3 numbers"),
        ('<origin xzy="1 2 3"/>', "unknown xzy (did you mean xyz?)"),
        ('<origin rpy="0 0 inf"/>', 'rpy="inf" is not a finite number'),
        ('<origin rpy="0 0 0" quat_xyzw="0 0 0 1"/>', "both rpy and quat_xyzw"),
        ('<origin quat_xyzw="0 0 0 0"/>', "length 0"),
        ('<origin xyz="1 2 3"/><origin/>', "a second <origin> in one <collision>"),
    ],
)
def test_wrong_origins(tmp_path: Path, origin: str, said: str) -> None:
    text = robot_of(geometry('<box size="1 1 1"/>', origin))
    found = read(tmp_path, text).links["a"].collisions[0].geometry
    assert isinstance(found, Refusal)
    assert said in found.message
    text = robot_of(link("a"), link("b"), joint("j", "a", "b", inside=origin))
    assert said.replace("collision", "joint") in refusal(tmp_path, text)[1]


@pytest.mark.parametrize(
    ("kind", "inside", "said"),
    [
        ("hinge", "", "type 'hinge' is none of revolute, continuous, prismatic"),
        ("revolute", LIMIT + '<axis xyz="0 0 0"/>', "an axis of length 0"),
        ("revolute", LIMIT + '<axis xyz="0 1"/>', "should be 3 numbers"),
        ("planar", '<mimic joint="k"/>', "a planar joint cannot mimic"),
        ("floating", '<mimic joint="k"/>', "a floating joint cannot mimic"),
        ("revolute", LIMIT + "<mimic/>", 'attribute "joint" is missing'),
        ("revolute", LIMIT + '<limit lower="0" upper="2"/>', "a second <limit> in one <joint>"),
    ],
)
def test_wrong_joints(tmp_path: Path, kind: str, inside: str, said: str) -> None:
    text = robot_of(link("a"), link("b"), joint("j", "a", "b", kind, inside))
    code, message = refusal(tmp_path, text)
    assert code == "bad-robot"
    assert message.startswith("line 4: <")
    assert said in message


@pytest.mark.parametrize(
    ("kind", "inside", "code", "said"),
    [
        ("revolute", "", "no-limits", "a revolute joint without <limit>: treated as unlimited"),
        ("prismatic", "", "no-limits", "a prismatic joint without <limit>"),
        ("revolute", '<limit lower="2" upper="1"/>', "no-limits", "lower is above upper"),
        ("revolute", LIMIT + '<axis xyz="0 0 1" rpy="0 0 1"/>', "unread", "<axis>: rpy is not"),
        ("revolute", LIMIT + '<mimic joint="gone"/>', "no-leader", "mimics a missing joint"),
    ],
)
def test_slips_of_joints_are_warnings(
    tmp_path: Path, kind: str, inside: str, code: str, said: str
) -> None:
    joints = [joint("j", "a", "b", kind, inside), joint("k", "b", "c", kind, inside)]
    robot, issues = read_with_issues(tmp_path, robot_of(*map(link, "abc"), *joints))
    (found,) = issues
    assert (found.code, found.severity) == (code, "warning")
    assert found.message.startswith("line 5: ")
    assert said in found.message
    assert found.message.endswith("(2 times)")
    assert robot.joints[0].free
    if code == "no-limits":
        assert robot.joints[0].limits is None


def test_a_leader_that_is_not_there_matters_where_the_offset_does(tmp_path: Path) -> None:
    mimic = LIMIT + '<mimic joint="gone" offset="0.5"/>'
    text = robot_of(link("a"), link("b"), joint("j", "a", "b", "revolute", mimic))
    assert refusal(tmp_path, text) == (
        "index-out-of-range",
        "line 4: <mimic>: mimics joint 'gone', which does not exist",
    )


def test_what_is_said_twice_in_the_same_words_is_said_once(tmp_path: Path) -> None:
    axis = '<axis xyz="0 1 0"/>'
    text = robot_of(link("a"), link("b"), joint("j", "a", "b", "continuous", axis + axis))
    assert read(tmp_path, text).joints[0].axis == (0.0, 1.0, 0.0)


def test_lines_before_the_declaration_do_not_matter(tmp_path: Path) -> None:
    text = "\n\n<?xml version='1.0'?>\n" + robot_of(link("a"))
    assert list(read(tmp_path, text).roots) == ["a"]
    text = "\n\n<?xml version='1.0'?>\n" + robot_of(link("a"), link("a"))
    assert refusal(tmp_path, text)[1].startswith("line 6: ")


def test_a_joint_without_its_links(tmp_path: Path) -> None:
    text = robot_of(link("a"), '<joint name="j" type="fixed"><parent link="a"/></joint>')
    assert "<child> is missing" in refusal(tmp_path, text)[1]


def test_an_axis_gets_length_1_and_that_of_a_fixed_joint_does_not_matter(tmp_path: Path) -> None:
    axis = '<axis xyz="0 0 -2"/>'
    turns = joint("j", "a", "b", "continuous", axis)
    stays = joint("k", "b", "c", "fixed", '<axis xyz="0 0 0"/>')
    robot = read(tmp_path, robot_of(link("a"), link("b"), link("c"), turns, stays))
    assert robot.joints[0].axis == (0.0, 0.0, -1.0)


def test_names(tmp_path: Path) -> None:
    assert refusal(tmp_path, robot_of(link("a"), link("a")))[0] == "duplicate-id"
    twice = [joint("j", "a", "b"), joint("j", "b", "c")]
    text = robot_of(link("a"), link("b"), link("c"), *twice)
    assert refusal(tmp_path, text) == ("duplicate-id", "line 6: <joint>: a second joint 'j'")
    assert "without links" in refusal(tmp_path, robot_of())[1]
    assert '"name" is missing' in refusal(tmp_path, robot_of("<link/>"))[1]


MISSPELT = [
    ('<lnk name="b"/>', "line 3: <robot>: unknown lnk (did you mean link?)"),
    ('<link name="b"><colision/></link>', "line 3: <link>: unknown colision"),
    ('<link name="b"><Collision/></link>', "line 3: <link>: unknown Collision"),
    ('<link nmae="b"/>', "line 3: attribute of <link>: unknown nmae"),
    (joint("j", "a", "b", inside='<limit lover="0"/>'), "<limit>: unknown lover (did you mean low"),
    (joint("j", "a", "b", inside='<axis xzy="0 0 1"/>'), "<axis>: unknown xzy (did you mean xyz?)"),
    ("<gazebo><colision/></gazebo>", "line 3: <gazebo>: unknown colision"),
]


@pytest.mark.parametrize(("element", "said"), MISSPELT)
def test_a_misspelt_name_is_refused(tmp_path: Path, element: str, said: str) -> None:
    code, message = refusal(tmp_path, robot_of(link("a"), element))
    assert code == "misspelt"
    assert said in message


def test_a_misspelt_part_of_a_joint_loses_no_body(tmp_path: Path) -> None:
    bent = joint("j", "a", "b", inside='<orgin xyz="1 0 0"/>')
    _, (found,) = read_with_issues(tmp_path, robot_of(link("a"), link("b"), bent))
    assert found.code == "unread"
    assert found.message == "line 4: <joint>: unknown orgin (did you mean origin?)"


def with_two_links(element: str) -> str:
    """A robot with the element, links a and b, and a joint between; the element may be one."""
    links = [link(name) for name in "ab" if f'<link name="{name}"' not in element]
    joints = [] if element.startswith("<joint") else [joint("i", "a", "b")]
    return robot_of(*links, element, *joints)


UNREAD = [
    ('<instance link="a" xyz="5 0 0"/>', "<robot>: instance is not read"),
    ('<include filename="b.urdf"/>', "<robot>: include is not read"),
    ('<drake:joint name="k"/>', "<robot>: drake:joint is not read"),
    ('<link name="b"><origin xyz="1 0 0"/></link>', "<link>: origin is not read"),
    ('<link name="b"><drake:collision/></link>', "<link>: drake:collision is not read"),
    ('<link name="b"><collision_checking/></link>', "collision_checking is not read"),
    ('<link name="b" xyz="1 0 0"/>', "attribute of <link>: xyz is not read"),
    (link("b", BOX.replace("<collision", '<collision pose="1 0 0"')), "<collision>: pose is not"),
    (link("b", BOX.replace("size", 'unit="mm" size')), "attribute of <box>: unit is not read"),
    (joint("j", "a", "b").replace("type", 'xyz="1 0 0" type'), "attribute of <joint>: xyz is not"),
    (joint("j", "a", "b", inside='<origin deg="90"/>'), "attribute of <origin>: deg is not read"),
    (joint("j", "a", "b", inside='<limit min="1"/>'), "attribute of <limit>: min is not read"),
    (joint("j", 'a" at="1', "b"), "attribute of <parent>: at is not read"),
    ('<gazebo reference="a"><pose>1 0 0 0 0 0</pose></gazebo>', "<gazebo>: pose is not read"),
    (f'<gazebo reference="a">{BOX}</gazebo>', "<collision>: geometry is not read"),
    (f"<transmission><link>{BOX}</link></transmission>", "<link>: the collision in it is not"),
    (f"<gazebo><plugin>{BOX}</plugin></gazebo>", "<plugin>: the collision in it is not read"),
    (f'<link name="b"><visual>{BOX}</visual></link>', "<visual>: the collision in it is not read"),
    ('<gazebo reference="a"><link name="x"/></gazebo>', "<gazebo>: link is not read"),
    ('<mujoco><worldbody><geom size="1"/></worldbody></mujoco>', "<mujoco>: worldbody is not read"),
    ("<gazebo><xacro:body/></gazebo>", "<gazebo>: xacro:body is not read"),
    (joint("j", "a", "b", inside="<origin>1 0 0</origin>"), "<origin>: the text '1 0 0' is not"),
    (joint("j", "a", "b", inside="<axis>-1 0 0</axis>"), "<axis>: the text '-1 0 0' is not read"),
    (joint("j", "a", "b", inside=LIMIT.replace("/>", ">4, 9</limit>")), "the text '4, 9' is not"),
]


@pytest.mark.parametrize(("element", "said"), UNREAD)
def test_what_may_hold_or_move_a_body_blocks_a_pass(
    tmp_path: Path, element: str, said: str
) -> None:
    _, issues = read_with_issues(tmp_path, with_two_links(element))
    assert [issue.code for issue in issues] == ["unread"]
    assert said in issues[0].message


@pytest.mark.parametrize("tag", ["loop_joint", "drake:ball_constraint"])
def test_a_loop_that_is_not_solved_is_named(tmp_path: Path, tag: str) -> None:
    _, issues = read_with_issues(tmp_path, with_two_links(f"<{tag}/>"))
    assert [issue.code for issue in issues] == ["constraint-not-solved"]


HARMLESS = [
    "<transmission><origin/></transmission>",
    '<material name="red"><colour/></material>',
    '<ros2_control name="r"><joint name="x"/></ros2_control>',
    '<link name="b"><inertial/><contact/><sensor><origin/></sensor></link>',
    '<link name="b"><origin xyz="0 0 0"/></link>',
    link("b", BOX.replace("<collision", '<collision group="x" concave="yes"')),
    joint("j", "a", "b", inside='<dynamics/><safety_controller/><axis xyz="1 0 0" rpy="0 0 0"/>'),
    '<gazebo reference="a"><mu1>1</mu1><selfCollide>true</selfCollide><sensor/></gazebo>',
    "<gazebo><plugin><pose>1 0 0</pose></plugin><pose>0 0 0 0 0 0</pose></gazebo>",
    '<gazebo reference="a"><collision><surface/><max_contacts/></collision></gazebo>',
    '<mujoco><compiler fusestatic="true" meshdir="meshes"/></mujoco>',
    '<drake:collision_filter_group name="g"/>',
    '<xacro:macro name="m"/>',
    "stray text, 1 of many",
]


@pytest.mark.parametrize("element", HARMLESS)
def test_what_places_nothing_is_no_issue(tmp_path: Path, element: str) -> None:
    _, issues = read_with_issues(tmp_path, with_two_links(element))
    assert issues == ()


DRAWN = BOX.replace("collision", "visual")


@pytest.mark.parametrize(
    ("element", "said"),
    [
        (f'<gazebo reference="a">{DRAWN}</gazebo>', "<gazebo>: the visual in it is not read"),
        (link("b", f"<collision>{DRAWN}</collision>"), "<collision>: the visual in it is not read"),
        (link("b", "<visual><xacro:hull/></visual>"), "<visual>: xacro:hull is not read"),
    ],
)
def test_what_is_drawn_elsewhere_blocks_a_pass_of_what_is_drawn(
    tmp_path: Path, element: str, said: str
) -> None:
    path = tmp_path / "r.urdf"
    path.write_text(with_two_links(element))
    found = [issue for issue in read_robot(path, geometry="visual")[1] if issue.code == "unread"]
    assert len(found) == 1
    assert said in found[0].message


def test_a_material_for_a_visual_is_no_issue(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    look = '<gazebo reference="a"><visual><material/></visual></gazebo>'
    path.write_text(robot_of(link("a", DRAWN), look))
    assert [issue.code for issue in read_robot(path, geometry="visual")[1]] == ["visual-geometry"]


@pytest.mark.parametrize(("uri", "codes"), [("m.stl", ["unread"]), ("package://p/m.stl", [])])
def test_a_folder_of_meshes_of_mujoco(tmp_path: Path, uri: str, codes: list[str]) -> None:
    mesh = f'<collision><geometry><mesh filename="{uri}"/></geometry></collision>'
    mujoco = '<mujoco><compiler meshdir="meshes"/></mujoco>'
    _, issues = read_with_issues(tmp_path, robot_of(link("a", mesh), mujoco))
    assert [issue.code for issue in issues] == codes


def test_what_does_not_matter_is_no_reason_to_refuse(tmp_path: Path) -> None:
    """A robot without a name, limits of other kinds, and a joint that was fixed later."""
    inside = ['<mimic joint="gone"/>', '<limit lower="0" upper="1" command_effort="2"/>']
    joints = [joint("j", "a", "b", "fixed", inside[0]), joint("k", "b", "c", "revolute", inside[1])]
    text = robot_of(*(link(name) for name in "abc"), *joints).replace(' name="r"', "")
    robot = read(tmp_path, text)
    assert robot.name == "r"  # of the file
    assert robot.joints[0].mimic is None


@pytest.mark.parametrize(
    "text",
    [
        robot_of('<xacro:arm name="x"/>', link("a"), "<xacro:arm/>"),
        robot_of('<xacro:include filename="x"/>'),
        robot_of(link("a", "<xacro:box/>")),
        robot_of('<x:arm xmlns:x="http://www.ros.org/wiki/xacro"/>').replace(
            "<robot", '<robot xmlns:x="http://www.ros.org/wiki/xacro"'
        ),
        robot_of(link("b") + joint("j", "a", "b", inside='<origin xyz="${w} 1 1"/>'), link("a")),
    ],
)
def test_xacro_has_to_be_expanded(tmp_path: Path, text: str) -> None:
    code, message = refusal(tmp_path, text)
    assert code == "xacro"
    assert "line 2" in message
    assert "expand it first" in message


@pytest.mark.parametrize("size", ["${w} 1 1", "1 1 $(arg h)"])
def test_xacro_inside_of_a_collision_costs_its_body(tmp_path: Path, size: str) -> None:
    robot = read(tmp_path, robot_of(geometry(f'<box size="{size}"/>')))
    found = robot.links["a"].collisions[0].geometry
    assert isinstance(found, Refusal)
    assert found.code == "xacro"
    assert "expand it first" in found.message


def test_xacro_that_makes_no_geometry_does_not_matter(tmp_path: Path) -> None:
    macros = '<xacro:property name="x" value="1"/><xacro:macro name="m"><xacro:n/></xacro:macro>'
    seen = "<visual><xacro:grey/></visual>"
    robot, issues = read_with_issues(tmp_path, robot_of(macros, link("a", BOX + seen)))
    assert len(robot.links["a"].collisions) == 1
    assert issues == ()
