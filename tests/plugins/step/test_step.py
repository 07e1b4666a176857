"""STEP: products of assemblies as bodies, and what is not read."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from satcheck.audit import Settings, check
from satcheck.plugins.step.assembly import read_step
from satcheck.plugins.step.exchange import read_exchange
from satcheck.plugins.step.readers import CHORD
from satcheck.scene import MeshFile, Refused, Scene, load_scene
from satcheck.scene.files.readers import File
from satcheck.verify import verify
from tests.plugins.step.files import StepFile, rig
from tests.scene.loading import refusal

INCH = 25.4


def load(folder: Path, text: str, name: str = "a.step", **options: float) -> Scene:
    path = folder / name
    path.write_text(text, "utf-8")
    return load_scene([path], reading=options)


def boxes(scene: Scene) -> dict[str, tuple[tuple[float, ...], ...]]:
    return {body.id: body.world_mesh().bounds for body in scene.bodies}


def codes(scene: Scene) -> list[str]:
    return [issue.code for issue in scene.issues]


def test_each_occurrence_of_a_product_is_a_body_with_the_path_of_its_names(tmp_path: Path) -> None:
    scene = load(tmp_path, rig())
    placed = boxes(scene)
    low, high = placed.pop("rig/pin 1")
    assert low == pytest.approx((-4, -4, 3), abs=CHORD)
    assert high == pytest.approx((4, 4, 33), abs=CHORD)
    assert placed == {
        "rig/base": ((-20, -20, 0), (20, 20, 5)),
        "rig/plate": ((-20, -20, 40), (20, 20, 45)),
    }
    assert scene.units == "mm"
    assert all(body.file.health.solid for body in scene.bodies)


@pytest.mark.parametrize(("unit", "size"), [("in", 1 / INCH), ("m", 1e-3)])
def test_files_in_other_units_are_in_millimetres(tmp_path: Path, unit: str, size: float) -> None:
    given, expected = boxes(load(tmp_path, rig(unit, size))), boxes(load(tmp_path, rig()))
    assert given.keys() == expected.keys()
    for name, box in given.items():
        for corner, other in zip(box, expected[name], strict=True):
            assert corner == pytest.approx(other, abs=45 * 2**-22)  # float32, near 45


def test_occurrences_of_one_product_share_its_mesh(tmp_path: Path) -> None:
    base, plate, _ = load(tmp_path, rig()).bodies
    assert base.file is plate.file


def test_curved_bodies_are_off_by_the_chord_tolerance_and_flat_ones_are_exact(
    tmp_path: Path,
) -> None:
    scene = load(tmp_path, rig(), chord_tolerance=0.25)
    assert [body.facet_tolerance for body in scene.bodies] == [0, 0, 0.25]
    (faceted,) = [issue for issue in scene.issues if issue.code == "faceted"]
    assert "1 of 2 products" in faceted.message
    assert "0.25 mm" in faceted.message


def test_finer_facets_are_nearer_to_the_surface(tmp_path: Path) -> None:
    def volume(chord: float) -> float:
        pin = load(tmp_path, rig(), chord_tolerance=chord, angular_tolerance=3.0).bodies[2]
        return pin.file.health.volume

    exact = 3.141592653589793 * 4**2 * 30
    for chord in (0.5, 0.05, 0.005):
        # A segment of a circle has two thirds of the area of its chord times its height.
        assert 0 < exact - volume(chord) < 2 * 3.2 * 4 * chord * 30


def touch_or_overlap(folder: Path, radius: float, **settings: float) -> tuple[str, float | None]:
    """Two pins of 8 mm whose axes are so far apart that they overlap by 0.004 mm."""
    file = StepFile()
    whole = file.product("pair", [], kind="")
    pin = file.product("pin", [file.cylinder(radius, 10)])
    file.occurrence("left", whole, pin, (0, 0, 0))
    file.occurrence("right", whole, pin, (2 * radius - 0.004, 0, 0))
    report = check(load(folder, file.text()), Settings(depth=True, **settings))
    (finding,) = report.findings
    return finding.relation, report.bodies[0].surface_tolerance


def test_an_overlap_that_facets_explain_is_a_touch_unless_the_user_says_otherwise(
    tmp_path: Path,
) -> None:
    assert touch_or_overlap(tmp_path, 4) == ("touching", CHORD)
    assert touch_or_overlap(tmp_path, 4, surface_tolerance=0.0) == ("penetrating", None)


def test_the_facets_of_a_report_are_made_again_for_its_verification(tmp_path: Path) -> None:
    scene = load(tmp_path, rig(), chord_tolerance=0.25)
    document = check(scene, Settings(certificate=True)).to_dict()
    assert document["reading"] == {"chord_tolerance": 0.25, "angular_tolerance": 0.5}
    root = Path("/")
    assert not verify(document, root).faults
    document["reading"]["chord_tolerance"] = 0.02
    assert any("the file says" in fault for fault in verify(document, root).faults)


def test_a_part_in_another_file_is_a_body_that_cannot_be_read(tmp_path: Path) -> None:
    file = StepFile()
    whole = file.product("rig", [], kind="")
    box = file.product("box", [file.box((0, 0, 0), (1, 1, 1))])
    other = file.product("motor", [], kind="")
    file.add("DOCUMENT_FILE('motor.stp','','',$,'',$)")
    file.occurrence("near", whole, box, (0, 0, 0))
    file.occurrence("drive", whole, other, (0, 0, 0))
    scene = load(tmp_path, file.text())
    assert [body.id for body in scene.bodies] == ["rig/near"]
    (lost,) = scene.unreadable
    assert (lost.id, lost.issue.code) == ("rig/drive", "missing-resource")
    assert "'motor.stp'" in lost.issue.message


def test_an_open_shell_is_a_body_that_is_not_closed(tmp_path: Path) -> None:
    file = StepFile()
    kind = "MANIFOLD_SURFACE_"
    file.product("lid", [file.box((0, 0, 0), (1, 1, 1), sides=5)], kind=kind)
    scene = load(tmp_path, file.text())
    assert "not-closed" in codes(scene)
    assert isinstance(scene.bodies[0].file, MeshFile)
    assert not scene.bodies[0].file.health.closed


def curves_alone(file: StepFile) -> int:
    circle = file.add(f"CIRCLE('',#{file.origin},5.)")
    curves = file.add(f"GEOMETRIC_CURVE_SET('',(#{circle}))")
    return file.product("wire", [curves], kind="GEOMETRICALLY_BOUNDED_WIREFRAME_")


def test_products_of_curves_are_left_out_and_named(tmp_path: Path) -> None:
    file = StepFile()
    whole = file.product("rig", [], kind="")
    box = file.product("box", [file.box((0, 0, 0), (1, 1, 1))])
    file.occurrence("box", whole, box, (0, 0, 0))
    file.occurrence("sketch", whole, curves_alone(file), (0, 0, 0))
    scene = load(tmp_path, file.text())
    assert [body.id for body in scene.bodies] == ["rig/box"]
    assert not scene.unreadable
    (left_out,) = [issue for issue in scene.issues if issue.code == "ignored-geometry"]
    assert "rig/sketch" in left_out.message


def test_a_file_without_a_surface_is_refused(tmp_path: Path) -> None:
    file = StepFile()
    curves_alone(file)
    code, message = refusal(tmp_path, "a.stp", file.text().encode())
    assert (code, "curves" in message) == ("empty-mesh", True)


BOX = StepFile()
BOX.product("box", [BOX.box((0, 0, 0), (1, 1, 1))])
GOOD = BOX.text()
REFUSED = {
    "other": ("solid box\nendsolid\n", "not-this-format", "ISO-10303-21"),
    "cut": (GOOD[: len(GOOD) // 2], "truncated", "END-ISO-10303-21"),
    "text": (GOOD.replace("'box'", "'box", 1), "truncated", "within a text"),
    "dangling": (GOOD.replace("#1=", "#9999=", 1), "index-out-of-range", "#1"),
    "ifc": (BOX.text("IFC4"), "format-mismatch", "IFC"),
    "csg": (GOOD.replace("MANIFOLD_SOLID_BREP", "CSG_SOLID"), "empty-mesh", "CSG_SOLID"),
    "text for a number": (GOOD.replace("(1.0,", "('1.0',", 1), "bad-record", "no number"),
    "two places": (GOOD.replace("(1.0,", "(1,0,", 1), "bad-record", "no number"),
    "twice": (GOOD.replace("#2=", "#1=", 1), "bad-record", "two records #1"),
    "facets": (
        GOOD.replace("ADVANCED_FACE", "TRIANGULATED_FACE"),
        "unsupported-feature",
        "TRIANGULATED_FACE",
    ),
    "nan": (GOOD.replace("(1.0,", "(nan,", 1), "bad-record", "'nan' is no value"),
    "nanE1": (GOOD.replace("(1.0,", "(nanE-17,", 1), "bad-record", "'nanE' is no value"),
    "-inf": (GOOD.replace("(1.0,", "(-inf,", 1), "bad-record", "'-inf' is no value"),
    "unit": (GOOD.replace(".METRE.", ".CUBIT."), "bad-record", "CUBIT"),
    "empty": (StepFile().text(), "bad-record", "no product"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_file_that_cannot_be_trusted_is_refused(tmp_path: Path, name: str) -> None:
    text, code, words = REFUSED[name]
    given, message = refusal(tmp_path, "a.step", text.encode())
    assert (given, words in message) == (code, True), message


@pytest.mark.parametrize("lost", range(0, len(GOOD.splitlines()), 7))
def test_a_file_that_lacks_a_record_is_refused(tmp_path: Path, lost: int) -> None:
    """No record of this file is without use, so the loss of one always shows."""
    lines = GOOD.splitlines()
    if not lines[lost].startswith("#"):
        return
    record = lines.pop(lost)
    if record.partition("=")[0] + ")" in GOOD or record.partition("=")[0] + "," in GOOD:
        code, _ = refusal(tmp_path, "a.step", "\n".join(lines).encode())
        assert code == "index-out-of-range"


def test_names_are_read_with_the_escapes_of_the_format() -> None:
    file = StepFile()
    whole = file.product("all", [], kind="")
    part = file.product(r"\X2\00FC0062\X0\er ''a''", [file.box((0, 0, 0), (1, 1, 1))])
    file.occurrence("", whole, part, (0, 0, 0), id_="NAUO1")
    assert read_exchange(file.text().encode()).products == {"NAUO1": "über 'a'"}


def test_faces_that_are_not_read_are_counted(tmp_path: Path) -> None:
    face = next(line for line in GOOD.splitlines() if "CLOSED_SHELL" in line)
    first, _, rest = face.partition("('',(")
    lost = GOOD.replace(face, f"{first}('',({rest.partition(',')[2]}")
    scene = load(tmp_path, lost)
    (said,) = [issue for issue in scene.issues if issue.code == "unread"]
    assert "5 of the 6 faces" in said.message
    assert "not-closed" in codes(scene)


def two_boxes() -> StepFile:
    file = StepFile()
    whole = file.product("rig", [], kind="")
    box = file.product("box", [file.box((0, 0, 0), (1, 1, 1))])
    for name, x in (("a", 0), ("b", 5), ("c", 10)):
        file.occurrence(name, whole, box, (x, 0, 0))
    return file


UNREAD = {
    "an item of a shape": (r"(#\d+=ADVANCED_BREP\w*\('',\()", r"#999=BLOB('');\n\1#999,", "BLOB"),
    "a face": (r"ADVANCED_FACE", "CLEVER_FACE", "CLEVER_FACE"),
    "a placement": (r"(ITEM_DEFINED_TRANSFORMATION\('',''),#\d+,", r"\1,#1,", "an occurrence"),
    "no placement": (r"#\d+=CONTEXT_DEPENDENT\w*\(.*\n", "", "without a placement"),
    "a quantity": ("NEXT_ASSEMBLY_USAGE_OCCURRENCE", "PROMISSORY_USAGE_OCCURRENCE", "PROMISSORY"),
}


@pytest.mark.parametrize("name", UNREAD)
def test_what_opencascade_loses_blocks_a_pass(name: str) -> None:
    old, new, words = UNREAD[name]
    assert read_exchange(two_boxes().text().encode()).unread == ()
    text, count = re.subn(old, new, two_boxes().text(), count=1)
    assert count == 1
    assert words in " ".join(read_exchange(text.encode()).unread)


def test_an_occurrence_without_a_value_for_its_place_is_refused(tmp_path: Path) -> None:
    text = re.sub(r"(ITEM_DEFINED_TRANSFORMATION\(.*),#\d+\)", r"\1,$)", two_boxes().text())
    assert refusal(tmp_path, "a.step", text.encode())[0] == "bad-record"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("(LENGTH_UNIT()NAMED_UNIT", "(NAMED_UNIT"),
        ("GLOBAL_UNIT_ASSIGNED_CONTEXT((#6,", "GLOBAL_UNIT_ASSIGNED_CONTEXT(("),
    ],
)
def test_a_file_without_a_unit_is_in_millimetres_and_says_so(
    tmp_path: Path, old: str, new: str
) -> None:
    assert old in GOOD
    scene = load(tmp_path, GOOD.replace(old, new))
    assert scene.bodies[0].world_mesh().bounds == ((0, 0, 0), (1, 1, 1))
    assert "assumed-units" in codes(scene)


def test_numbers_that_are_not_finite_end_no_child(tmp_path: Path) -> None:
    text = GOOD.replace("CARTESIAN_POINT('',(1.0", "CARTESIAN_POINT('',(1.E400")
    scene = load(tmp_path, text)
    assert not scene.bodies
    assert scene.unreadable[0].issue.code in ("non-finite", "empty-mesh", "out-of-range")


def test_the_package_to_install_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cascadio", None)
    with pytest.raises(Refused, match="pip install 'satcheck\\[step\\]'") as caught:
        read_step(File("step", "", "a.step", GOOD.encode()))
    assert caught.value.code == "missing-extra"


def test_every_run_makes_the_same_facets(tmp_path: Path) -> None:
    first, second = (load(tmp_path, rig()).bodies[2].file.mesh for _ in range(2))
    assert first.to_bytes() == second.to_bytes()


def test_the_sample_of_the_docs_is_this_rig() -> None:
    assert (Path(__file__).parents[3] / "docs" / "rig.step").read_text("utf-8") == rig()


def test_a_packed_file_is_refused_with_what_to_do(tmp_path: Path) -> None:
    code, message = refusal(tmp_path, "a.stpz", b"\x1f\x8b")
    assert (code, "unpack it" in message) == ("unsupported-format", True)


@pytest.mark.parametrize(
    ("kind", "misspelt"),
    [
        ("ITEM_DEFINED_TRANSFORMATION", "ITEM_DEFINED_TRANSFORMATON"),
        (
            "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION",
            "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMTION",
        ),
        ("AXIS2_PLACEMENT_3D", "AXIS2_PLACEMNT_3D"),
        ("CLOSED_SHELL", "CLOSED_SHEL"),
    ],
)
def test_a_kind_of_record_that_is_misspelt_is_refused(
    tmp_path: Path, kind: str, misspelt: str
) -> None:
    file = StepFile()
    whole = file.product("rig", [], kind="")
    file.occurrence("a", whole, file.product("box", [file.box((0, 0, 0), (1, 1, 1))]), (0, 0, 0))
    assert kind in file.text()
    text = file.text().replace(kind, misspelt)
    code, message = refusal(tmp_path, "a.step", text.encode())
    assert (code, kind in message) == ("misspelt", True)
