"""Body rules whose answer is open, or comes with a warning."""

from __future__ import annotations

import json
import math

import pytest

from satcheck.audit import Settings, check
from satcheck.scene import load_scene
from tests.audit.statics.scenes import (
    about_y,
    answers,
    ball,
    box,
    floor,
    report_of,
    support,
    tower,
)
from tests.cli.process import SAMPLES


def test_what_needs_the_tolerance_is_supported_and_open(tmp_path):
    """A cube that is turned a little over its left edge: the right one is within the tolerance."""
    lean = 0.0005
    turn = about_y(-math.degrees(lean))
    centre = [math.cos(lean) / 2 - math.sin(lean) / 2, 0.0, math.cos(lean) / 2 + math.sin(lean) / 2]
    statics = support(tmp_path, [floor(), box("cube", [1, 1, 1], centre, quaternion=turn)])
    assert answers(statics, "supported")["cube"] == "yes"
    assert answers(statics, "stable")["cube"] == "open"


def test_an_overlap_beyond_the_tolerance_is_open(tmp_path):
    report = report_of(tmp_path, [floor(), box("cube", [1, 1, 1], [0, 0, 0.49])])
    assert answers(report.support) == {"floor": "yes", "cube": "open"}
    assert "overlap by more" in report.support.islands[0].reason


def test_an_open_question_is_no_pass(tmp_path):
    """A can stands on the floor, and its contacts are not known."""
    can = {"id": "can", "shape": {"type": "cylinder", "radius": 0.1, "height": 1.0}}
    report = report_of(tmp_path, [floor(), {**can, "position": [0, 0, 0.5]}])
    assert answers(report.support)["can"] == "open"
    assert report.summary.verdict == "incomplete"


def test_the_severity_of_a_rule_is_that_of_its_failures(tmp_path):
    rules = [{"bodies": "*", "stable": True}, {"bodies": "top", "severity": "warning"}]
    report = report_of(tmp_path, tower(0.6), rules)
    severities = {f.body: f.severity for f in report.support.findings}
    assert severities == {"floor": "none", "base": "warning", "top": "warning"}
    assert report.summary.verdict == "incomplete"  # the base is open, and nothing fails


@pytest.mark.parametrize("severity", ["warning", "none"])
def test_the_last_line_counts_what_falls(tmp_path, severity):
    from satcheck.audit.messages import held

    rules = [{"bodies": "*", "supported": True, "severity": severity}]
    statics = support(tmp_path, [floor(), box("cube", [1, 1, 1], [0, 0, 2])], rules)
    assert held(statics) == "not supported: 1 body"
    both = [floor(), box("cube", [1, 1, 1], [0, 0, 2]), box("low", [1, 1, 1], [0, 0, 0.5])]
    said = held(support(tmp_path, both, rules))
    assert said == "contact forces exist that hold 1 body, not supported: 1 body"


def test_a_squeezed_body_is_a_warning(tmp_path):
    """Between two walls, forces hold it only if something presses; with a floor they need not."""
    walls = [box(f"wall {x}", [0.2, 2, 2], [x, 0, 1], static=True) for x in (-0.6, 0.6)]
    squeezed = support(tmp_path, [*walls, box("block", [1, 1, 1], [0, 0, 1])])
    (finding,) = (f for f in squeezed.findings if (f.body, f.question) == ("block", "stable"))
    assert (finding.answer, finding.severity) == ("yes", "warning")
    assert squeezed.islands[0].squeezed is True
    standing = support(tmp_path, [*walls, floor(), box("block", [1, 1, 1], [0, 0, 0.5])])
    assert standing.islands[0].squeezed is False
    assert {f.severity for f in standing.findings} == {"none"}


def test_supported_alone_has_the_warnings(tmp_path):
    walls = [box(f"wall {x}", [0.2, 2, 2], [x, 0, 1], static=True) for x in (-0.6, 0.6)]
    rules = [{"bodies": "block", "supported": True}]
    (finding,) = support(tmp_path, [*walls, box("block", [1, 1, 1], [0, 0, 1])], rules).findings
    assert (finding.answer, finding.severity) == ("yes", "warning")
    assert "squeeze only" in finding.reason


