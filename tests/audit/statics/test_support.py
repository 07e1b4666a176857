"""The answers to body rules, on scenes whose truth is a closed form."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from tests.audit.statics.scenes import (
    about_y,
    answers,
    ball,
    box,
    floor,
    loaded,
    on_slope,
    report_of,
    support,
    tower,
)
from tests.cli.process import SAMPLES

FRICTION_ANGLE = math.degrees(math.atan(0.5))


def test_forces_add_up_to_the_weight(tmp_path):
    """Of each body: its mass, and no torque about the centre of mass."""
    statics = support(tmp_path, tower(0.4))
    assert set(answers(statics).values()) == {"yes"}
    free = [body for body in statics.bodies if body.fixed is None]
    assert len(free) == 2
    for body in free:
        force, torque = np.array([0.0, 0.0, -body.mass]), np.zeros(3)
        for contact in statics.contacts:
            sign = {contact.a: 1, contact.b: -1}.get(body.id, 0)
            for point in contact.points:
                pushed = sign * np.array(point.force)
                force += pushed
                torque += np.cross(np.array(point.at) - body.centre, pushed)
        # `BALANCED` of the weight, in forces and over the diagonal of a brick.
        assert np.abs(force).max() <= 1e-9 * 0.5
        assert np.abs(torque).max() <= 1e-9 * 0.5 * 1.5


@pytest.mark.parametrize(("overhang", "stands"), [(0.499, True), (0.501, False)])
def test_a_brick_tips_where_its_centre_leaves_the_edge(tmp_path, overhang, stands):
    report = report_of(tmp_path, tower(overhang))
    assert answers(report.support)["top"] == ("yes" if stands else "no")
    assert report.summary.verdict == ("pass" if stands else "fail")
    (top,) = (body for body in report.support.bodies if body.id == "top")
    assert (top.motion is None) is stands
    if top.motion is not None:
        assert top.motion.velocity[2] < 0
        assert top.motion.angular[1] > 0  # over the edge in +x


@pytest.mark.parametrize("off", [-1.0, -0.01, 0.01, 1.0])
def test_a_cube_slides_beyond_its_friction_angle(tmp_path, off):
    expected = "no" if off > 0 else "yes"
    assert answers(support(tmp_path, on_slope(FRICTION_ANGLE + off)))["cube"] == expected


def test_at_its_limit_it_is_not_decided_by_rounding(tmp_path):
    """On a slope whose tangent is the friction, up to rounding."""
    answer = answers(support(tmp_path, on_slope(FRICTION_ANGLE)))["cube"]
    assert answer != "no"


@pytest.mark.parametrize(("gap", "floats"), [(0.9e-3, "no"), (1.1e-3, "yes")])
def test_a_gap_beyond_the_tolerance_floats(tmp_path, gap, floats):
    statics = support(tmp_path, [floor(), box("cube", [1, 1, 1], [0, 0, 0.5 + gap])])
    assert [body.floating for body in statics.bodies] == ["no", floats]
    assert answers(statics, "supported")["cube"] == ("no" if floats == "yes" else "yes")


def test_a_cup_on_a_shelf_in_the_air_floats_with_it(tmp_path):
    shelf = box("shelf", [1, 1, 0.1], [0, 0, 1])
    cup = box("cup", [0.1, 0.1, 0.1], [0, 0, 1.1])
    statics = support(tmp_path, [floor(), shelf, cup])
    assert answers(statics, "supported") == {"floor": "yes", "shelf": "no", "cup": "no"}
    mounted = [
        {"bodies": "*", "supported": True},
        {"bodies": "shelf", "mounted": True, "reason": "on the wall"},
    ]
    statics = support(tmp_path, [floor(), shelf, cup], mounted)
    assert answers(statics, "supported") == {"floor": "yes", "shelf": "yes", "cup": "yes"}
    assert statics.bodies[2].chain == ("cup", "shelf")


def test_beside_a_wall_is_connected_and_not_supported(tmp_path):
    wall = box("wall", [0.2, 2, 2], [-0.1, 0, 1], static=True)
    statics = support(tmp_path, [wall, box("picture", [0.1, 1, 1], [0.05, 0, 1])])
    assert statics.bodies[1].floating == "no"
    assert answers(statics, "supported")["picture"] == "no"
    assert statics.bodies[1].motion.velocity[2] < 0


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
    from satcheck.cli.report.support import held

    rules = [{"bodies": "*", "supported": True, "severity": severity}]
    statics = support(tmp_path, [floor(), box("cube", [1, 1, 1], [0, 0, 2])], rules)
    assert held(statics) == "not supported: 1 body"
    both = [floor(), box("cube", [1, 1, 1], [0, 0, 2]), box("low", [1, 1, 1], [0, 0, 0.5])]
    said = held(support(tmp_path, both, rules))
    assert said == "contact forces exist that hold 1 body, not supported: 1 body"


def test_friction_of_two_bodies_is_the_smaller_one(tmp_path):
    slope = on_slope(FRICTION_ANGLE - 5)
    rules = [{"bodies": "*", "stable": True}, {"bodies": "cube", "friction": 0.3}]
    assert answers(support(tmp_path, slope, rules))["cube"] == "no"
    rules[1] = {"bodies": "cube", "friction": 3.0}
    assert answers(support(tmp_path, slope, rules))["cube"] == "yes"


def test_a_heavier_weight_holds_the_plank(tmp_path):
    """A plank of mass 1 over an edge by 0.1 needs a weight at its other end."""
    table = box("table", [2, 1, 1], [-1, 0, -0.5], static=True)
    plank = box("plank", [2, 0.2, 0.1], [0.1, 0, 0.05])
    weight = box("weight", [0.1, 0.1, 0.1], [-0.4, 0, 0.15])

    def answer(mass: float) -> str:
        rules = [
            {"bodies": "*", "stable": True},
            {"bodies": "plank", "mass": 1.0},
            {"bodies": "weight", "mass": mass},
        ]
        return answers(support(tmp_path, [table, plank, weight], rules))["plank"]

    assert (answer(0.26), answer(0.24)) == ("yes", "no")  # 0.1 * 1 = 0.4 * 0.25


def test_gravity_is_that_of_the_scene(tmp_path):
    """The same cube beside a wall, which is the floor of another gravity."""
    wall = box("wall", [0.2, 6, 6], [-0.1, 0, 0], static=True)
    bodies = [wall, box("cube", [1, 1, 1], [0.5, 0, 0])]
    assert answers(support(tmp_path, bodies))["cube"] == "no"
    assert answers(support(tmp_path, bodies, gravity=[-9.81, 0, 0]))["cube"] == "yes"


def test_a_ball_rolls_off_a_slope_and_rests_in_a_groove(tmp_path):
    """No friction stops the ball on one plate; between two plates it needs none."""
    plate, _ = on_slope(20.0)
    s, c = math.sin(math.radians(20.0)), math.cos(math.radians(20.0))
    rolling = ball("ball", 0.2, [s * 0.2, 0.0, c * 0.2])
    assert answers(support(tmp_path, [plate, rolling], friction=5.0))["ball"] == "no"
    x, y, z = plate["position"]
    other = {**plate, "id": "other", "quaternion": about_y(-20.0), "position": [-x, y, z]}
    resting = ball("ball", 0.2, [0.0, 0.0, 0.2 / c])
    assert answers(support(tmp_path, [plate, other, resting], friction=0.0))["ball"] == "yes"


def test_the_tilt_is_that_of_the_nearest_edge(tmp_path):
    """A brick of height 0.5 whose centre is 0.1 inside of the edge tips at atan(0.1 / 0.25)."""
    statics = support(
        tmp_path,
        [
            box("table", [2, 2, 1], [-1, 0, -0.5], static=True),
            box("brick", [1, 1, 0.5], [-0.1, 0, 0.25]),
        ],
        friction=2.0,
    )
    low, high = statics.islands[0].margin
    assert high == pytest.approx(math.degrees(math.atan(0.4)), abs=1e-4)
    assert high - 1e-4 <= low <= high  # it tips over a line, so the polygon is exact there


@pytest.mark.parametrize("degrees", [10.0, 25.0])
def test_the_least_friction_on_a_slope_is_its_tangent(tmp_path, degrees):
    (island,) = support(tmp_path, on_slope(degrees)).islands
    tangent = math.tan(math.radians(degrees))
    # Of 12 halvings of 0.5, at the upper end.
    assert tangent <= island.least_friction <= tangent + 0.5 / 2**12 + 1e-6


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


def test_a_scene_without_such_rules_does_not_import_it(tmp_path):
    import subprocess
    import sys

    scene = loaded(tmp_path, tower(0.4), [{"bodies": "top", "density": 2.0}])
    assert scene.body_rules
    code = (
        "import sys; from satcheck.audit import check; from satcheck.scene import load_scene;"
        f"report = check(load_scene([{str(tmp_path / 'scene.json')!r}]));"
        "print(report.support, [m for m in sys.modules if 'statics.' in m and 'audit' in m"
        " or m.split('.')[0] in ('scipy', 'clarabel')])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "None []"


def test_without_a_solver_the_error_says_what_to_install(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "clarabel", None)
    with pytest.raises(SatcheckError, match="satcheck\\[statics\\]") as caught:
        report_of(tmp_path, tower(0.4))
    assert caught.value.code == "missing-extra"


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


def test_a_ridge_across_a_face_and_equal_cubes_are_strict(tmp_path):
    """Lines and corners on edges of both bodies, which carry all the same."""
    half = math.sqrt(0.5)
    bodies = [
        floor(),
        box("lower", [1, 1, 1], [0, 0, 0.5]),
        box("upper", [1, 1, 1], [0, 0, 1.5]),
        box("ridge", [1, 4, 1], [3, 0, half], quaternion=about_y(45), static=True),
        box("plank", [2, 0.5, 0.1], [3, 0, 2 * half + 0.05]),
    ]
    found = answers(support(tmp_path, bodies))
    assert {found[name] for name in ("lower", "upper", "plank")} == {"yes"}
