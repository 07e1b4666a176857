"""Second opinions: the real libraries, one that lies, one that dies, one that is not there."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.audit.bodies import place
from satcheck.audit.draft import Draft
from satcheck.audit.pair import Pair
from satcheck.audit.planner import request_for
from satcheck.audit.stages.cross_check import DISAGREEMENT, ask_peers
from satcheck.audit.stages.relation import settle
from satcheck.cli.formats.summary import summary_line
from satcheck.core import Mesh
from satcheck.core.peers import OverlapVolume, Peers
from satcheck.scene import Scene, load_scene
from tests.audit.shapes import write
from tests.core.test_mesh_relation import CELL, CUBE, L_SHAPE, SMALL, moved

APART = moved(CELL, 9, 0, 0).mesh()
CROSSING = L_SHAPE.mesh().translated((0.25, 0.125, 0.5))
BESIDE = CELL.mesh().translated((1.5, 1.5, 0.0))
WITHIN = CELL.mesh().translated((1.5, 1.5, 1.5))


class Liar(Peers):
    """Says the opposite of what is true of crossing bodies."""

    def __init__(self) -> None:
        super().__init__(seconds=60, megabytes=1024)

    def surfaces_meet(self, *_: Mesh) -> bool:
        return False

    def common_volume(self, *_: Mesh) -> OverlapVolume:
        return OverlapVolume(0.0, 1e-12)


def scene_of_meshes(folder: Path, *meshes: Mesh) -> Scene:
    faces = (([tuple(p) for p in m.vertices], [list(t) for t in m.triangles]) for m in meshes)
    return load_scene(write(folder, **dict(zip("ab", faces, strict=True))))


def pair_of(folder: Path, *meshes: Mesh) -> Pair:
    scene = scene_of_meshes(folder, *meshes)
    settings = Settings()
    a, b = place(scene, settings).placed.values()
    return Pair(a, b, settings, request_for(settings))


def standings(pair: Pair, peers: Peers) -> tuple[list[str], Draft]:
    draft = Draft(replace(pair, peers=peers))
    settle(draft)
    first = len(draft.stages)
    ask_peers(draft)
    return [stage.result for stage in draft.stages[first:]], draft


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        (L_SHAPE.mesh(), CROSSING, ["agrees", "agrees"]),
        (L_SHAPE.mesh(), APART, ["agrees", "agrees"]),
        (CUBE.mesh(), WITHIN, ["agrees", "agrees"]),  # apart to the one, a volume to the other
        (SMALL.mesh(), moved(SMALL, 2, 0, 0).mesh(), ["no answer", "agrees"]),  # flush
    ],
    ids=["crossing", "apart", "within", "flush"],
)
def test_the_libraries_agree(tmp_path: Path, a: Mesh, b: Mesh, expected: list[str]) -> None:
    with Peers(seconds=60, megabytes=4096) as peers:
        found, draft = standings(pair_of(tmp_path, a, b), peers)
    assert (found, draft.issues) == (expected, [])


def test_a_lie_is_a_warning_of_its_own(tmp_path: Path) -> None:
    with Liar() as peers:
        found, draft = standings(pair_of(tmp_path, L_SHAPE.mesh(), CROSSING), peers)
    assert found == ["disagrees", "disagrees"]
    assert {(issue.code, issue.severity) for issue in draft.issues} == {(DISAGREEMENT, "warning")}
    assert "python-fcl says surfaces that are apart" in draft.issues[0].message


@pytest.mark.parametrize(
    ("second", "verdict", "severity"),
    [(BESIDE, "incomplete", "warning"), (CROSSING, "fail", "error")],
)
def test_a_lie_never_passes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, second: Mesh, verdict: str, severity: str
) -> None:
    """What another library contradicts is undecided; an overlap stays an overlap."""
    monkeypatch.setattr(Peers, "surfaces_meet", lambda *_: second is BESIDE)
    report = check(scene_of_meshes(tmp_path, L_SHAPE.mesh(), second), Settings(cross_check=True))
    (finding,) = report.findings
    assert (report.summary.verdict, report.summary.disputed) == (verdict, 1)
    assert (finding.severity, finding.undecided) == (severity, "cross-check")
    assert finding.reason is not None
    assert "python-fcl says" in finding.reason
    assert "1 answer agrees, 1 disagrees." in summary_line(report)


def test_an_opinion_that_cannot_be_had_is_no_agreement(tmp_path: Path) -> None:
    scene = scene_of_meshes(tmp_path, SMALL.mesh(), moved(SMALL, 2, 0, 0).mesh())
    line = summary_line(check(scene, Settings(cross_check=True)))
    assert line.endswith("Cross-check: 1 answer agrees, 1 could not be had.")
    far = scene_of_meshes(tmp_path, SMALL.mesh(), moved(SMALL, 9, 0, 0).mesh())
    line = summary_line(check(far, Settings(cross_check=True)))
    assert line.endswith("Cross-check: no pair was asked about.")


def test_a_peer_that_dies_gives_no_answer(tmp_path: Path) -> None:
    with Peers(seconds=60, megabytes=4096, fcl_server="satcheck.no_such_module") as peers:
        found, draft = standings(pair_of(tmp_path, L_SHAPE.mesh(), CROSSING), peers)
    assert (found, draft.issues) == (["no answer", "agrees"], [])


def test_the_report_counts_the_answers() -> None:
    samples = Path(__file__).resolve().parents[3] / "sample_meshes"
    paths = [samples / "box.obj", samples / "box_pushed.stl"]
    report = check(paths, Settings(cross_check=True))
    assert "Cross-check: 2 answers agree." in summary_line(report)
    assert "Cross-check" not in summary_line(check(paths))
