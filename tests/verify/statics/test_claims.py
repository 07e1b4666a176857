"""Forged answers about support are rejected; honest ones of many scenes are accepted."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from satcheck.verify import VerificationReport, verify
from satcheck.verify.statics.weights import covers_once
from satcheck.verify.world import World
from tests.audit.statics.scenes import about_y, ball, box, floor, on_slope, report_of, tower

Json = dict[str, Any]
ANGLE = math.degrees(math.atan(0.5))


def document(folder: Path, bodies: list[Json], *rest: Any, **statics: Any) -> Json:
    made: Json = json.loads(json.dumps(report_of(folder, bodies, *rest, **statics).to_dict()))
    return made


def judged(document: Json) -> VerificationReport:
    return verify(document, Path())


def outcomes(document: Json) -> set[str]:
    found = judged(document)
    assert not any("support" in fault for fault in found.faults), found.faults
    return {answer.outcome for answer in found.support}


def of_body(document: Json, id_: str) -> Json:
    (body,) = (body for body in document["statics"]["bodies"] if body["id"] == id_)
    return body


def with_answer(document: Json, id_: str, answer: str) -> Json:
    """The same report with other answers about this body, and what follows from them."""
    severities = {"yes": "none", "no": "error", "open": "warning"}
    for finding in document["statics"]["findings"]:
        if finding["body"] == id_:
            finding.update(answer=answer, severity=severities[answer], reason=None)
    return document


STANDING = {
    "a tower": tower(0.45),
    "a slope": on_slope(ANGLE - 0.5),
    "a ball": [floor(), ball("ball", 0.3, [0, 0, 0.3])],
    "a pyramid of balls": [
        floor(),
        *(box(f"stop {x}", [0.1, 1, 0.2], [x, 0, 0.1], static=True) for x in (-0.45, 0.45)),
        ball("left", 0.2, [-0.2, 0, 0.2]),
        ball("right", 0.2, [0.2, 0, 0.2]),
    ],
    "a turned box": [
        floor(),
        box("cube", [0.3, 0.3, 0.3], [0, 0, 0.15], quaternion=[math.cos(0.3), 0, 0, math.sin(0.3)]),
    ],
}
FALLING = {
    "a tower": tower(0.55),
    "a slope": on_slope(ANGLE + 0.5),
    "beside a wall": [
        box("wall", [0.2, 2, 2], [-0.1, 0, 1], static=True),
        box("picture", [0.1, 1, 1], [0.05, 0, 1]),
    ],
    "a ball on a slope": [
        box(
            "plate",
            [3, 3, 0.2],
            [-0.1 * math.sin(0.2), 0, -0.1 * math.cos(0.2)],
            quaternion=about_y(math.degrees(0.2)),
            static=True,
        ),
        ball("ball", 0.2, [0.2 * math.sin(0.2), 0, 0.2 * math.cos(0.2)]),
    ],
    "in the air": [floor(), box("shelf", [1, 1, 1], [0, 0, 2]), ball("ball", 0.1, [0, 0, 2.6])],
}


@pytest.mark.parametrize("name", STANDING)
def test_what_stands_is_accepted(tmp_path, name):
    made = document(tmp_path, STANDING[name])
    assert made["summary"]["verdict"] == "pass"
    assert outcomes(made) == {"accepted"}


@pytest.mark.parametrize("name", FALLING)
def test_what_falls_is_accepted(tmp_path, name):
    made = document(tmp_path, FALLING[name])
    assert made["summary"]["verdict"] == "fail"
    assert outcomes(made) <= {"accepted", "open"}
    assert "accepted" in outcomes(made)


def pulled(statics: Json) -> None:
    for contact in statics["contacts"]:
        for point in contact["points"]:
            point["force"] = [-c for c in point["force"]]


def heavier(statics: Json) -> None:
    statics["contacts"][0]["points"][0]["force"][2] *= 1.001


def sideways(statics: Json) -> None:
    """Forces that add up, but lie outside of their cones."""
    for point, sign in zip(statics["contacts"][0]["points"], (1, -1, 1, -1), strict=False):
        point["force"][0] += sign * 10.0


def moved(statics: Json) -> None:
    """Forces under the middle, where no contact is: a patch is stated by its corners."""
    for contact in statics["contacts"]:
        for point in contact["points"]:
            point["at"][0] *= 0.5


def nothing(statics: Json) -> None:
    for contact in statics["contacts"]:
        contact["points"] = []


@pytest.mark.parametrize("forge", [pulled, heavier, sideways, moved, nothing])
def test_forged_forces_are_rejected(tmp_path: Path, forge: Callable[[Json], None]) -> None:
    made = document(tmp_path, tower(0.3))
    forge(made["statics"])
    found = judged(made)
    assert not found.accepted
    assert found.rejected


def test_forces_of_another_scene_do_not_hold_this_one(tmp_path):
    """A tower that stands, with the bodies of one that tips."""
    made, tipping = document(tmp_path, tower(0.45)), document(tmp_path, tower(0.55))
    made["bodies"] = tipping["bodies"]
    found = judged(made)
    assert found.rejected
    forged = copy.deepcopy(tipping)
    for key in ("contacts", "islands"):
        forged["statics"][key] = made["statics"][key]
    forged["statics"]["bodies"] = tipping["statics"]["bodies"]
    for id_ in ("base", "top"):
        with_answer(forged, id_, "yes")
    forged["summary"]["verdict"] = "pass"
    assert judged(forged).rejected


def test_a_force_that_needs_the_tolerance_is_not_stable(tmp_path):
    """`supported` claims less than `stable`: the same forces prove only one of them."""
    lean = 0.0005
    turn = about_y(-math.degrees(lean))
    centre = [math.cos(lean) / 2 - math.sin(lean) / 2, 0.0, math.cos(lean) / 2 + math.sin(lean) / 2]
    made = document(tmp_path, [floor(), box("cube", [1, 1, 1], centre, quaternion=turn)])
    assert outcomes(made) == {"accepted", "open"}
    with_answer(made, "cube", "yes")
    made["summary"]["verdict"] = "pass"
    found = {answer.question: answer for answer in judged(made).support if answer.body == "cube"}
    assert found["supported"].outcome == "accepted"
    assert found["stable"].outcome == "rejected"
    assert "tolerance" in str(found["stable"].reason)


@pytest.mark.parametrize("sign", [-1.0, 0.0])
def test_a_motion_up_or_at_rest_proves_no_fall(tmp_path, sign):
    made = document(tmp_path, tower(0.55))
    motion = of_body(made, "top")["motion"]
    for key in ("velocity", "angular"):
        motion[key] = [sign * c for c in motion[key]]
    assert "rejected" in outcomes(made)


def test_a_motion_through_the_floor_proves_no_fall(tmp_path):
    made = with_answer(document(tmp_path, tower(0.3)), "base", "no")
    of_body(made, "base")["motion"] = {"velocity": [0, 0, -1], "angular": [0, 0, 0]}
    made["summary"]["verdict"] = "fail"
    (why,) = {a.reason for a in judged(made).support if a.outcome == "rejected"}
    assert why == "a contact resists the motion"


def test_what_stands_on_the_floor_does_not_float(tmp_path):
    made = with_answer(document(tmp_path, tower(0.3)), "base", "no")
    of_body(made, "base")["floating"] = "yes"
    made["summary"]["verdict"] = "fail"
    assert "rejected" in outcomes(made)


def test_a_question_may_not_be_left_out(tmp_path):
    made = document(tmp_path, tower(0.55))
    made["statics"]["findings"] = made["statics"]["findings"][:-2]
    assert any("questions" in fault for fault in judged(made).faults)


def test_a_static_body_may_not_be_made_up(tmp_path):
    made = document(tmp_path, tower(0.55))
    of_body(made, "top").update(fixed="static", island=None, motion=None)
    with_answer(made, "top", "yes")
    assert any("fixed" in fault for fault in judged(made).faults)


@pytest.mark.parametrize("rise", [0.0, 1e-9])
def test_a_body_that_stands_does_not_fall_with_another_one(tmp_path, rise):
    """The fall of a body far away does the work of the island."""
    apart = [
        floor(),
        box("stands", [0.5, 0.5, 0.5], [0, 0, 0.25]),
        box("wall", [0.2, 2, 3], [2, 0, 1.5], static=True),
        box("falls", [0.3, 0.3, 0.3], [1.75, 0, 2]),
    ]
    made = with_answer(document(tmp_path, apart), "stands", "no")
    motion = {"velocity": [0, 0, rise], "angular": [0, 0, 0]}
    of_body(made, "stands").update(motion=motion, island=0)
    of_body(made, "falls")["island"] = 0
    island = made["statics"]["islands"][0]
    made["statics"]["islands"] = [island | {"bodies": ["stands", "falls"]}]
    by_body = {a.body: a.outcome for a in judged(made).support}
    assert by_body == by_body | {"stands": "rejected", "falls": "accepted"}


TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
INWARD = FACES[:, ::-1]


@pytest.mark.parametrize(
    ("scale", "shift", "faces", "known"),
    [
        (1.0, 1.5, FACES, True),
        (1.0, 0.25, FACES, False),
        (0.5, 0.125, INWARD, True),
        (0.5, 0.125, FACES, False),
        (1.0, 1.5, INWARD, False),
        (1.0, 0.5, INWARD, False),
    ],
    ids=["apart", "crossing", "a void", "nested twice", "a void beside it", "outside"],
)
def test_parts_that_share_space_are_not_weighed(scale, shift, faces, known):
    corners = np.vstack([TETRAHEDRON, TETRAHEDRON * scale + shift])
    world = World(corners, np.vstack([FACES, faces + 4]), solid=True)
    assert covers_once(SimpleNamespace(world=world)) is known


def test_bodies_that_only_fall_together_are_accepted(tmp_path):
    """The light end of a seesaw rises because the heavy one falls: no forces hold both."""
    made = document(
        tmp_path,
        [
            box("edge", [0.01, 1, 0.5], [0, 0, 0.25], static=True),
            box("plank", [4, 1, 0.1], [0, 0, 0.55]),
            box("light", [0.4, 0.4, 0.2], [-1.8, 0, 0.7]),
            box("heavy", [0.4, 0.4, 0.8], [1.8, 0, 1.0]),
        ],
    )
    by_body = {a.body: (a.answer, a.outcome) for a in judged(made).support}
    assert by_body["light"] == by_body["heavy"] == ("no", "accepted")


def test_a_motion_too_fast_for_floats_is_rejected(tmp_path):
    made = document(tmp_path, tower(0.55))
    of_body(made, "top")["motion"]["velocity"] = [1e308, 1e308, -1e308]
    reasons = {a.reason for a in judged(made).support if a.outcome == "rejected"}
    assert any("fast" in str(reason) for reason in reasons)


def test_a_body_sunk_into_its_support_is_not_shown_to_fall(tmp_path):
    """Deeper than the tolerance: it has no contact that resists, and no gap either."""
    made = document(tmp_path, [floor(), box("sunk", [1, 1, 1], [0, 0, 0.45])])
    assert outcomes(made) == {"open", "accepted"}
    with_answer(made, "sunk", "no")
    of_body(made, "sunk")["motion"] = {"velocity": [0, 0, -1], "angular": [0, 0, 0]}
    made["summary"]["verdict"] = "fail"
    reasons = {a.reason for a in judged(made).support if a.body == "sunk"}
    assert reasons == {"how deep floor and sunk overlap is not certified"}


@pytest.mark.parametrize("sink", [0.4, 1.6])
def test_a_ball_sunk_into_the_floor_is_not_shown_to_fall(tmp_path, sink):
    deep = floor(shape={"type": "box", "size": [6, 6, 4]}, position=[0, 0, -2])
    made = document(tmp_path, [deep, ball("sunk", 0.5, [0, 0, 0.5 - sink])])
    with_answer(made, "sunk", "no")
    of_body(made, "sunk")["motion"] = {"velocity": [0, 0, -1], "angular": [0, 0, 0]}
    made["summary"]["verdict"] = "fail"
    assert {a.outcome for a in judged(made).support if a.body == "sunk"} == {"not certified"}


def test_forces_on_a_body_sunk_into_another_one_do_not_hold_it(tmp_path):
    """The legs of the box stand; a block that nobody asks about is sunk into its middle."""
    scene = [
        floor(),
        box("cube", [1, 1, 1], [0, 0, 0.5]),
        box("through", [0.2, 0.2, 4], [0, 0, 0.5], static=True),
    ]
    made = document(tmp_path, scene)
    assert outcomes(made) == {"open", "accepted"}
    alone = document(tmp_path, scene[:2])
    for key in ("contacts", "islands"):
        made["statics"][key] = alone["statics"][key]
    of_body(made, "cube").update(island=0)
    with_answer(made, "cube", "yes")
    made["summary"]["verdict"] = "pass"
    assert {a.outcome for a in judged(made).support if a.body == "cube"} == {"not certified"}


def test_the_section_may_not_be_left_out_beside_its_issues(tmp_path):
    made = document(tmp_path, tower(0.55))
    del made["statics"]
    assert any("section is missing" in fault for fault in judged(made).faults)


def test_a_doubt_may_not_be_hidden(tmp_path):
    made = document(tmp_path, [floor(), ball("ball", 0.3, [0, 0, 0.3])])
    doubted = [f for f in made["statics"]["findings"] if f["body"] == "ball"]
    assert {f["severity"] for f in doubted} == {"warning"}
    for finding in doubted:
        finding.update(severity="none", reason=None)
    reasons = {a.reason for a in judged(made).support if a.outcome == "rejected"}
    assert reasons == {"a body that may fall although forces hold it has a warning"}


@pytest.mark.parametrize(
    "shape",
    [
        {"type": "cylinder", "radius": 0.2, "height": 0.5},
        {"type": "cone", "radius": 0.2, "height": 0.4},
        {"type": "capsule", "radius": 0.1, "length": 0.3},
        {"type": "ellipsoid", "radii": [0.1, 0.2, 0.3]},
    ],
)
def test_a_free_curved_body_leaves_the_others_accepted(tmp_path, shape):
    """Its contacts are not known; its weight is."""
    height = shape.get("height", 0.5) / 2
    round_ = {"id": "round", "shape": shape, "position": [2, 0, height]}
    made = document(tmp_path, [*tower(0.3), round_])
    by_body = {a.body: a.outcome for a in judged(made).support}
    assert not judged(made).faults
    assert by_body == {"floor": "accepted", "base": "accepted", "top": "accepted", "round": "open"}
    of_body(made, "round")["mass"] *= 1.01
    assert any("its mass" in fault for fault in judged(made).faults)


def test_a_curved_body_in_the_air_is_not_certified(tmp_path):
    """Its box meets that of a lamp, and no gap of such shapes is certified."""
    shape = {"type": "cylinder", "radius": 0.5, "height": 0.5}
    lamp = ball("lamp", 0.3, [0.7, 0.7, 2], static=True)
    made = document(tmp_path, [lamp, {"id": "round", "shape": shape, "position": [0, 0, 2]}])
    assert {f["answer"] for f in made["statics"]["findings"] if f["body"] == "round"} == {"no"}
    assert {a.outcome for a in judged(made).support if a.body == "round"} == {"not certified"}
