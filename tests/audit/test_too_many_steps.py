"""What the core does not decide within its budget is a clear answer of one pair, or of one mesh."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

import pytest

from satcheck import core
from satcheck.audit import checked_pairs
from satcheck.audit.check import check
from satcheck.audit.finding import OPEN_GAP
from satcheck.audit.pair import MOST_STEPS
from satcheck.audit.settings import Settings
from satcheck.audit.stages.relation import NO_STEPS_LEFT, TOO_MANY_STEPS
from satcheck.report.report import INTERNAL_ERROR, Finding
from satcheck.scene import load_scene
from satcheck.scene.errors import Refused
from satcheck.scene.inspect import errors_of


def spent(*_: object) -> NoReturn:
    raise core.TooManySteps("the query takes more steps than it may")


def test_a_pair_beyond_the_budget_is_indeterminate(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checked_pairs, "examine", spent)
    pair = ["sample_meshes/box_flush.stl", "sample_meshes/box_pushed.stl"]
    report = check(load_scene(pair), Settings())
    answers = [(finding.relation, finding.reason) for finding in report.findings]
    assert answers == [("indeterminate", TOO_MANY_STEPS)]
    assert INTERNAL_ERROR not in {issue.code for issue in report.issues}


def test_a_mesh_beyond_the_budget_is_refused() -> None:
    with pytest.raises(Refused) as refused, errors_of("knot.obj"):
        spent()
    assert (refused.value.code, refused.value.file) == ("too-many-steps", "knot.obj")


def box(low: Sequence[float], high: Sequence[float], first: int) -> str:
    """A closed box as text of an OBJ file. first: the number of its first vertex."""
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    faces = (1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)
    points = [[(low[k], high[k])[c[k]] for k in range(3)] for c in corners]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points]
    lines += ["f " + " ".join(str(first - 1 + v) for v in face) for face in faces]
    return "".join(f"{line}\n" for line in lines)


@pytest.fixture
def in_a_slot(tmp_path: Path) -> list[Path]:
    """Two boxes with a slot between them, and a third one in the slot, 0.25 from both."""
    slotted, between = tmp_path / "slotted.obj", tmp_path / "between.obj"
    slotted.write_text(box((0, 0, 0), (1, 4, 4), 1) + box((2, 0, 0), (3, 4, 4), 9))
    between.write_text(box((1.25, 1, 1), (1.75, 2, 2), 1))
    return [slotted, between]


@pytest.mark.parametrize("clearance", [None, 0.25, 1.0])
def test_a_gap_beyond_the_budget_leaves_the_pair_separated(
    clearance: float | None, in_a_slot: list[Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = Settings(clearance=clearance, tolerance=0.01, distance=True)
    decided = finding_within(MOST_STEPS, in_a_slot, settings, monkeypatch)
    assert (decided.relation, decided.distance) == (
        "near" if clearance == 1.0 else "separated",
        0.25,
    )
    steps = [
        finding_within(count, in_a_slot, settings, monkeypatch) for count in range(1, 9000, 100)
    ]
    relations = [each.relation for each in steps]
    assert relations[0] == "indeterminate"
    assert steps[0].reason == NO_STEPS_LEFT
    unmeasured = [each for each in steps if each.reason == OPEN_GAP]
    assert unmeasured
    for each in unmeasured:
        assert (each.relation, each.exact_relation, each.distance) == (
            "separated",
            "separated",
            None,
        )
        assert each.severity == ("none" if clearance is None else "warning")
        assert each.undecided == (None if clearance is None else "limit")
    assert relations[-1] == decided.relation


@pytest.mark.parametrize(
    ("high", "settings", "decided"),
    [
        (1.75, Settings(tolerance=0.3, fail_on="note"), "touching"),
        (2.005, Settings(surface_tolerance=0.02), "touching"),
        (2.5, Settings(surface_tolerance=0.02), "penetrating"),
    ],
)
def test_no_budget_makes_another_verdict(
    high: float,
    settings: Settings,
    decided: str,
    in_a_slot: list[Path],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What the budget leaves open may be a touch that fails, or one that passes."""
    in_a_slot[1].write_text(box((1.25, 1, 1), (high, 2, 2), 1))
    assert finding_within(MOST_STEPS, in_a_slot, settings, monkeypatch).relation == decided
    found = [
        finding_within(count, in_a_slot, settings, monkeypatch) for count in range(1, 9000, 100)
    ]
    assert "relation" in {each.undecided for each in found}
    for each in found:
        assert each.undecided == "relation" or each.relation == decided


