"""Which prims are bodies, what they are called, and where they stand."""

from __future__ import annotations

from pathlib import Path

import pytest
from pxr import Usd, UsdGeom

from satcheck.core.shapes import Sphere
from satcheck.scene import load_scene
from tests.plugins.usd.files import at, bounds_of, cube, load, said, stage

PLACED = stage(
    'def Xform "World" {\n double3 xformOp:translate = (10, 0, 0)\n float xformOp:rotateZ = 90\n'
    ' uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ"]\n',
    cube("Near", at(3, 4, 5)),
    cube("Free", 'double3 xformOp:translate = (1, 2, 3)\nuniform token[] xformOpOrder = '
         '["!resetXformStack!", "xformOp:translate"]'),
    'def Sphere "Ball" {\n double radius = 2\n}\n}',
)  # fmt: skip


def test_bodies_stand_where_the_library_itself_bounds_them(tmp_path: Path) -> None:
    bounds = bounds_of(load(tmp_path, PLACED))
    opened = Usd.Stage.Open(str(tmp_path / "stage.usda"))
    cache = UsdGeom.BBoxCache(Usd.TimeCode.EarliestTime(), ["default", "render"])
    assert list(bounds) == ["/World/Near", "/World/Free", "/World/Ball"]
    for name, (low, high) in bounds.items():
        box = cache.ComputeWorldBound(opened.GetPrimAtPath(name)).ComputeAlignedRange()
        assert low == pytest.approx(tuple(box.GetMin()), abs=1e-12)
        assert high == pytest.approx(tuple(box.GetMax()), abs=1e-12)


@pytest.mark.parametrize(
    ("metres", "units", "scale"),
    [("0.01", "cm", 1), ("0.001", "mm", 1), ("1", "m", 1), ("0.0254", "in", 1), ("10", "m", 10)],
)
def test_the_unit_of_the_stage_counts(
    tmp_path: Path, metres: str, units: str, scale: float
) -> None:
    text = stage(cube("A"), head=f'metersPerUnit = {metres}\nupAxis = "Z"')
    scene = load(tmp_path, text)
    assert scene.units == units
    assert bounds_of(scene)["/A"][1] == (scale,) * 3


def test_a_stage_without_a_unit_is_in_centimetres_and_says_so(tmp_path: Path) -> None:
    scene = load(tmp_path, stage(cube("A"), head='upAxis = "Z"'))
    assert scene.units == "cm"
    assert "metersPerUnit" in said(scene)["assumed-units"]


def test_a_stage_with_y_up_is_turned(tmp_path: Path) -> None:
    text = stage(cube("A", at(1, 20, 300)), head='metersPerUnit = 1\nupAxis = "Y"')
    assert bounds_of(load(tmp_path, text)) == {"/A": ((1, -301, 20), (2, -300, 21))}


HIDDEN = stage(
    cube("Shown"),
    cube("Render", 'uniform token purpose = "render"'),
    cube("Proxy", 'uniform token purpose = "proxy"'),
    'def Xform "G" {\n uniform token purpose = "guide"\n' + cube("Guide") + "}",
    'def Xform "Off" {\n token visibility = "invisible"\n' + cube("Child") + "}",
    cube("Inactive", head="active = false"),
    cube("Over").replace("def Mesh", "over"),
    cube("Class").replace("def Mesh", "class Mesh"),
)


@pytest.mark.parametrize(
    ("purpose", "more"),
    [(None, {"/Render"}), (("proxy",), {"/Proxy"}), (("guide", "render"), {"/Render", "/G/Guide"})],
)
def test_only_what_is_drawn_is_a_body(
    tmp_path: Path, purpose: tuple[str, ...] | None, more: set[str]
) -> None:
    scene = load(tmp_path, HIDDEN, purpose=purpose)
    assert {body.id for body in scene.bodies} == {"/Shown", *more}


def test_what_is_hidden_is_named(tmp_path: Path) -> None:
    messages = [issue.message for issue in load(tmp_path, HIDDEN).issues]
    for name, why in (
        ("/Proxy", "purpose proxy"),
        ("/G/Guide", "purpose guide"),
        ("/Off/Child", "invisible"),
    ):
        assert any(name in message and why in message for message in messages)


