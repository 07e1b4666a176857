"""Bodies inside, partly outside and outside of regions, with answers that are known by hand."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from satcheck.audit import Settings, check
from satcheck.report.regions import InsideFinding
from satcheck.report.report import Report
from satcheck.scene import load_scene
from satcheck.verify import VerificationReport, verify

Json = dict[str, Any]
TOLERANCE = 1e-3
# The outline of an L-shaped room, counterclockwise: 4 m by 4 m without the corner over (2, 2).
L_OUTLINE = [(0, 0), (4, 0), (4, 2), (2, 2), (2, 4), (0, 4)]


def box(id_: str, size: list[float], at: list[float], **more: Any) -> Json:
    return {"id": id_, "shape": {"type": "box", "size": size}, "position": at, **more}


def room(**more: Any) -> Json:
    """From the origin to (4, 3, 2.5)."""
    return box("room", [4, 3, 2.5], [2, 1.5, 1.25], **more)


def prism(outline: list[tuple[float, float]], height: float, ears: list[tuple[int, ...]]) -> str:
    """A closed OBJ. ears: the triangles of the outline."""
    n = len(outline)
    lines = [f"v {x} {y} {z}" for z in (0, height) for x, y in outline]
    faces = [(c, b, a) for a, b, c in ears] + [(a + n, b + n, c + n) for a, b, c in ears]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, j + n), (i, j + n, i + n)]
    return "\n".join([*lines, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces)]) + "\n"


def l_room(folder: Path) -> Json:
    ears = [(0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5)]
    (folder / "l.obj").write_text(prism(L_OUTLINE, 2.5, ears), encoding="utf-8")
    return {"id": "room", "mesh": "l.obj"}


def report_of(folder: Path, bodies: list[Json], rules: list[Json] | None = None) -> Report:
    asked = [{"bodies": "*", "inside": "room"}, {"bodies": "room", "region": True}]
    document = {
        "schema": "satcheck.scene/1",
        "units": "m",
        "statics": {"tolerance": TOLERANCE},
        "rules": asked if rules is None else rules,
        "bodies": bodies,
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    return check(load_scene([path]), Settings(jobs=1))


def finding(report: Report, body: str) -> InsideFinding:
    assert report.regions
    (found,) = (answer for answer in report.regions.findings if answer.body == body)
    return found


def verified(report: Report, **forged: Any) -> VerificationReport:
    document = json.loads(json.dumps(report.to_dict()))
    document["regions"]["findings"][0].update(forged)
    return verify(document, Path())


@pytest.mark.parametrize(
    ("at", "size", "answer"),
    [
        ([1, 1, 0.5], [1, 1, 1], "yes"),
        ([0.5, 0.5, 0.5], [1, 1, 1], "yes"),  # flush with two walls and the floor
        ([0.5 - TOLERANCE / 2, 0.5, 0.5], [1, 1, 1], "yes"),
        ([0.5 - TOLERANCE * 2, 0.5, 0.5], [1, 1, 1], "no"),
        ([2, 1.5, 1.25], [4, 3, 2.5], "yes"),  # fills the room
        ([2, 1.5, 1.25], [9, 9, 9], "no"),
        ([9, 9, 9], [1, 1, 1], "no"),
    ],
)
def test_a_box_in_a_room(tmp_path: Path, at: list[float], size: list[float], answer: str) -> None:
    report = report_of(tmp_path, [box("crate", size, at), room()])
    assert finding(report, "crate").answer == answer
    assert report.summary.verdict == ("pass" if answer == "yes" else "fail")
    assert verified(report).accepted


def test_how_far_a_body_sticks_out(tmp_path: Path) -> None:
    report = report_of(tmp_path, [box("crate", [1, 1, 1], [0.25, 1, 0.5]), room()])
    found = finding(report, "crate")
    assert found.sticks_out == pytest.approx(0.25, rel=1e-8)
    assert found.sticks_out <= 0.25
    assert verified(report).accepted
    assert verified(report, sticks_out=0.3).rejected


def test_a_region_collides_with_nothing(tmp_path: Path) -> None:
    bodies = [box("a", [1, 1, 1], [1, 1, 0.5]), box("b", [1, 1, 1], [1.5, 1, 0.5]), room()]
    report = report_of(tmp_path, bodies)
    assert [(f.a, f.b) for f in report.findings] == [("a", "b")]
    assert report.summary.verdict == "fail"


@pytest.mark.parametrize(
    ("shape", "reach"),
    [
        ({"type": "sphere", "radius": 0.5}, 0.5),
        ({"type": "cylinder", "radius": 0.5, "height": 1}, 0.5),
        ({"type": "capsule", "radius": 0.25, "length": 1}, 0.25),
    ],
)
def test_curved_shapes_are_compared_by_their_exact_reach(
    tmp_path: Path, shape: Json, reach: float
) -> None:
    for at, answer in ((reach, "yes"), (reach - 2 * TOLERANCE, "no")):
        body = {"id": "round", "shape": shape, "position": [at, 1.5, 1]}
        report = report_of(tmp_path, [body, room()])
        assert finding(report, "round").answer == answer
        assert verified(report).accepted


def test_a_turned_room(tmp_path: Path) -> None:
    """By 45 degrees about z, with its centre at the origin: its corner is at (2.5, 0)."""
    turn = [math.cos(math.pi / 8), 0, 0, math.sin(math.pi / 8)]
    side = 2.5 * math.sqrt(2)
    space = box("room", [side, side, 2], [0, 0, 1], quaternion=turn)
    for x, answer in ((1.8, "yes"), (2.0, "no")):
        body = box("crate", [1, 0.2, 1], [x, 0, 0.5])  # its corners are at (x + 0.5, 0.1)
        report = report_of(tmp_path, [body, space])
        assert finding(report, "crate").answer == answer
        assert verified(report).accepted


@pytest.mark.parametrize(
    ("at", "size", "answer"),
    [
        ([1, 1, 1], [1, 1, 1], "yes"),
        ([0.5, 3.5, 0.5], [1, 1, 1], "yes"),  # in the corner, flush with three walls
        ([0.5 - TOLERANCE / 2, 3.5 + TOLERANCE / 2, 0.5], [1, 1, 1], "yes"),
        ([3, 3, 1], [0.5, 0.5, 0.5], "no"),  # where the L has no room
        ([2.25, 2.25, 1], [1, 1, 1], "no"),  # across the corner
        ([2, 2, 1], [3.5, 3.5, 0.5], "no"),
        ([1, 2, 3], [1, 1, 1], "no"),  # through the ceiling
    ],
)
def test_a_box_in_an_l_shaped_room(
    tmp_path: Path, at: list[float], size: list[float], answer: str
) -> None:
    report = report_of(tmp_path, [box("crate", size, at), l_room(tmp_path)])
    assert finding(report, "crate").answer == answer
    assert verified(report).accepted


def test_a_beam_across_the_corner_has_its_ends_inside(tmp_path: Path) -> None:
    """No vertex is outside of the L, but the middle is."""
    turn = [math.cos(-math.pi / 8), 0, 0, math.sin(-math.pi / 8)]
    beam = box("beam", [3, 0.1, 0.1], [2.4, 2.4, 1], quaternion=turn)
    report = report_of(tmp_path, [beam, l_room(tmp_path)])
    assert finding(report, "beam").answer == "no"
    assert verified(report).accepted


def test_forged_answers_are_rejected(tmp_path: Path) -> None:
    for space in (room(), l_room(tmp_path)):
        report = report_of(tmp_path, [box("crate", [1, 1, 1], [-0.5, 1, 0.5]), space])
        assert verified(report).accepted
        forged = verified(report, answer="yes", severity="none", sticks_out=None, shift=[0, 0, 0])
        assert forged.support[0].outcome == "rejected"
        assert verified(report, severity="none").support[0].outcome == "rejected"
        inner = report_of(tmp_path, [box("crate", [1, 1, 1], [1, 1, 0.5]), space])
        point = {"vertices": [0], "weights": ["1"]}
        forged = verified(inner, answer="no", severity="error", point=point)
        assert forged.support[0].outcome == "rejected"


def test_a_question_may_not_be_left_out(tmp_path: Path) -> None:
    report = report_of(tmp_path, [box("crate", [1, 1, 1], [-0.5, 1, 0.5]), room()])
    document = json.loads(json.dumps(report.to_dict()))
    document["regions"]["findings"] = []
    assert any("questions" in fault for fault in verify(document, Path()).faults)


def test_an_open_mesh_is_no_region(tmp_path: Path) -> None:
    (tmp_path / "open.obj").write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n", encoding="utf-8")
    report = report_of(
        tmp_path, [box("crate", [1, 1, 1], [1, 1, 0]), {"id": "room", "mesh": "open.obj"}]
    )
    found = finding(report, "crate")
    assert (found.answer, found.reason) == ("open", "room is not a closed mesh or a box")
    assert report.summary.verdict == "incomplete"
    assert verified(report).accepted


def test_a_region_that_does_not_exist_leaves_the_answer_open(tmp_path: Path) -> None:
    rules = [{"bodies": "*", "inside": "hall"}]
    bodies = [box("a", [1, 1, 1], [1, 1, 0]), box("b", [1, 1, 1], [5, 1, 0])]
    report = report_of(tmp_path, bodies, rules)
    assert report.regions
    assert {f.reason for f in report.regions.findings} == {"no body has the id 'hall'"}
    assert report.summary.verdict == "incomplete"


def test_a_region_holds_no_body(tmp_path: Path) -> None:
    """A crate that floats in its room."""
    rules = [
        {"bodies": "*", "supported": True},
        {"bodies": "room", "region": True},
    ]
    bodies = [box("floor", [9, 9, 1], [2, 1.5, -0.5], static=True), room()]
    crate = box("crate", [1, 1, 1], [1, 1, 1.5])
    report = report_of(tmp_path, [*bodies, crate], rules)
    assert report.support is not None
    assert {f.body: f.answer for f in report.support.findings} == {"floor": "yes", "crate": "no"}
    assert not report.regions


def test_without_such_rules_nothing_of_it_is_in_the_report(tmp_path: Path) -> None:
    report = report_of(tmp_path, [box("crate", [1, 1, 1], [1, 1, 0.5]), room()], [])
    assert "regions" not in report.to_dict()
