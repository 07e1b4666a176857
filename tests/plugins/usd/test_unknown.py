"""What prims hold that nobody reads blocks a pass, or is refused as misspelt."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import Scene
from tests.plugins.usd.files import at, bounds_of, cube, load, said, stage, unread

_HEAD = 'metersPerUnit = 1\nupAxis = "Z"'
_ORDER = 'uniform token[] xformOpOrder = ["{}"]\n'


def refusals(scene: Scene) -> list[tuple[str, str]]:
    return [(body.issue.code, body.issue.message) for body in scene.unreadable]


@pytest.mark.parametrize(
    ("text", "near"),
    [
        (cube("A", at(1).replace("xformOpOrder", "xformOpOrdr")), "xformOpOrder"),
        (cube("A", at(1).replace("double3 xformOp:translate", "double3 xformOp:tranlate")), "tran"),
        (
            cube("A", at(1).replace("xformOp:translate", "xformOp:transate")),
            "translate",
        ),
        (cube("A", 'token visibilty = "invisible"'), "visibility"),
        (cube("A", "custom int[] holeIndces = [0]"), "holeIndices"),
        (cube("A", head="instanceble = true"), "instanceable"),
        (cube("A", head="activ = false"), "active"),
        (cube("A", head="refrences = @b.usda@"), "references"),
        (cube("A", api='"PhysicsColisionAPI"'), "PhysicsCollisionAPI"),
        (cube("A", 'uniform token physics:approxmation = "convexHull"'), "approximation"),
        (cube("A", "float[] primvars:width = [1]"), "widths"),
        ('def Sphere "A" {\n double radus = 3\n}\n', "radius"),
        ('def Camera "C" {\n def Sphere "A" {\n double radus = 3\n}\n}\n', "radius"),
        (cube("A", "rel skel:skeletn = </K>", api='"SkelBindingAPI"'), "skeleton"),
        (cube("A", 'uniform token physic:approximation = "convexHull"'), "physics"),
        (cube("A", "float[] primvar:widths = [1]"), "primvars"),
        (
            cube("A", "int[] primvars:skel:jointIndices = [0] (\n elementSiz = 2\n)"),
            "elementSize",
        ),
        (
            cube(
                "A", head="clips = {\n dictionary default = {\n asset[] assetPath = [@c.usd@]\n}\n}"
            ),
            "assetPaths",
        ),
        (
            'def PhysicsCollisionGroup "G" {\n rel collection:colliders:include = </A>\n}',
            "includes",
        ),
    ],
)
def test_a_name_that_is_misspelt_is_refused(tmp_path: Path, text: str, near: str) -> None:
    ((code, message),) = refusals(load(tmp_path, stage(text)))
    assert code == "misspelt"
    assert near in message.partition("did you mean")[2]


def test_a_field_of_the_layer_that_is_misspelt_is_refused(tmp_path: Path) -> None:
    ((code, message),) = refusals(load(tmp_path, stage(cube("A"), head='upAxs = "Z"')))
    assert (code, "upAxis" in message) == ("misspelt", True)


@pytest.mark.parametrize(
    ("arc", "head"),
    [
        ("references", 'upAxs = "Z"'),
        ("payload", "metersPerUnits = 1"),
        ("subLayers", "subLayer = 1"),
    ],
)
def test_a_field_of_an_inner_layer_that_is_misspelt_is_refused(
    tmp_path: Path, arc: str, head: str
) -> None:
    inner = stage(f'def Xform "P" {{\n{cube("M")}\n}}', head=f'defaultPrim = "P"\n{head}')
    (tmp_path / "part.usda").write_text(inner)
    text = stage(f'def Xform "R" ({arc} = @part.usda@) {{\n}}')
    if arc == "subLayers":
        text = stage(cube("A"), head=f"{_HEAD}\nsubLayers = [@part.usda@]")
    ((code, message),) = refusals(load(tmp_path, text))
    assert (code, "part.usda" in message) == ("misspelt", True)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("point3f[] positions = [(0, 0, 0)]", "0 protoIndices"),
        ("int[] protoIndices = []\npoint3f[] positions = [(0, 0, 0)]", "0 protoIndices"),
        (
            "int[] protoIndices = [0]\npoint3f[] positions = [(0, 0, 0)]\n"
            "float3[] scales = [(9, 9, 9), (1, 1, 1)]",
            "2 scales",
        ),
        ("int[] protoIndices = [0]", "0 placements"),
    ],
)
def test_an_instancer_that_lacks_a_list_cannot_be_read(
    tmp_path: Path, more: str, words: str
) -> None:
    text = f'def PointInstancer "I" {{\n rel prototypes = </I/P>\n{more}\n{cube("P")}\n}}'
    ((code, message),) = refusals(load(tmp_path, stage(text)))
    assert (code, words in message) == ("count-mismatch", True)


def test_an_instancer_whose_indices_come_from_elsewhere_blocks_a_pass(tmp_path: Path) -> None:
    more = "rel prototypes = </I/P>\nint[] protoIndices.connect = </A.o>"
    text = f'def PointInstancer "I" {{\n{more}\n{cube("P")}\n}}'
    assert len(unread(load(tmp_path, stage(cube("A"), text)))) == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (cube("B", head="active = false"), "inactive"),
        (f'over "B" {{\n{cube("C")}\n}}', "an over that no prim defines"),
        (f'over "B" {{\n{at(1)}\n}}', "an over that no prim defines"),
        ('over "B" {\n double3 xformOp:translate = (1, 0, 0)\n}', "an over that no prim defines"),
        ('def Cube "B" (active = false) {\n}', "inactive"),
    ],
)
def test_a_prim_that_is_not_there_is_named(tmp_path: Path, text: str, words: str) -> None:
    assert said(load(tmp_path, stage(cube("A"), text))) == {"not-a-body": f"/B: {words}"}


@pytest.mark.parametrize(
    "text",
    [
        f'class "B" {{\n{cube("C")}\n}}',
        'def Material "B" (active = false) {\n}',
        f'over "B" {{\n{cube("C")}\n}}\ndef PointInstancer "I" {{\n rel prototypes = </B/C>\n}}',
    ],
)
def test_a_prim_that_needs_no_name(tmp_path: Path, text: str) -> None:
    assert said(load(tmp_path, stage(cube("A"), text))) == {}


@pytest.mark.parametrize(
    "text",
    [
        cube("A", "double3 xformOp:translate = (1, 0, 0)"),
        cube("A", at(1).replace("xformOpOrder = [", "xformOpOrder = [] #")),
        cube(
            "A", at(1).replace("uniform", "").replace("Order =", "Order.timeSamples = {\n0:") + "}"
        ),
        f'def Camera "C" {{\n double3 xformOp:translate = (1, 0, 0)\n{cube("A")}\n}}',
        cube("A", at(1, 0, 0).replace('translate"', 'scale"') + "float3 xformOp:scale = (1, 1, 1)"),
    ],
)
def test_an_op_that_the_order_leaves_out_is_named(tmp_path: Path, text: str) -> None:
    words = "xformOp:translate not in xformOpOrder: not applied"
    assert words in said(load(tmp_path, stage(text)))["left-out"]


@pytest.mark.parametrize("arc", ["references", "subLayers"])
@pytest.mark.parametrize(
    ("root", "inner", "words"),
    [
        (_HEAD, "", "metersPerUnit and upAxis"),
        (_HEAD, 'upAxis = "Z"', "metersPerUnit"),
        (_HEAD, "metersPerUnit = 1", "upAxis"),
        ('metersPerUnit = 0.01\nupAxis = "Y"', "", None),
    ],
)
def test_a_layer_that_states_no_unit_is_named(
    tmp_path: Path, arc: str, root: str, inner: str, words: str | None
) -> None:
    part = stage(f'def Xform "P" {{\n{cube("M")}\n}}', head=f'defaultPrim = "P"\n{inner}')
    (tmp_path / "part.usda").write_text(part)
    text = stage(f'def Xform "R" ({arc} = @part.usda@) {{\n}}', head=root)
    if arc == "subLayers":
        text = stage(head=f"{root}\nsubLayers = [@part.usda@]")
    named = f"layer part.usda: it states no {words}: that of the stage counts"
    assert said(load(tmp_path, text)) == ({"assumed-units": named} if words else {})


@pytest.mark.parametrize(
    "text",
    [
        cube("A", _ORDER.format("xformOp:translate")),
        cube("A", "double3 xformOp:translate\n" + _ORDER.format("xformOp:translate")),
        cube("A", "double bulge = 3"),
        cube("A", 'token visibility = "seen"'),
        cube("A", 'uniform token purpose = "rendr"') + cube("B"),
        cube("A", api='"FrobnicateAPI"'),
        f'def "Holder" {{\n{at(1)}\n{cube("A")}\n}}',
        f'def "Set" (prepend variantSets = "v") {{\n'
        f' variantSet "v" = {{\n "near" {{\n{cube("A")}\n}}\n}}\n}}\n{cube("B")}',
        cube("A", "point3f[] points.connect = </B.p>"),
        cube("A", at(1) + "double3 xformOp:translate.connect = </B.p>"),
        cube("A", "token visibility.connect = </B.p>"),
        cube("A", "rel skel:skeleton = </K>"),
        f'def Xform "X" {{\n double3 translate = (1, 0, 0)\n{cube("A")}\n}}',
        f'def Xform "X" {{\n variantSet "v" = {{\n "near" {{\n{cube("A")}\n}}\n}}\n}}\n{cube("B")}',
        'def "Set" (prepend variantSets = "v") {\n variantSet "v" = {\n "near" {\n'
        ' def Cube "A" {\n}\n}\n}\n}\n' + cube("B"),
        'def "Made" (prepend apiSchemas = ["GeneratorAPI"]) {\n}\n' + cube("B"),
        f'def Material "M" {{\n{cube("A", "double bulge = 3")}\n}}',
        'def Camera "C" (prepend variantSets = "v") {\n'
        f' variantSet "v" = {{\n "near" {{\n{cube("A")}\n}}\n}}\n}}\n{cube("B")}',
        'def Xform "Card" (kind = "component") {\n uniform token model:drawMode = "cards"\n}\n'
        + cube("B"),
    ],
)
def test_what_nobody_reads_blocks_a_pass(tmp_path: Path, text: str) -> None:
    assert len(unread(load(tmp_path, stage(text)))) == 1


@pytest.mark.parametrize(
    "text",
    [
        cube("A", "double3 xformOp:translate = (0, 0, 0)"),  # without an order, as with one
        cube("A", "custom double note = 3"),
        cube("A", "float[] primvars:displayOpacity.connect = </B.o>"),
        'def Camera "C" {\n double3 xformOp:translate = (1, 0, 0)\n}\n' + cube("A"),
        'def Material "M" {\n def Shader "S" {\n float inputs:size.connect = </M.x>\n'
        " double size = 3\n}\n}\n" + cube("A"),
        'def PointInstancer "I" {\n rel prototypes = </I/P>\n def "P" {\n}\n}\n' + cube("A"),
        cube("A", 'string userProperties:note = "x"\nfloat physics:mass = 3'),
        cube("A", "texCoord2f[] primvars:st1 = [(0, 0)]"),
        cube("A", api='"PhysxCollisionAPI", "SemanticsAPI:x", "OmniNodeAPI"'),
        cube("A", head='wobble = "x"'),
        'def Xform "X" {\n float3[] extent = [(0, 0, 0), (1, 1, 1)]\n}\n' + cube("A"),
        'def OmniGraph "G" {\n}\n' + cube("A"),
        cube("A", api='"SpotLightAPI"'),
        'def PxrBarnLightFilter "L" {\n token visibility = "inherited"\n}\n' + cube("A"),
        'def "Set" (prepend variantSets = "v") {\n variantSet "v" = {\n "red" {\n'
        ' def Material "M" {\n}\n}\n}\n}\n' + cube("B"),
    ],
)
def test_what_is_harmless_passes(tmp_path: Path, text: str) -> None:
    scene = load(tmp_path, stage(text))
    assert (unread(scene), refusals(scene)) == ([], [])


@pytest.mark.parametrize(
    "prim",
    [
        'def "A" {\n point3f[] points = [(0, 0, 0)]\n}',
        'def GenerativeProcedural "A" {\n}',
        'def BasisCurves "A" {\n int[] curveVertexCounts = [2]\n'
        " point3f[] points = [(0, 0, 0), (1, 0, 0)]\n float[] primvars:widths = [1, 1]\n}",
    ],
)
def test_geometry_that_is_not_read_is_a_body_that_is_not_read(tmp_path: Path, prim: str) -> None:
    scene = load(tmp_path, stage(prim, cube("B")))
    assert [body.id for body in scene.unreadable] == ["/A"]


@pytest.mark.parametrize(
    ("api", "more", "count"),
    [
        ("PhysxSDFMeshCollisionAPI", "", 1),
        ("PhysxCollisionAPI", "float physxCollision:restOffset = 9", 1),
        ("PhysxCollisionAPI", "float physxCollision:restOffset = 0", 0),
        ("PhysxCollisionAPI", "float physxCollision:contactOffset = 9", 0),
    ],
)
def test_what_shapes_a_collider_otherwise_blocks(
    tmp_path: Path, api: str, more: str, count: int
) -> None:
    text = stage(cube("A", more, api=f'"PhysicsCollisionAPI", "{api}"'))
    assert len(unread(load(tmp_path, text, geometry="collision"))) == count
    assert unread(load(tmp_path, text)) == []


@pytest.mark.parametrize(
    ("head", "placed", "count"),
    [
        ('metersPerUnit = 0.01\nupAxis = "Z"', "", 1),
        ('metersPerUnit = 1\nupAxis = "Y"', "", 1),
        (_HEAD, "", 0),
        ("", "", 0),
        (
            'metersPerUnit = 0.01\nupAxis = "Y"',
            "float3 xformOp:scale:unitsResolve = (0.01, 0.01, 0.01)\n"
            "double xformOp:rotateX:unitsResolve = 90\n"
            'uniform token[] xformOpOrder = ["xformOp:rotateX:unitsResolve",'
            ' "xformOp:scale:unitsResolve"]\n',
            0,
        ),
    ],
)
def test_a_layer_in_other_units_blocks_unless_it_is_converted(
    tmp_path: Path, head: str, placed: str, count: int
) -> None:
    (tmp_path / "part.usda").write_text(
        stage(f'def Xform "P" {{\n{cube("M")}\n}}', head=f'defaultPrim = "P"\n{head}')
    )
    text = stage(f'def Xform "R" (references = @part.usda@) {{\n{placed}}}\n', cube("B"))
    assert len(unread(load(tmp_path, text))) == count


def test_a_skinned_mesh_stands_as_its_skeleton_does(tmp_path: Path) -> None:
    unit, moved = (f"((1,0,0,0),(0,1,0,0),(0,0,1,0),({x},0,0,1))" for x in (0, -5))
    skeleton = f"""def SkelRoot "S" {{
        def Skeleton "K" {{
            uniform token[] joints = ["j"]
            uniform matrix4d[] bindTransforms = [{unit}]
            uniform matrix4d[] restTransforms = [{moved}]
            double3 xformOp:translate = (0, 7, 0)
            uniform token[] xformOpOrder = ["xformOp:translate"]
        }}
        MESH
    }}"""
    weights = """rel skel:skeleton = </S/K>
        int[] primvars:skel:jointIndices = [0] (
            elementSize = 1
            interpolation = "constant"
        )
        float[] primvars:skel:jointWeights = [1] (
            elementSize = 1
            interpolation = "constant"
        )"""
    mesh = cube("M", weights + "\n" + at(3), api='"SkelBindingAPI"')
    scene = load(tmp_path, stage(skeleton.replace("MESH", mesh)))
    assert bounds_of(scene)["/S/M"] == ((-5, 7, 0), (-4, 8, 1))
    assert "/S/M" in said(scene)["rest-shape"]


def test_an_axis_of_the_stage_that_is_none_is_refused(tmp_path: Path) -> None:
    ((code, message),) = refusals(load(tmp_path, stage(cube("A"), head='upAxis = "y"')))
    assert (code, "upAxis" in message) == ("bad-record", True)


@pytest.mark.parametrize("kind", ["OmniMesh", "NewtonShape", "MjcGeom"])
def test_a_type_of_a_program_that_takes_up_space_is_no_setting(tmp_path: Path, kind: str) -> None:
    points = "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]"
    found = load(tmp_path, stage(cube("A"), f'def {kind} "C" {{\n{points}\n}}'))
    assert [code for code, _ in refusals(found)] == ["unsupported-feature"]
    assert not refusals(load(tmp_path, stage(cube("A"), f'def {kind} "C" {{\n}}')))


@pytest.mark.parametrize(("amount", "found"), [("0", []), ("0.5", ["unread"])])
def test_a_material_that_displaces_blocks_a_pass(
    tmp_path: Path, amount: str, found: list[str]
) -> None:
    material = f"""def Material "M" {{
        token outputs:displacement.connect = </M/S.outputs:displacement>
        def Shader "S" {{
            uniform token info:id = "UsdPreviewSurface"
            float inputs:displacement = {amount}
            token outputs:displacement
        }}
    }}"""
    scene = load(tmp_path, stage(cube("A"), material))
    assert [issue.code for issue in scene.issues if issue.code == "unread"] == found


def test_an_api_that_is_only_like_one_of_a_renderer(tmp_path: Path) -> None:
    assert "unread" in said(load(tmp_path, stage(cube("A", api='"RibbonAPI"'))))
    assert "unread" not in said(load(tmp_path, stage(cube("A", api='"RiMaterialAPI"'))))


@pytest.mark.parametrize("kind", ["Scope", "Xform"])
def test_geometry_in_a_type_without_any_blocks_a_pass(tmp_path: Path, kind: str) -> None:
    lost = cube("B").replace("def Mesh", f"def {kind}")
    assert "unread" in said(load(tmp_path, stage(cube("A"), lost)))


def test_an_old_name_about_subdivision_is_harmless(tmp_path: Path) -> None:
    old = 'uniform token boundaryInterpolation = "edgeAndCorner"'
    assert "unread" not in said(load(tmp_path, stage(cube("A", old))))


@pytest.mark.parametrize("arc", ["inherits", "specializes"])
def test_a_class_that_is_missing_is_named(tmp_path: Path, arc: str) -> None:
    text = f'def Xform "X" ({arc} = </C>) {{\n}}\n'
    assert "/C" in said(load(tmp_path, stage(text, cube("B"))))["left-out"]


def test_a_mesh_that_no_skeleton_can_move_is_named(tmp_path: Path) -> None:
    bound = cube("A", "int[] primvars:skel:jointIndices = [0]", api='"SkelBindingAPI"')
    assert "SkelRoot" in said(load(tmp_path, stage(bound)))["left-out"]


@pytest.mark.parametrize("name", ["size", "radius", "height"])
def test_a_prim_of_no_type_with_the_size_of_a_shape_may_be_meant_to_be_one(
    tmp_path: Path, name: str
) -> None:
    untyped = f'def "B" {{\n double {name} = 1\n{at(1)}}}\n'
    (refusal,) = refusals(load(tmp_path, stage(cube("A"), untyped)))
    assert refusal[0] == "unsupported-feature"
    assert name in refusal[1]
    own = untyped.replace(f"double {name}", f"custom double {name}")
    assert not refusals(load(tmp_path, stage(cube("A"), own)))


def test_an_api_that_takes_no_instance_name_is_misspelt_with_one(tmp_path: Path) -> None:
    text = stage(cube("A", api='"PhysicsCollisionAPI:x"'))
    ((code, message),) = refusals(load(tmp_path, text))
    assert code == "misspelt"
    assert "did you mean PhysicsCollisionAPI?" in message


@pytest.mark.parametrize("name", ["skeleton", "animationSource"])
def test_a_skeleton_or_animation_that_is_not_there_blocks_a_pass(tmp_path: Path, name: str) -> None:
    box = cube("A", f"rel skel:{name} = </Lost>", api='"SkelBindingAPI"')
    (message,) = unread(load(tmp_path, stage(box)))
    assert f"skel:{name}" in message
    assert "/Lost" in message


def test_misspelt_names_of_animations_are_refused(tmp_path: Path) -> None:
    animation = 'def SkelAnimation "N" {\n float3[] translation = [(1, 0, 0)]\n}\n'
    ((code, message),) = refusals(load(tmp_path, stage(cube("A"), animation)))
    assert code == "misspelt"
    assert "did you mean translations?" in message


@pytest.mark.parametrize(
    "below",
    [
        'over "Box" {\n token visibility = "invisible"\n}',
        'over "Box" (active = false) {\n}',
        f'over "Box" {{\n{at(5)}}}',
        'over "Inner" {\n over "Box" {\n double size = 3\n}\n}',
        'def Cube "More" {\n}',
    ],
)
def test_an_override_below_an_instance_is_named(tmp_path: Path, below: str) -> None:
    kit = f'class Xform "Kit" {{\n{cube("Box")}}}\n'
    text = f'def Xform "A" (\ninherits = </Kit>\ninstanceable = true\n) {{\n{below}\n}}\n'
    scene = load(tmp_path, stage(kit, text))
    assert not unread(scene)
    assert "/A: an override of" in said(scene)["left-out"]
    assert "below an instance" in said(scene)["left-out"]


def test_what_an_instance_shares_is_no_override(tmp_path: Path) -> None:
    kit = f'class Xform "Kit" {{\n{cube("Box", at(5))}}}\n'
    looks = 'def Material "Look" {\n}\nover "Box" {\n rel material:binding = </A/Look>\n}\n'
    text = f'def Xform "A" (\ninherits = </Kit>\ninstanceable = true\n) {{\n{looks}\n}}\n'
    assert "left-out" not in said(load(tmp_path, stage(kit, text)))


_INSTANCER = """def PointInstancer "I" {{
    int[] protoIndices = [0, 0]
    point3f[] positions = [(0, 0, 0), (5, 0, 0)]
    rel prototypes = {target}
    {more}
    {below}
}}
"""


def test_ids_that_do_not_fit_the_instances_cannot_be_read(tmp_path: Path) -> None:
    more = "int64[] ids = [7]\nint64[] invisibleIds = [7]"
    text = _INSTANCER.format(target="</I/P>", more=more, below=cube("P"))
    ((code, message),) = refusals(load(tmp_path, stage(text)))
    assert code == "count-mismatch"
    assert "1 ids" in message


def test_an_invisible_id_of_no_instance_is_named(tmp_path: Path) -> None:
    more = "int64[] invisibleIds = [1, 9]"
    text = _INSTANCER.format(target="</I/P>", more=more, below=cube("P"))
    scene = load(tmp_path, stage(text))
    assert [body.id for body in scene.bodies] == ["/I[0]:P"]
    assert "invisibleIds has 9" in said(scene)["left-out"]


def test_what_stands_in_an_instancer_and_is_no_prototype_is_named(tmp_path: Path) -> None:
    text = _INSTANCER.format(target="</Q>", more="", below=cube("P"))
    assert "/I/P: in a point" in said(load(tmp_path, stage(text, cube("Q"))))["not-a-body"]
    text = _INSTANCER.format(target="</I/P>", more="", below=cube("P"))
    assert "not-a-body" not in said(load(tmp_path, stage(text)))


@pytest.mark.parametrize("name", ["visibility", "purpose"])
def test_a_prim_of_no_type_hides_nothing_and_is_named(tmp_path: Path, name: str) -> None:
    text = f'def "A" {{\n token {name} = "guide"\n{cube("B")}}}\n'
    scene = load(tmp_path, stage(text))
    assert [body.id for body in scene.bodies] == ["/A/B"]
    assert name in said(scene)["left-out"]


def test_a_variant_of_no_set_is_named(tmp_path: Path) -> None:
    text = cube("A", head='variants = {\n string size = "big"\n}')
    assert "'size'" in said(load(tmp_path, stage(text)))["left-out"]


def test_a_shape_that_a_stronger_type_makes_no_shape_blocks(tmp_path: Path) -> None:
    text = 'class Cube "K" {\n}\ndef Xform "A" (\n inherits = </K>\n) {\n}\n'
    (message,) = unread(load(tmp_path, stage(text, cube("B"))))
    assert "Xform of this Cube" in message


@pytest.mark.parametrize(
    ("source", "target", "blocks"),
    [
        ("/W/A", "/W/Z", False),
        ("/W/A", "", False),
        ("/W/A", "/V/Z", True),
        ("/W/Aa", "/W/Z", True),
    ],
)
def test_a_prim_that_is_relocated_nowhere_blocks(
    tmp_path: Path, source: str, target: str, blocks: bool
) -> None:
    (tmp_path / "kit.usda").write_text(stage(f'def Xform "W" {{\n{cube("A")}}}\n'))
    head = f"{_HEAD}\nrelocates = {{\n <{source}> : <{target}>\n}}"
    text = 'def Xform "W" (\n references = @kit.usda@</W>\n) {\n}\n'
    scene = load(tmp_path, stage(text, cube("B"), head=head))
    assert [target in message for message in unread(scene)] == [True] * blocks


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("physics:filteredPairs", "ignored-opinion"),
        ("physics:filteredGroups", "ignored-opinion"),
        ("collection:colliders:includes", "ignored-opinion"),
        ("collection:colliders:excludes", "unread"),
    ],
)
def test_an_exemption_of_a_prim_that_is_not_there_is_named(
    tmp_path: Path, name: str, code: str
) -> None:
    api = '(prepend apiSchemas = ["PhysicsFilteredPairsAPI"])'
    text = f'def PhysicsCollisionGroup "G" {api} {{\n rel {name} = </Lost>\n}}\n'
    assert "/Lost" in said(load(tmp_path, stage(cube("A"), text)))[code]


def test_filtered_pairs_without_their_schema_are_named(tmp_path: Path) -> None:
    scene = load(tmp_path, stage(cube("A", "rel physics:filteredPairs = </B>"), cube("B")))
    assert not scene.body_rules
    assert "filteredPairs" in said(scene)["ignored-opinion"]


def test_bodies_of_an_articulation_that_are_not_to_collide_are_named(tmp_path: Path) -> None:
    text = cube("A", "bool physxArticulation:enabledSelfCollisions = 0")
    assert "enabledSelfCollisions" in said(load(tmp_path, stage(text)))["left-out"]


_BOUND = """int[] primvars:skel:jointIndices = [0] (
    interpolation = "constant"
    elementSize = 1
)
float[] primvars:skel:jointWeights = [1] (
    interpolation = "constant"
    elementSize = 1
)
"""


def skinned(more: str, animation: str = "") -> str:
    """A cube that its joint `b` moves by 5."""
    matrix = "((1,0,0,0),(0,1,0,0),(0,0,1,0),({},0,0,1))".format
    skeleton = f"""def Skeleton "K" (prepend apiSchemas = ["SkelBindingAPI"]) {{
        uniform token[] joints = ["a", "b"]
        uniform matrix4d[] bindTransforms = [{matrix(0)}, {matrix(0)}]
        uniform matrix4d[] restTransforms = [{matrix(0)}, {matrix(5)}]
        {animation}
    }}
    """
    body = cube("A", f"{_BOUND}\n{more}", api='"SkelBindingAPI"')
    return stage(f'def SkelRoot "W" {{\n{skeleton}\n{body}}}\n')


def test_the_joints_of_a_mesh_are_some_of_its_skeleton(tmp_path: Path) -> None:
    more = 'rel skel:skeleton = </W/K>\nuniform token[] skel:joints = ["{}"]'
    scene = load(tmp_path, skinned(more.format("b")))
    assert bounds_of(scene)["/W/A"][0] == (5, 0, 0)
    assert not unread(scene)
    (message,) = unread(load(tmp_path, skinned(more.format("c"))))
    assert "skel:joints has c" in message


def test_a_mesh_without_a_skeleton_is_named(tmp_path: Path) -> None:
    assert "bound to a skeleton" in said(load(tmp_path, skinned("")))["left-out"]


def test_an_animation_that_is_not_whole_blocks(tmp_path: Path) -> None:
    animation = """rel skel:animationSource = </W/K/N>
    def SkelAnimation "N" {
        uniform token[] joints = ["b"]
        float3[] translations = [(9, 0, 0)]
        half3[] scales = [(1, 1, 1)]
    }
    """
    (message,) = unread(load(tmp_path, skinned("rel skel:skeleton = </W/K>", animation)))
    assert "no rotations" in message


def test_an_op_without_a_value_moves_no_body_where_there_is_none(tmp_path: Path) -> None:
    text = 'def Xform "A" {\n double3 xformOp:translate\n' + _ORDER.format("xformOp:translate")
    assert not unread(load(tmp_path, stage(text + "}", cube("B"))))
