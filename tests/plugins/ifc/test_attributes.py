"""Attributes of other kinds than the schema prescribes, and names that are no UTF-8."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from satcheck.scene import load_scene
from tests.cli.process import on_posix
from tests.plugins.ifc.models import Model

pytest.importorskip("ifcopenshell")

ROOT = "('{guid}',$,$,$,"


def _model() -> Model:
    model = Model()
    model.box((1, 1, 1))
    return model


def _read(folder: Path, text: str) -> tuple[str, str]:
    """The code of the error and its message; "": the file is read."""
    path = folder / "m.ifc"
    path.write_text(text)
    scene = load_scene([path])
    if scene.bodies:
        return "", ""
    (lost,) = scene.unreadable
    return lost.issue.code, lost.issue.message


@pytest.mark.parametrize("value", ["$", "1.", "(1.)", "(#1)", "'x'", ".T."])
def test_a_shape_without_representations_is_refused(value: str, tmp_path: Path) -> None:
    model = _model()
    place, shape = model.local(), model.add(f"IFCPRODUCTDEFINITIONSHAPE($,$,{value})")
    model.add(f"IFCDOOR('{model.guid()}',$,$,$,$,{place},{shape},$,$,$,$,$,$)")
    code, message = _read(tmp_path, model.text())
    assert code == "bad-record"
    assert f"IfcProductDefinitionShape {shape}: Representations is not" in message


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("IFCLOCALPLACEMENT(1,{at})", "IfcLocalPlacement {line}: PlacementRelTo"),
        ("IFCLOCALPLACEMENT((#1,#1),{at})", "IfcLocalPlacement {line}: PlacementRelTo"),
        ("IFCDOOR('{guid}',$,$,$,$,$,(1.),$,$,$,$,$,$)", "IfcDoor {line}: Representation"),
        ("IFCSHAPEREPRESENTATION({context},('Body'),$,())", "{line}: RepresentationIdentifier"),
        ("IFCSHAPEREPRESENTATION({context},'Body',$,#1)", "{line}: Items"),
        ("IFCMAPPEDITEM($,$)", "IfcMappedItem {line}: MappingSource"),
        (f"IFCRELASSIGNSTOGROUP{ROOT}({{body}}),$,1)", "{line}: RelatingGroup"),
        (f"IFCRELAGGREGATES{ROOT}{{body}},(#1))", "{line}: RelatedObjects"),
        (f"IFCRELAGGREGATES{ROOT}$,({{body}}))", "{line}: RelatingObject"),
        (f"IFCRELFILLSELEMENT{ROOT}{{body}},{{body}})", "{line}: RelatingOpeningElement"),
        ("IFCUNITASSIGNMENT('x')", "IfcUnitAssignment {line}: Units"),
    ],
)
def test_an_attribute_of_another_kind_is_refused(line: str, told: str, tmp_path: Path) -> None:
    model = _model()
    body = model.box((1, 1, 1), (5, 0, 0))
    names = {"at": model.origin, "guid": model.guid(), "body": body, "context": model.context}
    number = model.add(line.format(**names))
    code, message = _read(tmp_path, model.text())
    assert code == "bad-record"
    assert told.format(line=number) in message
    assert "is not what the schema prescribes" in message


def test_what_moves_and_shapes_nothing_may_be_anything(tmp_path: Path) -> None:
    """Many programs write no OwnerHistory, and odd names."""
    model = _model()
    body = model.box((1, 1, 1), (5, 0, 0), name="5")
    model.add(f"IFCRELDEFINESBYPROPERTIES('{model.guid()}',$,$,$,({body}),$)")
    assert _read(tmp_path, model.text()) == ("", "")
    older = Model(schema="IFC2X3")
    older.box((1, 1, 1))
    assert _read(tmp_path, older.text()) == ("", "")


@on_posix
@pytest.mark.parametrize("name", [b"m\xff.ifc", b"d\xff/m.ifc"])
def test_a_file_may_have_a_name_that_is_no_utf8(name: bytes, tmp_path: Path) -> None:
    path = tmp_path / os.fsdecode(name)
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(_model().bytes())
    assert len(load_scene([path]).bodies) == 1
