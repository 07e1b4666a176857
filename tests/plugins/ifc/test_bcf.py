"""BCF: topics that bcf-client reads back, their states, and a camera that sees the pair."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from bcf.v3.bcfxml import BcfXml
from msgspec.structs import replace

from satcheck.audit import Report, Settings, check
from satcheck.audit.baseline import beside_baseline, known_findings
from satcheck.plugins.ifc.bcf import archive as bcf_archive
from satcheck.plugins.ifc.bcf.archive import render
from satcheck.report.baseline import Baseline
from satcheck.scene import Scene, load_scene
from tests.cli.process import PUSHED, SAMPLES, satcheck
from tests.plugins.ifc.models import MILLIMETRES, Model

WALL, PIPE, SLAB = (f"{name:0<22}" for name in ("1wall", "2pipe", "3slab"))
PROJECT = "0000000000000000000001"  # of every Model


@pytest.fixture(autouse=True)
def _small_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of the command alone have their size."""
    monkeypatch.setattr(bcf_archive, "SIZE", (80, 60))


@pytest.fixture
def house(tmp_path: Path) -> Path:
    path = tmp_path / "house.ifc"
    path.write_bytes(with_pipes(1))
    return path


def with_pipes(count: int) -> bytes:
    """Pipes through a wall that stands on a slab, far from the origin, in millimetres."""
    model = Model(MILLIMETRES)
    at = (500_000, 200_000, 0)
    model.box((4000, 200, 2000), at, kind="IFCWALL", name="'South'", guid=WALL)
    for number in range(count):
        pipe = (500_500 + 1000 * number, 199_000, 900)
        guid = PIPE if not number else f"{PIPE[:-1]}{number}"
        model.box((100, 2000, 100), pipe, kind="IFCPIPESEGMENT", name="'Water'", guid=guid)
    model.box((4000, 4000, 200), (500_000, 200_000, -200), kind="IFCSLAB", guid=SLAB)
    return model.bytes()


def checked(path: Path) -> tuple[Report, Scene]:
    scene = load_scene([path])
    return check(scene, Settings(depth=True)), scene


def read_back(content: bytes, folder: Path) -> Any:
    path = folder / "read_back.bcf"
    path.write_bytes(content)
    return BcfXml.load(path)


