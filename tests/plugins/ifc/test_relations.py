"""IFC: rules from the relations of the file, and the groups of its elements."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import check
from satcheck.audit.settings import Settings
from tests.plugins.ifc.models import Model
from tests.plugins.ifc.test_reading import scene_of

WALL = {"kind": "IFCWALL", "more": ",$,$"}


def severities(folder: Path, model: Model) -> list[str]:
    """Of the findings of overlaps."""
    report = check(scene_of(folder, model), Settings(depth=False))
    return [
        f.severity for f in report.findings if f.relation in ("penetrating", "contains", "inside")
    ]


def two_walls(model: Model) -> tuple[str, str]:
    return model.box((4, 1, 2), **WALL), model.box((1, 4, 2), **WALL)


def test_an_overlap_without_a_relation_is_an_error(tmp_path: Path) -> None:
    model = Model()
    two_walls(model)
    assert severities(tmp_path, model) == ["error"]


def test_an_overlap_of_a_window_and_its_host_is_a_note(tmp_path: Path) -> None:
    model = Model()
    wall = model.box((4, 1, 2), **WALL)
    hole = model.box((1, 3, 1), (1, -1, 0.5), kind="IFCOPENINGELEMENT", more=",$,$")
    window = model.box((1.5, 1, 1), (1, 0, 0.5), kind="IFCWINDOW", more=",$,$,$,$,$,$")
    model.relation("IFCRELVOIDSELEMENT", f"{wall},{hole}")
    model.relation("IFCRELFILLSELEMENT", f"{hole},{window}")
    assert severities(tmp_path, model) == ["note"]


@pytest.mark.parametrize(
    ("kind", "rest", "expected"),
    [
        ("IFCRELCONNECTSPATHELEMENTS", "$,{a},{b},(),(),.ATEND.,.ATSTART.", ["note"]),
        ("IFCRELCONNECTSELEMENTS", "$,{a},{b}", ["note"]),
        ("IFCRELCOVERSBLDGELEMENTS", "{a},({b})", ["note"]),
        ("IFCRELAGGREGATES", "{a},({b})", []),
    ],
)
def test_a_relation_of_two_elements_is_a_rule(
    tmp_path: Path, kind: str, rest: str, expected: list[str]
) -> None:
    model = Model()
    a = model.box((4, 1, 2), **WALL)
    b = model.box((1, 4, 2), kind="IFCCOVERING", more=",$,$")
    model.relation(kind, rest.format(a=a, b=b))
    assert severities(tmp_path, model) == expected
    (rule,) = scene_of(tmp_path, model).rules
    assert kind.lower() in rule.reason.lower()


@pytest.mark.parametrize(
    ("size", "at", "expected"),
    [
        ((1, 4, 2), (0, 0, 0), "note"),  # a quarter of either wall is in the corner
        ((4, 1, 2), (0, 0, 0), "error"),  # twice the same wall
        ((4, 1, 2), (0, 0.125, 0), "error"),  # nearly the same wall
        ((1, 1, 2), (1, 0, 0), "error"),  # a piece of it
    ],
)
def test_joined_walls_overlap_in_a_corner_only(
    tmp_path: Path, size: tuple[float, ...], at: tuple[float, ...], expected: str
) -> None:
    model = Model()
    a, b = model.box((4, 1, 2), **WALL), model.box(size, at, **WALL)
    model.relation("IFCRELCONNECTSPATHELEMENTS", f"$,{a},{b},(),(),.ATEND.,.ATSTART.")
    report = check(scene_of(tmp_path, model), Settings(depth=False))
    assert [finding.severity for finding in report.findings] == [expected]


def test_parts_of_one_whole_meet_by_design(tmp_path: Path) -> None:
    model = Model()
    a, b = two_walls(model)
    stair = model.element(None, kind="IFCSTAIR", more=",$,$")
    model.relation("IFCRELAGGREGATES", f"{stair},({a},{b})")
    model.box((1, 1, 1), (3, 0, 0), **WALL)
    assert sorted(severities(tmp_path, model)) == ["error", "note"]


def test_reinforcement_lies_in_its_host(tmp_path: Path) -> None:
    model = Model()
    model.box((4, 1, 1), kind="IFCBEAM", more=",$,$")
    model.box((3, 0.1, 0.1), (0.5, 0.2, 0.2), kind="IFCREINFORCINGBAR", more=",$" * 7)
    assert severities(tmp_path, model) == ["note"]


def test_groups_are_classes_storey_type_and_systems(tmp_path: Path) -> None:
    model = Model()
    pipe = model.box((1, 1, 1), kind="IFCPIPESEGMENT", more=",$,$")
    storey = model.element(None, kind="IFCBUILDINGSTOREY", name="'Ground'", more=",$,.ELEMENT.,0.")
    model.relation("IFCRELCONTAINEDINSPATIALSTRUCTURE", f"({pipe}),{storey}")
    kind = model.add(f"IFCPIPESEGMENTTYPE('{model.guid()}',$,'DN 50',$,$,$,$,$,$,.RIGIDSEGMENT.)")
    model.relation("IFCRELDEFINESBYTYPE", f"({pipe}),{kind}")
    system = model.add(f"IFCSYSTEM('{model.guid()}',$,'Heating',$,$)")
    model.relation("IFCRELASSIGNSTOGROUP", f"({pipe}),$,{system}")
    (body,) = scene_of(tmp_path, model).bodies
    assert body.groups == (
        "IfcPipeSegment",
        "IfcFlowSegment",
        "IfcDistributionFlowElement",
        "IfcDistributionElement",
        "storey:Ground",
        "type:DN 50",
        "system:Heating",
    )