def test_instances_have_paths_and_one_mesh(tmp_path: Path) -> None:
    (tmp_path / "part.usda").write_text(stage('def Xform "Part" {\n' + cube("Body") + "}"))
    text = stage(
        *(
            f'def "{name}" (\n instanceable = true\n prepend references = @part.usda@</Part>\n)\n'
            f"{{\n{at(x)}}}"
            for name, x in (("A", 0), ("B", 5))
        )
    )
    scene = load(tmp_path, text)
    assert bounds_of(scene) == {
        "/A/Body": ((0, 0, 0), (1, 1, 1)),
        "/B/Body": ((5, 0, 0), (6, 1, 1)),
    }
    assert scene.bodies[0].file is scene.bodies[1].file


INSTANCER = stage(
    'def PointInstancer "P" {\n rel prototypes = [</P/Protos/Box>, </P/Protos/Pair>]\n'
    " int[] protoIndices = [0, 1, 0]\n point3f[] positions = [(0,0,0), (10,0,0), (20,0,0)]\n"
    " int64[] invisibleIds = [2]\n float3[] scales = [(1,1,1), (2,2,2), (1,1,1)]\n" + at(100),
    'def Scope "Protos" {\n' + cube("Box"),
    'def Xform "Pair" {\n' + at(0, 1) + cube("L") + cube("R", at(3)) + "}\n}\n}",
)


def test_each_instance_of_a_point_instancer_is_placed(tmp_path: Path) -> None:
    """Scaled by 2 about its position, after the translation of the prototype itself."""
    assert bounds_of(load(tmp_path, INSTANCER)) == {
        "/P[0]:Box": ((100, 0, 0), (101, 1, 1)),
        "/P[1]:Pair/L": ((110, 2, 0), (112, 4, 2)),
        "/P[1]:Pair/R": ((116, 2, 0), (118, 4, 2)),
    }


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("[0, 1, 0]", "[0, 1, 7]", "index-out-of-range"),
        ("[0, 1, 0]", "[0, 1]", "count-mismatch"),
        ("</P/Protos/Pair>", "</P/Protos/Gone>", "missing-resource"),
    ],
)
def test_a_broken_point_instancer_is_a_body_that_is_not_read(
    tmp_path: Path, old: str, new: str, code: str
) -> None:
    scene = load(tmp_path, INSTANCER.replace(old, new) + cube("Other"))
    assert [body.id for body in scene.bodies] == ["/Other"]
    assert [(body.id, body.issue.code) for body in scene.unreadable] == [("/P", code)]


def test_a_point_instancer_inside_itself_is_a_cycle(tmp_path: Path) -> None:
    scene = load(tmp_path, INSTANCER.replace("</P/Protos/Pair>", "</P>"))
    assert [body.id for body in scene.bodies] == ["/P[0]:Box"]
    assert [(body.id, body.issue.code) for body in scene.unreadable] == [
        ("/P[1]:P", "reference-cycle")
    ]


def test_a_prototype_may_be_below_an_over_and_an_unused_one_may_be_missing(tmp_path: Path) -> None:
    text = INSTANCER.replace('def Scope "Protos"', 'over "Protos"')
    assert len(load(tmp_path, text).bodies) == 3
    text = INSTANCER.replace("[0, 1, 0]", "[0, 0, 0]").replace("Protos/Pair", "Protos/Gone")
    assert [body.id for body in load(tmp_path, text).bodies] == ["/P[0]:Box", "/P[1]:Box"]


def test_the_purpose_and_visibility_of_a_point_instancer_count(tmp_path: Path) -> None:
    for hidden in ('uniform token purpose = "guide"', 'token visibility = "invisible"'):
        text = INSTANCER.replace("int[] protoIndices", f"{hidden}\n int[] protoIndices")
        scene = load(tmp_path, text + cube("A"))
        assert [body.id for body in scene.bodies] == ["/A"]


MOVING = stage(
    'def Xform "Slider" {\n double3 xformOp:translate.timeSamples = {\n 2: (0,0,0),\n 4: (8,0,0)\n'
    ' }\n uniform token[] xformOpOrder = ["xformOp:translate"]\n' + cube("Geom") + "}",
    cube("Blink", 'token visibility.timeSamples = {\n 2: "inherited",\n 4: "invisible",\n }'),
)


