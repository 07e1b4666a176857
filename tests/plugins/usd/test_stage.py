"""What of a stage cannot be opened, and what its layers may be."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest
from pxr import Sdf, Usd, UsdUtils

from satcheck.scene import load_scene
from satcheck.scene.access import files_read
from tests.cli.process import satcheck
from tests.plugins.usd.files import at, bounds_of, cube, load, said, stage

PART = 'def Xform "Part" {\n' + cube("Body") + "}"


def referring(name: str, arc: str) -> str:
    return f'def Xform "{name}" (\n prepend {arc}\n)\n{{\n}}\n'


@pytest.mark.parametrize(
    ("arc", "code", "named"),
    [
        ("references = @gone.usda@", "missing-resource", "gone.usda"),
        ("payload = @gone.usda@", "missing-resource", "gone.usda"),
        ("references = @https://example.org/a.usda@", "missing-resource", "example.org"),
        ("references = @part.usda@</Nobody>", "missing-resource", "/Nobody"),
        ("references = @part.usda@", "missing-resource", "defaultPrim"),
        ("references = @damaged.usda@", "missing-resource", "damaged.usda"),
        ("references = @garbage.usda@", "missing-resource", "UTF-8"),
        ("references = </A>", "reference-cycle", "Cycle"),
    ],
)
def test_what_a_prim_lacks_is_a_body_that_is_not_read(
    tmp_path: Path, arc: str, code: str, named: str
) -> None:
    (tmp_path / "part.usda").write_text(stage(PART))
    (tmp_path / "damaged.usda").write_text("#usda 1.0\ndef Xform {")
    (tmp_path / "garbage.usda").write_bytes(b"#usda 1.0\ndef \xf5\xa9\xa5 {")
    text = stage(f'def Xform "A" {{\n{referring("Sub", arc)}}}', cube("Other"))
    scene = load(tmp_path, text)
    assert [body.id for body in scene.bodies] == ["/Other"]
    (lost,) = scene.unreadable
    assert lost.issue.code == code
    assert named in lost.issue.message


def test_a_missing_sublayer_refuses_the_file(tmp_path: Path) -> None:
    text = stage(cube("A"), head="metersPerUnit = 1\nsubLayers = [@gone.usda@]")
    (lost,) = load(tmp_path, text).unreadable
    assert lost.issue.code == "missing-resource"
    assert "gone.usda" in lost.issue.message


def test_a_missing_value_clip_is_a_body_that_is_not_read(tmp_path: Path) -> None:
    clips = """clips = {\n dictionary default = {\n double2[] active = [(0, 0)]
        asset[] assetPaths = [@gone.usda@]\n string primPath = "/A"\n double2[] times = [(0, 0)]
    }\n }"""
    scene = load(tmp_path, stage(cube("A", head=clips), cube("B")))
    assert [body.id for body in scene.bodies] == ["/B"]
    assert "gone.usda" in scene.unreadable[0].issue.message


def test_a_material_may_be_missing(tmp_path: Path) -> None:
    material = referring("M", "references = @gone.usda@").replace("Xform", "Material")
    scene = load(tmp_path, stage(cube("A"), material))
    assert not scene.unreadable
    assert "gone.usda" in said(scene)["ignored-opinion"]


def test_a_missing_materialx_file_hides_no_body(tmp_path: Path) -> None:
    text = stage(cube("A"), referring("Looks", "references = @gone.mtlx@</MaterialX>"))
    scene = load(tmp_path, text)
    assert not scene.unreadable
    assert "gone.mtlx" in said(scene)["ignored-opinion"]


def test_a_unit_may_be_stored_as_float32(tmp_path: Path) -> None:
    """The text form stores a double."""
    path = tmp_path / "a.usdc"
    (tmp_path / "stage.usda").write_text(stage(cube("A")))
    layer = Sdf.Layer.FindOrOpen(str(tmp_path / "stage.usda"))
    layer.pseudoRoot.SetInfo("metersPerUnit", float(struct.unpack("f", struct.pack("f", 0.01))[0]))
    assert layer.Export(str(path))
    assert load_scene([path]).units == "cm"


def test_layers_stay_in_the_folder_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "part.usda").write_text(stage(PART))
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "a.usda").write_text(stage(referring("A", "references = @../part.usda@</Part>")))
    (lost,) = load_scene([folder / "a.usda"]).unreadable
    assert lost.issue.code == "outside-path"
    scene = load_scene([folder / "a.usda"], allow_outside=True)
    assert [body.id for body in scene.bodies] == ["/A/Body"]


@pytest.mark.parametrize(
    "arc",
    [
        "references = @../secret.usda@</Part>",
        "payload = @../secret.usda@",
        "references = @./link.usda@</Part>",
        "clips = {\ndictionary default = {\nasset[] assetPaths = [@../secret.usda@]\n"
        'asset manifestAssetPath = @../secret.usda@\nstring primPath = "/A"\n}\n}',
    ],
)
def test_a_file_outside_is_not_opened(tmp_path: Path, arc: str) -> None:
    (tmp_path / "secret.usda").write_text("the word is swordfish")
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "link.usda").symlink_to(tmp_path / "secret.usda")
    scene = load(folder, stage(f'def Xform "A" (\n{arc}\n) {{\n}}', cube("B")))
    (lost,) = scene.unreadable
    assert lost.issue.code == "outside-path"
    assert "--allow-outside" in lost.issue.message
    assert "swordfish" not in str([issue.message for issue in scene.issues])


def test_a_layer_outside_that_no_variant_selects_is_no_matter(tmp_path: Path) -> None:
    (tmp_path / "part.usda").write_text(stage(PART))
    folder = tmp_path / "in"
    folder.mkdir()
    text = stage(
        'def Xform "A" (\n variants = {\n string size = "thin"\n }\n prepend variantSets = "size"\n'
        ')\n{\n variantSet "size" = {\n "thick" (references = @../part.usda@</Part>) {\n}\n'
        f'"thin" {{\n{cube("M")}}}\n }}\n}}'
    )
    assert list(bounds_of(load(folder, text))) == ["/A/M"]


def test_every_layer_is_noted_even_one_that_is_missing(tmp_path: Path) -> None:
    (tmp_path / "part.usda").write_text(stage(PART))
    text = stage(
        referring("A", "references = @part.usda@</Part>"),
        referring("B", "references = @gone.usda@"),
    )
    with files_read() as files:
        load(tmp_path, text)
    assert {Path(name).name for name in files} == {"stage.usda", "part.usda", "gone.usda"}


def test_the_selected_variant_counts(tmp_path: Path) -> None:
    variants = "\n".join(
        f'"{name}" {{\n{cube(name, at(x))}}}' for name, x in (("thick", 1), ("thin", 2))
    )
    text = stage(
        'def Xform "A" (\n variants = {\n string size = "thin"\n }\n prepend variantSets = "size"\n'
        f')\n{{\n variantSet "size" = {{\n{variants}\n }}\n}}'
    )
    assert list(bounds_of(load(tmp_path, text))) == ["/A/thin"]


def test_a_variant_that_is_missing_leaves_a_body_that_is_not_read(tmp_path: Path) -> None:
    variants = f'variantSet "shape" = {{\n "box" {{\n{cube("Box")}}}\n}}\n'
    head = 'variants = {\n string shape = "%s"\n}\n prepend variantSets = ["shape"]'
    for selected, bodies in (("box", ["/A/Box"]), ("ball", ["/A"])):
        prim = f'def Xform "A" (\n{head % selected}\n)\n{{\n{variants}}}\n'
        scene = load(tmp_path, stage(prim, cube("B")))
        assert [body.id for body in scene.in_order()] == [*bodies, "/B"]
    (lost,) = scene.unreadable
    assert (lost.id, lost.issue.code) == ("/A", "missing-resource")
    assert "'ball'" in lost.issue.message


def test_all_endings_hold_the_same_stage(tmp_path: Path) -> None:
    wanted = bounds_of(load(tmp_path, stage(PART)))
    source = tmp_path / "stage.usda"
    for name in ("a.usdc", "b.usd"):
        assert Usd.Stage.Open(str(source)).Export(str(tmp_path / name))
    assert UsdUtils.CreateNewUsdzPackage(str(source), str(tmp_path / "c.usdz"))
    for name in ("a.usdc", "b.usd", "c.usdz"):
        assert bounds_of(load_scene([tmp_path / name])) == wanted


@pytest.mark.parametrize("kind", ["usda", "usdc", "usdz"])
@pytest.mark.parametrize("damage", ["truncated", "garbage", "empty"])
def test_a_damaged_file_is_refused_with_a_code(tmp_path: Path, kind: str, damage: str) -> None:
    load(tmp_path, stage(PART))
    source, path = tmp_path / "stage.usda", tmp_path / f"a.{kind}"
    if kind == "usdz":
        assert UsdUtils.CreateNewUsdzPackage(str(source), str(path))
    else:
        assert Usd.Stage.Open(str(source)).Export(str(path))
    data = path.read_bytes()
    half = len(data) // 2
    kept = {"truncated": data[:half], "garbage": data[:64] + b"\xa5" * half, "empty": b""}
    path.write_bytes(kept[damage])
    (lost,) = load_scene([path]).unreadable
    assert lost.issue.code == "bad-record"
    assert path.name in lost.issue.message
    assert "Traceback" not in lost.issue.message


def test_a_missing_package_says_what_to_install(tmp_path: Path) -> None:
    planted = tmp_path / "planted" / "pxr"
    planted.mkdir(parents=True)
    (planted / "__init__.py").write_text("raise ModuleNotFoundError(name='pxr')")
    (tmp_path / "a.usda").write_text(stage(cube("A"), cube("B")))
    ran = satcheck(str(tmp_path / "a.usda"), env={"PYTHONPATH": str(planted.parent)})
    assert "pip install 'satcheck[usd]'" in ran.err
    assert "Traceback" not in ran.err


@pytest.mark.parametrize("hidden", ['token visibility = "invisible"', 'token purpose = "guide"'])
def test_a_reference_that_is_lost_in_an_instance_loses_the_file(
    tmp_path: Path, hidden: str
) -> None:
    """The prototype is hidden, its instances are not."""
    text = stage(
        'def Xform "World" {', cube("A"), cube("C", at(9)),
        f'def Xform "lib" {{\n{hidden}\ndef Xform "proto" (references = @gone.usda@) {{}}\n}}',
        'def PointInstancer "P" {\nrel prototypes = </World/lib/proto>\n'
        "int[] protoIndices = [0]\npoint3f[] positions = [(0, 0, 0)]\n}", "}",
    )  # fmt: skip
    scene = load(tmp_path, text)
    assert not scene.bodies
    assert "missing-resource" in said(scene)


@pytest.mark.parametrize(
    "text",
    [
        stage(referring("A", 'references = @`"${V}`@'), cube("B")),
        stage(cube("B"), head='metersPerUnit = 1\nsubLayers = [@`"${V}`@]'),
    ],
)
def test_an_expression_that_has_no_value_refuses_the_file(tmp_path: Path, text: str) -> None:
    (lost,) = load(tmp_path, text).unreadable
    assert lost.issue.code == "missing-resource"
    assert "${V}" in lost.issue.message
