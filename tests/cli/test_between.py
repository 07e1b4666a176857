"""`--between X Y`: only pairs with one body in each are checked."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import check
from satcheck.audit.settings import Settings
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from tests.cli.process import SAMPLES, satcheck
from tests.plugin_marks import needs
from tests.plugins.ifc.models import Model

THREE = ("box.obj", "box_pushed.stl", "cube.off")


def test_other_pairs_are_not_checked() -> None:
    one = satcheck(*THREE, "--between", "box", "box_*", "--format", "json", cwd=SAMPLES)
    assert [(f["a"], f["b"]) for f in one.document["findings"]] == [("box", "box_pushed")]
    assert one.document["summary"]["pairs"]["allowed"] == 2


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("nothing*", "no body is nothing*: there are box, box_pushed, cube"),
        ("box_pushe", "no body is box_pushe (did you mean 'box_pushed'?)"),
        ("group:nuts", "no group is group:nuts: there are none"),
    ],
)
def test_a_name_that_selects_nothing_is_an_error(name: str, told: str) -> None:
    ran = satcheck(*THREE, "--between", "box", name, cwd=SAMPLES)
    assert (ran.code, ran.out) == (2, "")
    assert f"--between: {told}" in ran.err


def test_several_sets_add_up() -> None:
    both = ("--between", "box", "box_pushed", "--between", "cube", "box")
    ran = satcheck(*THREE, *both, "--format", "json", cwd=SAMPLES)
    assert ran.document["summary"]["pairs"]["allowed"] == 1


@needs("ifc")
def test_the_relations_of_a_file_still_hold(tmp_path: Path) -> None:
    """A whole may overlap its part, and a pipe may not overlap a wall."""
    model = Model()
    wall = model.box((4, 1, 2), kind="IFCWALL", more=",$,$")
    part = model.box((1, 4, 2), kind="IFCCOVERING", more=",$,$")
    model.box((1, 1, 1), kind="IFCPIPESEGMENT", more=",$,$")
    model.relation("IFCRELAGGREGATES", f"{wall},({part})")
    (tmp_path / "a.ifc").write_bytes(model.bytes())

    def found(*between: tuple[str, str]) -> list[set[str]]:
        scene = load_scene([tmp_path / "a.ifc"], between=between)
        names = {body.id: body.name for body in scene.bodies}
        report = check(scene, Settings(depth=False))
        return [{names[f.a], names[f.b]} for f in report.findings]

    assert found(("group:IfcWall", "group:IfcCovering")) == []
    assert found(("group:IfcWall", "group:Ifc*Segment")) == [{"IfcWall", "IfcPipeSegment"}]


def test_an_empty_selector_is_refused() -> None:
    with pytest.raises(SatcheckError, match="empty"):
        load_scene([SAMPLES / "box.obj"], between=[("", "*")])