@pytest.mark.parametrize(("time", "x", "bodies"), [(None, 0, 2), (3.0, 4, 2), (4.0, 8, 1)])
def test_bodies_stand_as_at_the_time(
    tmp_path: Path, time: float | None, x: float, bodies: int
) -> None:
    scene = load(tmp_path, MOVING, time=time)
    assert len(scene.bodies) == bodies
    assert bounds_of(scene)["/Slider/Geom"][0] == (x, 0, 0)
    assert ("time-sampled" in said(scene)) == (time is None)


@pytest.mark.parametrize("kind", ["BasisCurves", "Points"])
def test_geometry_without_a_surface_is_named(tmp_path: Path, kind: str) -> None:
    scene = load(tmp_path, stage(cube("A"), f'def {kind} "Line" {{\n}}'))
    assert [body.id for body in scene.bodies] == ["/A"]
    assert "/Line" in said(scene)["ignored-geometry"]


SOLID = '(\n prepend apiSchemas = ["PhysicsCollisionAPI"]\n)\n{\n}'


@pytest.mark.parametrize(
    ("prim", "geometry"),
    [
        ('def BasisCurves "X" {\n float[] widths = [0.5]\n}', None),
        ('def Points "X" {\n float[] widths = [0, 0.5]\n}', None),
        ('def Volume "X" {\n}', None),
        ('def Mesh "X" {\n point3f[] points = [(0,0,0), (1,0,0), (0,1,0)]\n}', None),
        ('def Gadget "X" {\n float3[] extent = [(0,0,0), (1,1,1)]\n}', None),
        (f'def BasisCurves "X" {SOLID}', "collision"),
        (f'def Gadget "X" {SOLID}', "collision"),
    ],
)  # fmt: skip
def test_what_takes_up_space_and_is_not_read_is_a_body_that_cannot_be_checked(
    tmp_path: Path, prim: str, geometry: str | None
) -> None:
    others = cube("A", api='"PhysicsCollisionAPI"')
    scene = load(tmp_path, stage(others, prim), geometry=geometry)
    assert [body.id for body in scene.bodies] == ["/A"]
    assert [body.id for body in scene.unreadable] == ["/X"]


def test_a_mesh_of_nothing_is_named(tmp_path: Path) -> None:
    scene = load(tmp_path, stage(cube("A"), 'def Mesh "Nothing" {\n}'))
    assert scene.unreadable == ()
    assert "/Nothing" in said(scene)["ignored-geometry"]


def test_a_surface_that_is_not_read_is_a_body_that_is_not_read(tmp_path: Path) -> None:
    scene = load(tmp_path, stage(cube("A"), 'def NurbsPatch "Sail" {\n}'))
    assert [(body.id, body.issue.code) for body in scene.unreadable] == [
        ("/Sail", "unsupported-feature")
    ]


def test_a_type_that_nobody_knows_is_named(tmp_path: Path) -> None:
    scene = load(tmp_path, stage(cube("A"), 'def Gadget "Strange" {\n}'))
    assert "/Strange" in said(scene)["unread"]


def test_a_fallback_type_counts(tmp_path: Path) -> None:
    head = """metersPerUnit = 1
        fallbackPrimTypes = {
            token[] Gadget = ["Sphere"]
        }"""
    (body,) = load(tmp_path, stage('def Gadget "Ball" {\n double radius = 2\n}', head=head)).bodies
    assert body.shape == Sphere(2.0)


def test_a_stage_without_bodies_is_refused(tmp_path: Path) -> None:
    scene = load(tmp_path, stage('def Xform "Empty" {\n}'))
    assert [body.issue.code for body in scene.unreadable] == ["no-body"]


def test_paths_of_two_stages_begin_with_their_files(tmp_path: Path) -> None:
    for name in ("a.usda", "b.usda"):
        (tmp_path / name).write_text(stage(cube("Box")))
    scene = load_scene([tmp_path / "a.usda", tmp_path / "b.usda"])
    assert [body.id for body in scene.bodies] == ["a/Box", "b/Box"]
