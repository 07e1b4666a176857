"""Reports for people name an IFC element by its class and name; reports for programs by its id."""

from __future__ import annotations

from pathlib import Path

from tests.cli.process import satcheck
from tests.plugins.ifc.models import Model


def two_boxes(folder: Path) -> str:
    model = Model()
    model.box((2, 2, 2), name="'Plinth'", guid="3abcdefghijklmnopqrst1")
    model.box((2, 2, 2), at=(1, 0, 0), name="'Wall'", guid="3abcdefghijklmnopqrst2")
    path = folder / "house.ifc"
    path.write_bytes(model.bytes())
    return str(path)


def test_a_table_names_class_name_and_id(tmp_path: Path) -> None:
    ran = satcheck(two_boxes(tmp_path), env={"COLUMNS": "200"})
    row = ran.out.splitlines()[2]
    assert "IfcBuildingElementProxy Plinth (3abcdefghijklmnopqrst1)" in row
    assert "IfcBuildingElementProxy Wall (3abcdefghijklmnopqrst2)" in row


def test_the_json_keeps_the_ids(tmp_path: Path) -> None:
    document = satcheck("--format", "json", two_boxes(tmp_path)).document
    (finding,) = document["findings"]
    assert (finding["a"], finding["b"]) == ("3abcdefghijklmnopqrst1", "3abcdefghijklmnopqrst2")
    assert document["bodies"][0]["name"] == "IfcBuildingElementProxy Plinth"