@pytest.mark.parametrize(("thick", "answer"), [(0.5e-3, "open"), (3e-3, "no")])
def test_a_tile_under_a_thin_plate_is_not_held(tmp_path, thick, answer):
    """Its far side is within the tolerance of the far side of the plate."""
    plate = box("plate", [1, 1, thick], [0, 0, 1 + thick / 2], static=True)
    tile = box("tile", [0.1, 0.1, 0.3e-3], [0, 0, 1 - 0.15e-3])
    statics = support(tmp_path, [plate, tile])
    assert answers(statics)["tile"] == answer
    if answer == "open":
        assert "thinner than the tolerance" in statics.islands[0].reason


def test_a_tile_under_a_thin_tray_is_open(tmp_path):
    """Walls make the tray thick as a whole, and its bottom stays thin."""
    bottom = [0.5, 0.5, 1.0, 1.0005, 1.1, 0.4995]  # half sizes, heights, the hole
    outer, _, low, floor_, high, inner = bottom
    rings = [(outer, low), (outer, high), (inner, high), (inner, floor_)]
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    lines = [f"v {x * half} {y * half} {z}" for half, z in rings for x, y in corners]
    for ring in range(3):
        for k in range(4):
            a, b = 4 * ring + k + 1, 4 * ring + (k + 1) % 4 + 1
            lines += [f"f {a} {b} {b + 4}", f"f {a} {b + 4} {a + 4}"]
    lines += ["f 1 3 2", "f 1 4 3", "f 13 14 15", "f 13 15 16"]
    (tmp_path / "tray.obj").write_text("\n".join(lines))
    tile = box("tile", [0.1, 0.1, 0.3e-3], [0, 0, 1 - 0.15e-3])
    statics = support(tmp_path, [{"id": "tray", "mesh": "tray.obj", "static": True}, tile])
    assert answers(statics)["tile"] == "open"


def test_beside_walls_a_squeeze_that_is_not_looked_for_is_open(tmp_path, monkeypatch):
    from satcheck.audit.statics import margins

    monkeypatch.setattr(margins, "MOST_OF_STEP", 1)
    walls = [box(f"wall {x}", [0.2, 2, 2], [x, 0, 1], static=True) for x in (-0.6, 0.6)]
    statics = support(tmp_path, [*walls, box("block", [1, 1, 1], [0, 0, 1])])
    assert answers(statics)["block"] == "open"
    assert answers(support(tmp_path, tower(0.1)))["top"] == "yes"


def test_a_balance_is_a_warning(tmp_path):
    """One ball on top of another one, which stands: any tilt moves it."""
    balls = [ball("low", 0.2, [0, 0, 0.2], static=True), ball("top", 0.2, [0, 0, 0.6])]
    statics = support(tmp_path, balls)
    (finding,) = (f for f in statics.findings if (f.body, f.question) == ("top", "stable"))
    assert (finding.answer, finding.severity) == ("yes", "warning")
    assert "balanced" in finding.reason


def test_bodies_that_fail_or_are_open_are_issues(tmp_path):
    report = report_of(tmp_path, tower(0.6))
    issues = {issue.body: issue.code for issue in report.issues}
    assert issues == {"top": "unsupported", "base": "support-open"}


@pytest.mark.parametrize(("tolerance", "warned"), [(0.2, ["cube"]), (0.1, [])])
def test_a_body_smaller_than_the_tolerance_is_a_warning(tmp_path, tolerance, warned):
    """The diagonal of the cube is 0.17."""
    cube = box("cube", [0.1, 0.1, 0.1], [0, 0, 0.05])
    report = report_of(tmp_path, [floor(), cube], tolerance=tolerance)
    assert [i.body for i in report.issues if i.code == "tolerance-large"] == warned


