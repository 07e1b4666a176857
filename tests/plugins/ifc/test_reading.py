"""IFC: which elements are bodies, where they are, and what is refused."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import pytest

from satcheck.plugins.ifc.reader import read_ifc
from satcheck.scene import Scene, load_scene
from satcheck.scene.errors import Refused
from satcheck.scene.files import readers
from satcheck.scene.files.readers import File
from tests.plugins.ifc.models import METRES, MILLIMETRES, Model
from tests.scene.loading import refusal


def scene_of(folder: Path, model: Model, name: str = "model.ifc") -> Scene:
    path = folder / name
    path.write_bytes(model.bytes())
    return load_scene([path])


def codes(scene: Scene) -> dict[str, str]:
    return {issue.code: issue.message for issue in scene.issues}


def test_a_body_is_an_element_with_its_guid_its_title_and_its_box_in_metres(tmp_path: Path) -> None:
    model = Model(MILLIMETRES)
    model.box((1000, 2000, 500), at=(250, 0, -125), name="'Table'", guid="3abcdefghijklmnopqrst$")
    model.box((1, 1, 1), at=(0, 0, 9))
    scene = scene_of(tmp_path, model)
    assert [body.id for body in scene.bodies] == [
        "0000000000000000000002",
        "3abcdefghijklmnopqrst$",
    ]
    table = scene.bodies[1]
    assert table.name == "IfcBuildingElementProxy Table"
    assert scene.units == "m"
    assert table.world_mesh().bounds == ((0.25, 0.0, -0.125), (1.25, 2.0, 0.375))
    assert table.file.mesh.triangle_count == 12


@pytest.mark.parametrize(
    ("unit", "metres"),
    [
        (METRES, 1.0),
        (MILLIMETRES, 0.001),
        ("IFCSIUNIT(*,.LENGTHUNIT.,.CENTI.,.METRE.)", 0.01),
    ],
)
def test_lengths_are_in_the_unit_of_the_file(tmp_path: Path, unit: str, metres: float) -> None:
    model = Model(unit)
    model.box((4, 2, 1))
    (body,) = scene_of(tmp_path, model).bodies
    assert body.world_mesh().bounds[1] == pytest.approx((4 * metres, 2 * metres, metres), rel=1e-12)


def test_repeated_items_share_one_mesh(tmp_path: Path) -> None:
    model = Model()
    origin = model.add("IFCCARTESIANPOINT((0.,0.,0.))")
    source = model.add(
        f"IFCREPRESENTATIONMAP({model.origin},{model.shape(model.block((1, 1, 1)))})"
    )
    for operator, at in (("1.", 0), ("1.", 5), ("2.", 9)):
        target = model.add(f"IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,{origin},{operator},$)")
        item = model.add(f"IFCMAPPEDITEM({source},{target})")
        model.element(model.shape(item, kind="MappedRepresentation"), (at, 0, 0))
    first, second, doubled = scene_of(tmp_path, model).bodies
    assert first.file is second.file
    assert second.world_mesh().bounds == ((5, 0, 0), (6, 1, 1))
    assert doubled.world_mesh().bounds == ((9, 0, 0), (11, 2, 2))


def test_openings_are_cut_and_are_no_bodies(tmp_path: Path) -> None:
    model = Model()
    wall = model.box((4, 1, 2), kind="IFCWALL", more=",$,$")
    hole = model.box((1, 3, 1), (1, -1, 0.5), kind="IFCOPENINGELEMENT", more=",$,$")
    model.relation("IFCRELVOIDSELEMENT", f"{wall},{hole}")
    scene = scene_of(tmp_path, model)
    (body,) = scene.bodies
    assert body.file.health.closed
    assert body.file.mesh.triangle_count > 12
    assert "1 IfcOpeningElement" in codes(scene)["left-out"]


def test_what_is_no_body_is_counted(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1))
    model.box((5, 5, 5), kind="IFCSPACE", more=",$,$,$,$")
    model.box((9, 9, 1), kind="IFCSITE", more=",$,$,$,$,$,$,$")
    model.element(None, kind="IFCWALL", guid="1abcdefghijklmnopqrst$")
    scene = scene_of(tmp_path, model)
    assert len(scene.bodies) == 1
    assert "1 IfcSite, 1 IfcSpace" in codes(scene)["left-out"]
    assert "IfcWall 1abcdefghijklmnopqrst$" in codes(scene)["no-shape"]


@pytest.mark.parametrize("identifier", ["Box", "Clearance"])
def test_an_element_with_an_extent_and_no_shape_cannot_be_checked(
    tmp_path: Path, identifier: str
) -> None:
    model = Model()
    model.box((1, 1, 1))
    model.element(model.shape(model.block((1, 1, 1)), identifier=f"'{identifier}'"))
    (lost,) = scene_of(tmp_path, model).unreadable
    assert lost.issue.code == "unsupported-feature"
    assert identifier in lost.issue.message


def test_an_element_whose_type_alone_has_a_shape_cannot_be_checked(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1))
    pipe = model.element(None, kind="IFCPIPESEGMENT", more=",$,$")
    shape = model.shape(model.block((1, 1, 1)))
    mapped = model.add(f"IFCREPRESENTATIONMAP({model.origin},{shape})")
    kind = model.add(
        f"IFCPIPESEGMENTTYPE('{model.guid()}',$,'DN 50',$,$,$,({mapped}),$,$,.RIGIDSEGMENT.)"
    )
    model.relation("IFCRELDEFINESBYTYPE", f"({pipe}),{kind}")
    (lost,) = scene_of(tmp_path, model).unreadable
    assert "only its type" in lost.issue.message


def test_the_body_of_several_representations_counts(tmp_path: Path) -> None:
    """A clearance, and a coarser shape, stand beside the body; they are no material."""
    model = Model()
    shapes = ",".join(
        model.shape(model.block((size, 1, 1)), identifier=identifier)
        for size, identifier in (
            (9, "'Clearance'"),
            (1, "'Body'"),
            (7, "'Facetation'"),
            (8, "'Box'"),
        )
    )
    model.element(shapes)
    (body,) = scene_of(tmp_path, model).bodies
    assert body.world_mesh().bounds == ((0, 0, 0), (1, 1, 1))


def test_a_body_that_the_kernel_does_not_make_is_unreadable(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1))
    model.element(model.shape(model.block((1, 1, 1)), model.block((1, 1, 0))), (5, 0, 0))
    scene = scene_of(tmp_path, model)
    assert len(scene.bodies) == 1
    (lost,) = scene.unreadable
    assert lost.issue.code == "reader-failed"
    assert "IfcExtrudedAreaSolid" in lost.issue.message


def test_a_body_of_lines_is_not_checked(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1))
    points = [model.add(f"IFCCARTESIANPOINT(({x}.,0.,0.))") for x in (0, 1)]
    line = model.add(f"IFCPOLYLINE(({','.join(points)}))")
    model.element(model.shape(line, kind="Curve3D"))
    (lost,) = scene_of(tmp_path, model).unreadable
    assert lost.issue.code == "no-surface"


def test_a_file_in_a_zip_is_read(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("model.ifc", model.text())
    path = tmp_path / "model.ifczip"
    path.write_bytes(packed.getvalue())
    assert len(load_scene([path]).bodies) == 1


def broken(text: str, old: str, new: str) -> bytes:
    """{itself}: the number of the instance."""
    assert old in text
    instance = text[: text.index(old)].rpartition(";")[2].partition("=")[0]
    return text.replace(old, new.replace("{itself}", instance), 1).encode()


def good() -> str:
    model = Model()
    model.box((1, 1, 1))
    return model.text()


@pytest.mark.parametrize(
    ("content", "code"),
    [
        (b"", "not-this-format"),
        (b"solid cube", "not-this-format"),
        (b"<?xml version='1.0'?><ifcXML/>", "unsupported-feature"),
        (good().encode()[:-200], "truncated"),
        (broken(good(), "'IFC4'", "'IFC9'"), "bad-record"),
        (broken(good(), "IFCRECTANGLEPROFILEDEF(", "IFCRECTANGELPROFILEDEF("), "bad-record"),
        (broken(good(), "IFCLOCALPLACEMENT($,#", "IFCLOCALPLACEMENT($,#9"), "bad-record"),
        (broken(good(), "IFCLOCALPLACEMENT($,", "IFCLOCALPLACEMENT(3.,$,"), "bad-record"),
        (broken(good(), "ENDSEC;END-", "#3=IFCDIRECTION((0.,0.,1.));ENDSEC;END-"), "bad-record"),
        (broken(good(), "IFCBUILDINGELEMENTPROXY('", "IFCBUILDINGELEMENTPROXY($,'"), "bad-record"),
        (
            broken(good(), "=IFCLOCALPLACEMENT($,", "=IFCLOCALPLACEMENT({itself},"),
            "reference-cycle",
        ),
        (Model(unit="").bytes(), "bad-record"),
        (Model(context="").bytes(), "bad-record"),
        (Model().bytes(), "empty-mesh"),
    ],
)
def test_what_is_not_understood_is_refused(tmp_path: Path, content: bytes, code: str) -> None:
    assert refusal(tmp_path, "model.ifc", content)[0] == code


def test_a_product_that_lacks_its_last_attributes_is_read(tmp_path: Path) -> None:
    """Some programs write the form of an older schema."""
    model = Model()
    model.box((1, 1, 1), more=",$")
    assert scene_of(tmp_path, model).bodies[0].world_mesh().bounds == ((0, 0, 0), (1, 1, 1))


def test_a_missing_library_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)

    monkeypatch.setattr(readers, "import_module", missing)
    with pytest.raises(Refused) as caught:
        read_ifc(File("ifc", "", "a.ifc", good().encode()))
    assert caught.value.code == "missing-extra"
    assert "pip install 'satcheck[ifc]'" in caught.value.message


def faces(model: Model, *loops: list[str]) -> str:
    """A faceted solid of these loops of points."""
    made = []
    for points in loops:
        loop = model.add(f"IFCPOLYLOOP(({','.join(points)}))")
        made.append(model.add(f"IFCFACE(({model.add(f'IFCFACEOUTERBOUND({loop},.T.)')}))"))
    shell = model.add(f"IFCCLOSEDSHELL(({','.join(made)}))")
    return model.shape(model.add(f"IFCFACETEDBREP({shell})"), kind="Brep")


def test_a_face_that_the_kernel_leaves_out_is_a_hole_with_a_warning(tmp_path: Path) -> None:
    model = Model()
    corners = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4), (9, 9, 9)]
    a, b, c, d, e = (model.add(f"IFCCARTESIANPOINT(({x}.,{y}.,{z}.))") for x, y, z in corners)
    model.element(faces(model, [a, c, b], [a, b, d], [b, c, d], [a, e, a]))
    (body,) = scene_of(tmp_path, model).bodies
    assert not body.file.health.closed
    assert "ignored-geometry" in {issue.code for issue in body.file.issues}


def test_an_opening_that_the_kernel_cannot_cut_leaves_no_body_without_it(tmp_path: Path) -> None:
    """The wall would have more material than the file says."""
    model = Model()
    model.box((1, 1, 1), (9, 9, 9))
    wall = model.box((4, 1, 2), kind="IFCWALL", more=",$,$")
    hole = model.box((1, 3, 0), (1, -1, 0.5), kind="IFCOPENINGELEMENT", more=",$,$")
    model.relation("IFCRELVOIDSELEMENT", f"{wall},{hole}")
    scene = scene_of(tmp_path, model)
    assert [body.path for body in scene.unreadable] == ["0000000000000000000003"]


def test_a_model_with_a_map_conversion_says_that_it_is_not_applied(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1))
    target = model.add("IFCPROJECTEDCRS('EPSG:25832',$,$,$,$,$,$)")
    model.add(f"IFCMAPCONVERSION({model.context},{target},1000.,2000.,30.,$,$,$)")
    scene = scene_of(tmp_path, model)
    assert scene.bodies[0].world_mesh().bounds == ((0, 0, 0), (1, 1, 1))
    assert "IfcMapConversion" in codes(scene)["left-out"]


def test_a_body_far_from_the_origin_keeps_its_digits(tmp_path: Path) -> None:
    model = Model()
    model.box((1, 1, 1), at=(4_500_000.125, 5_300_000.25, 500.5))
    (body,) = scene_of(tmp_path, model).bodies
    assert body.world_mesh().bounds[0] == (4_500_000.125, 5_300_000.25, 500.5)
    assert body.resolution_world < 1e-6
