"""Units of length on the command line: converted, stated by --units, or exit code 3."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.cli.process import SAMPLES, VALIDATOR, satcheck
from tests.scene import files

JSON = ("--format", "json")


def cube_at(x: float, size: float = 1.0) -> list[tuple[float, float, float]]:
    return [(x + size * a, size * b, size * c) for a, b, c in files.CUBE_POINTS]


def glb(points: files.Points) -> bytes:
    return files.glb(*files.gltf_document(points))


def threemf(points: files.Points, unit: str) -> bytes:
    model = files.model_3mf(
        files.object_3mf(1, points), '<item objectid="1"/>', attributes=f'unit="{unit}"'
    )
    return files.package_3mf({"3D/3dmodel.model": model})


@pytest.mark.parametrize("order", [("a.glb", "b.3mf"), ("b.3mf", "a.glb")])
def test_a_glb_in_metres_and_a_3mf_in_millimetres(tmp_path: Path, order: tuple[str, str]) -> None:
    """The second cube is one metre, too, and overlaps the first by a quarter."""
    (tmp_path / "a.glb").write_bytes(glb(cube_at(0)))
    (tmp_path / "b.3mf").write_bytes(threemf(cube_at(750, 1000), "millimeter"))
    ran = satcheck(*JSON, "--certificate", *order, cwd=tmp_path)
    VALIDATOR.validate(ran.document)
    assert ran.code == 1
    (found,) = ran.document["findings"]
    assert (found["relation"], ran.document["units"]) == ("penetrating", "mm")
    assert found["depth"] == pytest.approx(250, rel=1e-12)
    bodies = {body["id"]: body for body in ran.document["bodies"]}
    assert (bodies["a"]["units"], bodies["a"]["unit_scale"]) == ("mm", 1000)
    assert bodies["b"]["unit_scale"] is None
    (note,) = [i for i in ran.document["issues"] if i["code"] == "units-converted"]
    assert note["message"] == "a.glb: converted from m to mm, times 1000"
    (tmp_path / "report.json").write_text(ran.out)
    assert satcheck("verify", "report.json", cwd=tmp_path).code == 0


def test_what_states_no_unit_beside_what_does_is_not_decided(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(glb(cube_at(0)))
    (tmp_path / "b.stl").write_bytes(files.binary_stl(cube_at(5)))
    (tmp_path / "c.obj").write_bytes(files.obj(cube_at(5.5)))
    ran = satcheck(*JSON, "a.glb", "b.stl", cwd=tmp_path)
    VALIDATOR.validate(ran.document)
    assert ran.code == 3
    (found,) = ran.document["findings"]
    assert (found["relation"], found["undecided"]) == ("indeterminate", "relation")
    assert found["reason"] == "a is in m, and no unit of length is stated for b"
    assert ran.document["effects"][0]["not_run"] == {"units unknown": 1}
    table = satcheck("a.glb", "b.stl", cwd=tmp_path)
    assert table.code == 3
    last = " ".join(table.out.split())
    assert last.count("b.stl: no unit of length is stated, unlike a.glb in m") == 1
    assert "State the unit: --units [units-unknown] 2 bodies" in last
    assert last.endswith("Next: --units states the unit of files that have none.")
    # What is of one kind among them is decided.
    ran = satcheck(*JSON, "a.glb", "b.stl", "c.obj", cwd=tmp_path)
    relations = {(f["a"], f["b"]): f["relation"] for f in ran.document["findings"]}
    assert relations["b", "c"] == "penetrating"
    assert relations["a", "b"] == relations["a", "c"] == "indeterminate"
    assert ran.code == 1


def test_units_say_what_the_files_do_not(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(glb(cube_at(0)))
    (tmp_path / "b.stl").write_bytes(files.binary_stl(cube_at(5)))
    assert satcheck("a.glb", "b.stl", "--units", "m", cwd=tmp_path).code == 0
    ran = satcheck(*JSON, "a.glb", "b.stl", "--units", "mm", cwd=tmp_path)
    assert ran.code == 1
    assert ran.document["findings"][0]["relation"] == "penetrating"
    # Lengths may then carry units, of files that state none as well.
    ran = satcheck(*JSON, "b.stl", "box.obj", "--units", "mm", "--clearance", "1cm", cwd=tmp_path)
    assert ran.code == 2
    (tmp_path / "box.obj").write_bytes(files.obj())
    ran = satcheck(*JSON, "b.stl", "box.obj", "--units", "mm", "--clearance", "1cm", cwd=tmp_path)
    assert ran.document["findings"][0]["relation"] == "near"
    assert ran.document["units"] == "mm"


@pytest.mark.parametrize("command", ["resolve", "tradeoff"])
def test_other_commands_refuse_and_take_units(command: str, tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(glb(cube_at(0)))
    (tmp_path / "b.stl").write_bytes(files.binary_stl(cube_at(0.5)))
    refused = satcheck(command, "a.glb", "b.stl", cwd=tmp_path)
    assert refused.code == 2
    assert "State the unit: --units" in refused.err
    ran = satcheck(command, "a.glb", "b.stl", "--units", "m", cwd=tmp_path)
    assert ran.code == 0, ran.err


def test_suggest_leaves_out_what_has_no_common_unit(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(glb(cube_at(0)))
    (tmp_path / "b.stl").write_bytes(files.binary_stl(cube_at(0.5)))
    ran = satcheck("suggest", "a.glb", "b.stl", cwd=tmp_path)
    assert (ran.code, "[[rules]]" in ran.out) == (3, False)
    ran = satcheck("suggest", "a.glb", "b.stl", "--units", "m", cwd=tmp_path)
    assert (ran.code, "[[rules]]" in ran.out) == (0, True)


def test_what_resolve_writes_is_in_the_same_units(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(glb(cube_at(0)))
    (tmp_path / "b.3mf").write_bytes(threemf(cube_at(750, 1000), "millimeter"))
    (tmp_path / "c.stl").write_bytes(files.binary_stl(cube_at(160, 100)))
    given = ("a.glb", "b.3mf", "c.stl", "--units", "cm")
    assert satcheck(*given, cwd=tmp_path).code == 1
    ran = satcheck("resolve", *given, "-o", "moved.scene.json", cwd=tmp_path)
    assert ran.code == 0, ran.err
    scene = json.loads((tmp_path / "moved.scene.json").read_text())
    assert scene["units"] == "mm"
    assert [body.get("units") for body in scene["bodies"]] == [None, None, "cm"]
    ran = satcheck(*JSON, "moved.scene.json", cwd=tmp_path)
    assert ran.code == 0
    sizes = [
        body["unit_scale"] for body in ran.document["bodies"] if body["unit_scale"] is not None
    ]
    assert sizes == [1000, 10]


def test_a_table_of_poses_says_it() -> None:
    ran = satcheck("arm.urdf", "arm.srdf", "box.obj", "--sample", "2")
    assert ran.code == 3
    last = " ".join(ran.out.split())
    assert "warning: box.obj: no unit of length is stated, unlike arm.urdf in m: their" in last


def test_a_unit_without_effect_is_said(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(glb(cube_at(0)))
    (tmp_path / "b.glb").write_bytes(glb(cube_at(3)))
    said = "--units has no effect: each file states its unit"
    told = satcheck("a.glb", "b.glb", "--units", "mm", cwd=tmp_path).err
    assert f'{said}; units = "mm" of a body in a scene file overrides it' in told
    assert said not in satcheck("a.glb", "b.glb", cwd=tmp_path).err
    shutil.copy(SAMPLES / "box.obj", tmp_path)
    assert said not in satcheck("a.glb", "box.obj", "--units", "mm", cwd=tmp_path).err