def test_beside_a_body_that_cannot_be_read_nothing_is_said_to_fall(tmp_path):
    """It may hold what seems to fall or to float; what stands stands."""
    lost = {"id": "lost", "mesh": "lost.obj", "static": True}
    (tmp_path / "lost.obj").write_text("no mesh")
    shelf = box("shelf", [1, 1, 1], [3, 0, 3])
    statics = support(tmp_path, [*tower(0.6), shelf, box("brick", [1, 1, 1], [-2, 0, 0.5]), lost])
    found = answers(statics, "supported")
    assert found == {
        **{"floor": "yes", "base": "open", "top": "open"},
        **{"shelf": "open", "brick": "yes", "lost": "open"},
    }


def test_a_solver_that_fails_leaves_its_island_open(tmp_path, monkeypatch):
    from satcheck.audit.statics import islands

    def fail(*_: object) -> None:
        raise ArithmeticError("no pivot")

    monkeypatch.setattr(islands, "find_forces", fail)
    report = report_of(tmp_path, tower(0.3))
    assert answers(report.support) == {"floor": "yes", "base": "open", "top": "open"}
    assert "no pivot" in report.support.islands[0].reason
    assert report.summary.verdict == "incomplete"


def test_an_open_mesh_is_a_floor_and_has_no_mass(tmp_path):
    """A sheet without thickness holds a cube; as a free body its mass is not known."""
    sheet = "v -3 -3 0\nv 3 -3 0\nv 3 3 0\nv -3 3 0\nf 1 2 3\nf 1 3 4\n"
    (tmp_path / "sheet.obj").write_text(sheet)
    cube = box("cube", [1, 1, 1], [0, 0, 0.5])
    rules = [{"bodies": "cube", "supported": True}]
    fixed = support(tmp_path, [{"id": "sheet", "mesh": "sheet.obj", "static": True}, cube], rules)
    assert answers(fixed, "supported") == {"cube": "yes"}
    free = support(tmp_path, [{"id": "sheet", "mesh": "sheet.obj"}, floor(), cube], rules)
    assert answers(free, "supported") == {"cube": "open"}


def test_facets_finer_than_the_tolerance_leave_it_open(tmp_path, monkeypatch):
    """Not the memory of the machine: pairs of near features are counted."""
    monkeypatch.setattr("satcheck.audit.statics.contacts.MOST_NEAR", 8)
    found = support(tmp_path, tower(0.3))
    assert set(answers(found).values()) == {"yes", "open"}
    assert any("too many facets" in str(f.reason) for f in found.findings)


@pytest.mark.parametrize(("gravity", "warned"), [(None, True), ([0, -1, 0], False)])
def test_gravity_is_not_silently_assumed_for_files_that_are_y_up(tmp_path, gravity, warned):
    bodies = [floor(), {"id": "ring", "mesh": str(SAMPLES / "ring.glb")}]
    scene_path = tmp_path / "scene.json"
    statics = {} if gravity is None else {"statics": {"gravity": gravity}}
    scene_path.write_text(
        json.dumps(
            {
                "schema": "satcheck.scene/1",
                "units": "m",
                "rules": [{"bodies": "*", "supported": True}],
                "bodies": bodies,
                **statics,
            }
        )
    )
    report = check(load_scene([scene_path], allow_outside=True), Settings())
    assert ("gravity-assumed" in {issue.code for issue in report.issues}) is warned


@pytest.mark.parametrize(("width", "severity"), [(1.2, "none"), (1.0, "warning")])
def test_a_plate_exactly_as_wide_as_its_gap_is_doubtful(tmp_path, width, severity):
    """Edge on edge: the least shift lets it fall, and only a squeeze would hold it."""
    posts = [
        box(name, [1, 1, 1], [x, 0, 0.5], static=True)
        for name, x in (("left", -1.0), ("right", 1.0))
    ]
    found = support(tmp_path, [*posts, box("plate", [width, 0.5, 0.1], [0, 0, 1.05])])
    assert answers(found)["plate"] == "yes"
    assert {f.severity for f in found.findings if f.body == "plate"} == {severity}
