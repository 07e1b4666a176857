"""Formats that trimesh reads: overlaps count, and nothing is proven apart."""

from __future__ import annotations

import io
import json
import logging
import zipfile
from pathlib import Path

import pytest
import trimesh

from satcheck.plugins.tail.reader import read_tail
from satcheck.scene import Refused, load_scene
from satcheck.scene.files.readers import File
from tests.cli.process import satcheck
from tests.scene import files

XSI = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
TRIANGLES = " ".join(str(i) for face in files.CUBE for i in face)


def zipped(**parts: str | bytes) -> bytes:
    """Parts by their names, with "_" for "."."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name.replace("_", "."), content)
    return stream.getvalue()


def zae() -> bytes:
    return zipped(cube_dae=files.collada())


def xaml(normals: bool = True) -> bytes:
    points = " ".join("{},{},{}".format(*point) for point in files.CUBE_POINTS)
    given = f' Normals="{points}"' if normals else ""
    mesh = f'<MeshGeometry3D Positions="{points}" TriangleIndices="{TRIANGLES}"{given}/>'
    return (
        '<Viewport3D xmlns="http://schemas.microsoft.com/winfx/2006/xaml/presentation">'
        "<ModelVisual3D><ModelVisual3D.Content><GeometryModel3D><GeometryModel3D.Geometry>"
        f"{mesh}</GeometryModel3D.Geometry></GeometryModel3D></ModelVisual3D.Content>"
        "</ModelVisual3D></Viewport3D>"
    ).encode()


def threedxml() -> bytes:
    """Two cubes, at x = 10 and x = 20."""
    place = "<RelativeMatrix>1 0 0 0 1 0 0 0 1 {} 0 0</RelativeMatrix>"
    inside = (
        '<{kind} id="{id}" name="{name}"><IsAggregatedBy>{above}</IsAggregatedBy>'
        "<IsInstanceOf>{below}</IsInstanceOf>{place}</{kind}>"
    )
    names = {"above": 1, "below": 2, "kind": "Instance3D"}
    product = (
        '<Reference3D xsi:type="Reference3DType" id="1" name="car"/>'
        '<Reference3D xsi:type="Reference3DType" id="2" name="wheel"/>'
        '<ReferenceRep xsi:type="ReferenceRepType" id="3" name="shape" format="TESSELLATED" '
        'associatedFile="urn:3DXML:cube.3DRep"/>'
        + inside.format(id=4, name="s", above=2, below=3, kind="InstanceRep", place="")
        + inside.format(id=5, name="left", place=place.format(10), **names)
        + inside.format(id=6, name="right", place=place.format(20), **names)
    )
    positions = ",".join("{} {} {}".format(*point) for point in files.CUBE_POINTS)
    shape = (
        f'<XMLRepresentation xmlns="http://www.3ds.com/xsd/3DXML" {XSI}>'
        f'<Root xsi:type="BagRepType"><Rep xsi:type="PolygonalRepType"><Faces>'
        f'<Face triangles="{TRIANGLES}"/></Faces><VertexBuffer><Positions>{positions}</Positions>'
        f"<Normals>{positions}</Normals></VertexBuffer></Rep></Root></XMLRepresentation>"
    )
    document = (
        f'<Model_3dxml xmlns="http://www.3ds.com/xsd/3DXML" {XSI}>'
        f'<ProductStructure root="1">{product}</ProductStructure></Model_3dxml>'
    )
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("Manifest.xml", "<Manifest><Root>Product.3dxml</Root></Manifest>")
        archive.writestr("Product.3dxml", document)
        archive.writestr("cube.3DRep", shape)
    return stream.getvalue()


CONTENTS = {"a.zae": zae(), "a.xaml": xaml(), "a.3dxml": threedxml()}


@pytest.mark.parametrize("name", CONTENTS)
def test_what_trimesh_reads_is_a_solid(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(CONTENTS[name])
    scene = load_scene([tmp_path / name])
    assert [body.file.health.volume for body in scene.bodies] == [1.0] * len(scene.bodies)
    assert len(scene.bodies) == (2 if name == "a.3dxml" else 1)
    assert "incomplete" in [issue.code for issue in scene.issues]


def test_bodies_stand_where_the_file_places_them(tmp_path: Path) -> None:
    (tmp_path / "a.3dxml").write_bytes(threedxml())
    bounds = sorted(body.world_mesh().bounds for body in load_scene([tmp_path / "a.3dxml"]).bodies)
    assert bounds == [((10, 0, 0), (11, 1, 1)), ((20, 0, 0), (21, 1, 1))]


def test_an_overlap_counts(tmp_path: Path) -> None:
    (tmp_path / "a.zae").write_bytes(zae())
    (tmp_path / "b.obj").write_bytes(files.obj())
    ran = satcheck("a.zae", "b.obj", "--units", "m", "--format", "json", cwd=tmp_path)
    assert (ran.code, ran.document["findings"][0]["relation"]) == (1, "coincident")


def test_what_is_apart_is_an_estimate_until_it_is_accepted(tmp_path: Path) -> None:
    (tmp_path / "a.3dxml").write_bytes(threedxml())
    ran = satcheck("a.3dxml", "--clearance", "100", "--format", "json", cwd=tmp_path)
    assert ran.code == 1
    near = satcheck("a.3dxml", "--clearance", "5", "--format", "json", cwd=tmp_path)
    assert near.code == 3
    words = ("a.3dxml", "--accept", "incomplete:a.3dxml")
    assert satcheck(*words, cwd=tmp_path).code == 0


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("a.zae", zae()[:40], "bad-record"),
        ("a.xaml", xaml(normals=False), "bad-record"),
        ("a.xaml", b"<Viewport3D/>", "bad-record"),
        ("a.3dxml", zipped(a_txt="x"), "bad-record"),
    ],
    ids=["cut off", "without normals", "empty", "no manifest"],
)
def test_what_trimesh_cannot_read_is_refused(
    tmp_path: Path, name: str, content: bytes, code: str
) -> None:
    (tmp_path / name).write_bytes(content)
    scene = load_scene([tmp_path / name])
    assert not scene.bodies
    assert scene.unreadable[0].issue.code == code


def test_what_trimesh_warns_of_is_an_error() -> None:
    def load(*_: object, **__: object) -> None:
        logging.getLogger("trimesh").warning("node left out")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(trimesh, "load_scene", load)
        with pytest.raises(Refused, match="reads a part of it: node left out"):
            read_tail(File("zae", "", "a.zae", zae()))


def test_the_packages_to_install_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trimesh, "available_formats", lambda: {"obj"})
    with pytest.raises(Refused) as caught:
        read_tail(File("3dxml", "", "a.3dxml", threedxml()))
    assert caught.value.code == "missing-extra"
    assert "pip install 'satcheck[tail]'" in caught.value.message


def test_a_scene_that_names_a_part_says_so_too(tmp_path: Path) -> None:
    (tmp_path / "a.3dxml").write_bytes(threedxml())
    ids = [body.id for body in load_scene([tmp_path / "a.3dxml"]).bodies]
    bodies = [{"id": id_, "mesh": "a.3dxml", "part": id_} for id_ in ids]
    (tmp_path / "s.json").write_text(json.dumps({"schema": "satcheck.scene/1", "bodies": bodies}))
    ran = satcheck("s.json", "--format", "json", cwd=tmp_path)
    assert ran.code == 3
    assert [issue["code"] for issue in ran.document["issues"]].count("incomplete") == 1


def test_what_boxes_find_apart_is_an_estimate(tmp_path: Path) -> None:
    (tmp_path / "a.3dxml").write_bytes(threedxml())
    words = ("a.3dxml", "--certificate", "--format", "json", "--accept", "incomplete")
    (finding,) = satcheck(*words, cwd=tmp_path).document["findings"]
    assert (finding["relation"], finding["quality"]) == ("separated", "estimate")


def test_models_that_trimesh_joins_block_a_pass(tmp_path: Path) -> None:
    first, model, last = xaml().partition(b"<GeometryModel3D>")
    content, end, _ = last.partition(b"</GeometryModel3D>")
    for models, codes in ((1, []), (2, ["unread"])):
        text = first + models * (model + content + end) + last[len(content + end) :]
        (tmp_path / "a.xaml").write_bytes(text)
        issues = [issue.code for issue in load_scene([tmp_path / "a.xaml"]).issues]
        assert [code for code in issues if code == "unread"] == codes
