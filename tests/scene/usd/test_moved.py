"""USD files of moved bodies: what was moved has moved, and nothing else has."""

from __future__ import annotations

from pathlib import Path

import pytest
from pxr import Sdf

from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.scene.loading.reading_children import ReadingChildren
from satcheck.scene.moved.usd import Request, moved_usd
from satcheck.scene.read_options import ReadOptions
from tests.scene.usd.files import at, bounds_of, cube, stage

BY = (0.25, -2.0, 0.5)
TURNED = """ matrix4d xformOp:transform = ((0,2,0,0), (-2,0,0,0), (0,0,2,0), (10,0,0,1))
 uniform token[] xformOpOrder = ["xformOp:transform"]
"""
# A body below a body, one that ignores what is above it, and one beside them.
NESTED = stage(
    f'def Xform "World" {{\n{TURNED}',
    cube("Table", at(1)).removesuffix("}\n")
    + cube("Vase", at(0, 0, 1))
    + cube("Free", 'uniform token[] xformOpOrder = ["!resetXformStack!"]')
    + "}\n",
    cube("Lamp", at(5)),
    "}",
)


def moved(folder: Path, source: str, suffix: str = ".usda", **by: tuple[float, float, float]):
    path = folder / "stage.usda"
    path.write_text(source)
    before = bounds_of(load_scene([path]))
    request = Request(
        str(path), suffix, tuple(before), {f"/World/{name}": step for name, step in by.items()},
        ReadOptions(),
    )  # fmt: skip
    output = folder / f"moved{suffix}"
    output.write_bytes(moved_usd(request, ReadingChildren(2048), seconds=60))
    return before, bounds_of(load_scene([output]))


def shifted(box, by):
    return tuple(tuple(x + d for x, d in zip(corner, by, strict=True)) for corner in box)


@pytest.mark.parametrize("suffix", [".usda", ".usdc", ".usd"])
def test_only_the_moved_body_moves_below_a_turned_parent(tmp_path: Path, suffix: str) -> None:
    before, after = moved(tmp_path, NESTED, suffix, Table=BY)
    assert after == before | {"/World/Table": shifted(before["/World/Table"], BY)}


def test_a_body_below_a_moved_body_takes_its_own_way(tmp_path: Path) -> None:
    source = NESTED.replace('"Vase"', '"V"')
    before, after = moved(tmp_path, source, **{"Table": BY, "Table/V": (0, 0, 4)})
    assert after["/World/Table"] == shifted(before["/World/Table"], BY)
    assert after["/World/Table/V"] == shifted(before["/World/Table/V"], (0, 0, 4))
    assert after["/World/Table/Free"] == before["/World/Table/Free"]


def test_translations_are_of_the_scene_whose_z_axis_points_up(tmp_path: Path) -> None:
    source = stage(
        'def Xform "World" {', cube("A"), cube("B", at(4)), "}",
        head='metersPerUnit = 0.01\nupAxis = "Y"',
    )  # fmt: skip
    before, after = moved(tmp_path, source, A=BY)
    assert after == before | {"/World/A": shifted(before["/World/A"], BY)}


def test_moving_twice_adds_up(tmp_path: Path) -> None:
    before, _ = moved(tmp_path, NESTED, Lamp=BY)
    _, after = moved(tmp_path, (tmp_path / "moved.usda").read_text(), Lamp=BY)
    assert after["/World/Lamp"] == shifted(before["/World/Lamp"], tuple(2 * x for x in BY))


def test_all_other_opinions_stay(tmp_path: Path) -> None:
    moved(tmp_path, NESTED, Lamp=BY)
    old, new = (Sdf.Layer.FindOrOpen(str(tmp_path / name)) for name in ("stage.usda", "moved.usda"))
    spec = new.GetPrimAtPath("/World/Lamp")
    spec.RemoveProperty(spec.properties["xformOp:translate:resolved"])
    spec.attributes["xformOpOrder"].default = ["xformOp:translate"]
    assert new.ExportToString() == old.ExportToString()


def test_an_instance_is_not_moved(tmp_path: Path) -> None:
    source = stage(
        'class "Box" {', cube("Geom"), "}",
        'def Xform "World" {', 'def "A" (\n instanceable = true\n inherits = </Box>\n) {}', "}",
    )  # fmt: skip
    with pytest.raises(SatcheckError) as caught:
        moved(tmp_path, source, **{"A/Geom": BY})
    assert caught.value.code == "not-movable"
    assert "/World/A/Geom" in caught.value.message


def test_a_reference_to_a_moved_prim_is_not_moved_unseen(tmp_path: Path) -> None:
    source = stage(
        'def Xform "World" {', 'def Xform "S" {', cube("A"), "}",
        f'def Xform "T" (\n references = </World/S>\n) {{ {at(9)} }}', "}",
    )  # fmt: skip
    with pytest.raises(SatcheckError, match="refers to a prim that is moved") as caught:
        moved(tmp_path, source, **{"S/A": BY})
    assert caught.value.code == "not-movable"
    assert "/World/T/A" in caught.value.message