def parts(content: bytes, ending: str) -> list[bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return [archive.read(name) for name in archive.namelist() if name.endswith(ending)]


def status(report: Report, scene: Scene) -> list[str]:
    roots = map(ElementTree.fromstring, parts(render(report, scene), "markup.bcf"))
    return [root.find("Topic").get("TopicStatus") for root in roots]  # type: ignore[union-attr,misc]


def test_a_program_reads_the_topic_and_finds_both_elements(house: Path, tmp_path: Path) -> None:
    archive = read_back(render(*checked(house)), tmp_path)
    (handler,) = archive.topics.values()
    topic = handler.topic
    assert topic.title == "IfcWall South / IfcPipeSegment Water"
    assert (topic.topic_type, topic.topic_status, topic.priority) == ("Clash", "Open", "High")
    assert "to pull apart" in topic.description
    (file,) = handler.markup.header.files.file
    assert (file.filename, file.ifc_project) == ("house.ifc", PROJECT)
    (view,) = handler.viewpoints.values()
    components = view.visualization_info.components
    assert {each.ifc_guid for each in components.selection.component} == {WALL, PIPE}
    coloured = components.coloring.color
    assert len({each.color for each in coloured}) == 2
    assert view.snapshot.startswith(b"\x89PNG")


def test_the_camera_sees_the_overlap_in_world_metres(house: Path) -> None:
    report, scene = checked(house)
    (text,) = parts(render(report, scene), ".bcfv")
    camera = ElementTree.fromstring(text).find("OrthogonalCamera")
    assert camera is not None
    eye, ahead, up = (
        np.array([float(axis.text or "") for axis in camera.find(tag) or ()])
        for tag in ("CameraViewPoint", "CameraDirection", "CameraUpVector")
    )
    height = float(camera.findtext("ViewToWorldScale") or "")
    width = height * float(camera.findtext("AspectRatio") or "")
    overlap = np.array([500.55, 200.1, 0.95]) - eye
    assert np.linalg.norm(ahead) == pytest.approx(1.0)
    assert ahead @ up == pytest.approx(0.0, abs=1e-12)
    assert overlap @ ahead > 0.0
    assert abs(overlap @ up) < height / 2
    assert abs(overlap @ np.cross(ahead, up)) < width / 2
    assert height < 100.0
    for body in scene.bodies[:2]:  # no part of the pair lies behind the eye
        assert ((np.asarray(body.world_mesh().vertices) - eye) @ ahead > 0.0).all()


def test_pairs_of_the_same_classes_are_one_topic_with_a_view_of_each(
    house: Path, tmp_path: Path
) -> None:
    house.write_bytes(with_pipes(2))
    archive = read_back(render(*checked(house)), tmp_path)
    (handler,) = archive.topics.values()
    assert handler.topic.title == "IfcPipeSegment / IfcWall: 2 pairs"
    assert handler.topic.description.count("to pull apart") == 2
    seen = [
        {each.ifc_guid for each in view.visualization_info.components.selection.component}
        for view in handler.viewpoints.values()
    ]
    assert sorted(map(len, seen)) == [2, 2]
    assert set.intersection(*seen) == {WALL}


def test_a_topic_keeps_its_guid_while_its_pairs_change(house: Path) -> None:
    guids = set()
    for pipes in (1, 2):
        house.write_bytes(with_pipes(pipes))
        roots = parts(render(*checked(house)), "markup.bcf")
        guids |= {ElementTree.fromstring(root).find("Topic").get("Guid") for root in roots}  # type: ignore[union-attr]
    assert len(guids) == 1


def test_a_topic_shows_the_pairs_that_are_not_accepted(house: Path) -> None:
    house.write_bytes(with_pipes(2))
    report, scene = checked(house)
    first, second = known_findings(report)
    half = beside_baseline(report, Baseline(findings=(first,)), "b.json")
    assert status(half, scene) == ["Open"]
    assert len(parts(render(half, scene), ".bcfv")) == 1
    whole = beside_baseline(report, Baseline(findings=(first, second)), "b.json")
    assert status(whole, scene) == ["Closed"]
    assert len(parts(render(whole, scene), ".bcfv")) == 2


def test_a_second_run_updates_the_same_topic(house: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    first = render(*checked(house))
    assert b"2023-11-14T22:13:20Z" in parts(first, "markup.bcf")[0]
    assert render(*checked(house)) == first
    house.write_text(house.read_text().replace("500500.", "501500."))
    moved = render(*checked(house))
    assert moved != first
    with zipfile.ZipFile(io.BytesIO(first)) as one, zipfile.ZipFile(io.BytesIO(moved)) as other:
        assert one.namelist() == other.namelist()


def test_a_baseline_sets_the_status(house: Path) -> None:
    report, scene = checked(house)
    known = Baseline(findings=tuple(known_findings(report)))
    milder = Baseline(findings=tuple(replace(each, depth=1e-3) for each in known.findings))
    gone = replace(known.findings[0], b=SLAB)
    assert status(report, scene) == ["Open"]
    assert status(beside_baseline(report, known, "b.json"), scene) == ["Closed"]
    assert status(beside_baseline(report, milder, "b.json"), scene) == ["ReOpened"]
    both = Baseline(findings=(gone,))
    assert status(beside_baseline(report, both, "b.json"), scene) == ["Open", "Closed"]


def test_touching_bodies_are_no_topic(house: Path) -> None:
    report, scene = checked(house)
    assert {f.relation for f in report.findings} == {"penetrating", "touching", "separated"}
    assert len(status(report, scene)) == 1


def test_bodies_without_a_guid_are_named(tmp_path: Path) -> None:
    path = tmp_path / "report.bcf"
    ran = satcheck("--units", "in", *PUSHED, "-o", str(path), cwd=SAMPLES)
    assert ran.code == 1
    content = path.read_bytes()
    archive = read_back(content, tmp_path)
    (handler,) = archive.topics.values()
    (view,) = handler.viewpoints.values()
    components = view.visualization_info.components
    coloured = [each.components.component[0] for each in components.coloring.color]
    for named in (components.selection.component, coloured):
        assert [each.authoring_tool_id for each in named] == ["box", "box_pushed"]
    root = ElementTree.fromstring(parts(content, ".bcfv")[0])
    assert float(root.findtext("OrthogonalCamera/ViewToWorldScale") or "") < 0.5  # metres


def test_names_may_hold_what_xml_cannot(tmp_path: Path) -> None:
    for name, sample in zip(("a\x01<", "b\udc80&"), PUSHED, strict=True):
        suffix = Path(sample).suffix
        (tmp_path / f"{name}{suffix}").write_bytes((SAMPLES / sample).read_bytes())
    scene = load_scene(sorted(tmp_path.iterdir()))
    content = render(check(scene, Settings()), scene)
    (title,) = (
        ElementTree.fromstring(each).findtext("Topic/Title")
        for each in parts(content, "markup.bcf")
    )
    assert title == "a\N{REPLACEMENT CHARACTER}< / b\N{REPLACEMENT CHARACTER}&"


def test_without_its_library_a_check_ends_before_it_begins(tmp_path: Path) -> None:
    (tmp_path / "bcf.py").write_text(
        "raise ModuleNotFoundError(\"No module named 'bcf'\", name='bcf')"
    )
    path = tmp_path / "report.bcf"
    ran = satcheck(*PUSHED, "-o", str(path), cwd=SAMPLES, env={"PYTHONPATH": str(tmp_path)})
    assert ran.code == 2
    assert "BCF files need bcf: pip install 'satcheck[ifc]'" in ran.err
    assert not path.exists()


def test_the_ending_of_bcf_2_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "report.bcfzip"
    ran = satcheck(*PUSHED, "-o", str(path), cwd=SAMPLES)
    assert ran.code == 2
    assert "report.bcfzip: this command writes " in ran.err
    assert ".bcf: end the name so" in ran.err
    assert not path.exists()
