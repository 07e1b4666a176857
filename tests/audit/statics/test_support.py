"""The answers to body rules, on scenes whose truth is a closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from satcheck.core.errors import SatcheckError
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