def finding_within(
    steps: int, files: list[Path], settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> Finding:
    """Return the finding of two files if the climb may take so many steps."""
    given = type("Given", (), {"left": steps, "add": lambda *_: None})
    monkeypatch.setattr(import_module("satcheck.audit.check"), "StepsOfScene", given)
    [finding] = check(load_scene(files), settings).findings
    return finding


def test_a_scene_without_steps_leaves_the_rest_undecided(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Six balls in one place: the first pair spends what is there, whatever the number of jobs."""
    ball = {"shape": {"type": "sphere", "radius": 1}}
    scene = {"schema": "satcheck.scene/1", "bodies": [{"id": str(k), **ball} for k in range(6)]}
    file = tmp_path / "s.json"
    file.write_text(json.dumps(scene))
    given = type("Given", (), {"left": 100, "add": lambda *_: None})
    monkeypatch.setattr(import_module("satcheck.audit.check"), "StepsOfScene", given)
    monkeypatch.setattr("satcheck.audit.stages.curved.STEPS_OF_BOUNDS", 1_000)
    reports = [check(load_scene([str(file)]), Settings(jobs=jobs, depth=True)) for jobs in (1, 2)]
    relations = [[finding.relation for finding in report.findings] for report in reports]
    assert relations[0] == relations[1]
    assert relations[0].count("indeterminate") == 14
    reasons = {f.reason for f in reports[0].findings if f.relation == "indeterminate"}
    assert reasons == {NO_STEPS_LEFT}


def test_a_hundred_bolts_in_a_plate_are_all_decided(tmp_path: Path) -> None:
    """Their facets lie in those of the holes by a thousandth of their size."""
    manifold3d = pytest.importorskip("manifold3d")

    def round_bar(turned: float, height: float) -> Any:
        angles = [2 * math.pi * (k + turned) / 32 for k in range(32)]
        section = manifold3d.CrossSection(
            [[(0.4 * math.cos(t), 0.4 * math.sin(t)) for t in angles]]
        )
        return manifold3d.Manifold.extrude(section, height)

    def write(name: str, solid: Any) -> None:
        mesh = solid.to_mesh()
        rows = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in mesh.vert_properties[:, :3].tolist()]
        rows += [f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in mesh.tri_verts.tolist()]
        (tmp_path / name).write_text("".join(rows))

    places = [(i + 0.5, j + 0.5) for i in range(10) for j in range(10)]
    hole = round_bar(0.0, 3.0)
    holes = [hole.translate((x, y, -1.0)) for x, y in places]
    cut = manifold3d.Manifold.batch_boolean(holes, manifold3d.OpType.Add)
    write("plate.obj", manifold3d.Manifold.cube((10.0, 10.0, 1.0)) - cut)
    write("bolt.obj", round_bar(0.5, 1.0))
    bolts = [
        {"id": f"bolt{k}", "mesh": "bolt.obj", "position": [x, y, 0.0]}
        for k, (x, y) in enumerate(places)
    ]
    scene = {"schema": "satcheck.scene/1", "bodies": [{"id": "plate", "mesh": "plate.obj"}, *bolts]}
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    report = check(load_scene([tmp_path / "scene.json"]), Settings(tolerance=0.01))
    relations = [finding.relation for finding in report.findings]
    assert relations.count("touching") == 100
    assert "indeterminate" not in relations
