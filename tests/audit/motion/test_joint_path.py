"""Robots on a path of joints: the first impact, and that no moment of the path is skipped."""

from __future__ import annotations

import math
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.audit.samples import check_poses
from satcheck.core.errors import SatcheckError
from satcheck.report.report import OVERLAPS, Finding, Report
from satcheck.scene import Scene, load_scene
from satcheck.scene.robot import Pose, RandomPoses, with_joint_path
from tests.scene.robot.robots import SAMPLES, joint, link, robot_of

QUICK = Settings(depth=False)
ABOUT_Z = '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>'


def solid(geometry: str, xyz: str = "0 0 0") -> str:
    return f'<collision><origin xyz="{xyz}"/><geometry>{geometry}</geometry></collision>'


def box(size: str, xyz: str = "0 0 0") -> str:
    return solid(f'<box size="{size}"/>', xyz)


def arm(folder: Path, *others: str, forearm: str = box("1 0.08 0.08", "0.5 0 0")) -> Scene:
    """Two links of length 1 in the xy plane, and what stands around them."""
    text = robot_of(
        link("root", ""),
        link("upper", ""),
        link("fore", forearm),
        joint("shoulder", "root", "upper", "revolute", ABOUT_Z),
        joint("elbow", "upper", "fore", "revolute", f'<origin xyz="1 0 0"/>{ABOUT_Z}'),
        *others,
    )
    (folder / "arm.urdf").write_text(text)
    return load_scene([folder / "arm.urdf"])


def fixed(name: str, xyz: str, inside: str) -> str:
    at = f'<origin xyz="{xyz}"/>'
    return link(name, inside) + joint(f"to_{name}", "root", name, "fixed", at)


def poses(*values: tuple[float, float]) -> list[Pose]:
    return [{"shoulder": (p,), "elbow": (q,)} for p, q in values]


def swept(scene: Scene, path: list[Pose], settings: Settings = QUICK) -> Report:
    return check(with_joint_path(scene, path), settings)


def between(report: Report, a: str, b: str) -> Finding:
    return next(f for f in report.findings if {f.a, f.b} == {a, b})


def test_a_straight_arm_hits_a_post_at_a_known_angle(tmp_path: Path) -> None:
    """The corner of the post that is nearest to the line of the arm meets its side."""
    scene = arm(tmp_path, fixed("post", "1.2 1.2 0", box("0.1 0.1 1")))
    x, y, half = 1.25, 1.15, 0.04
    angle = math.atan2(y, x) - math.asin(half / math.hypot(x, y))
    motion = between(swept(scene, poses((0, 0), (1.5, 0))), "fore", "post").motion
    assert motion is not None
    assert motion.time_of_impact is not None
    low, high = motion.time_of_impact
    # An overlap within the touch band is none yet; the arm is more than 1 long there.
    assert low * 1.5 - motion.tolerance <= angle <= high * 1.5 + 1e-12
    # No point of the arm is faster than 1.5 times its length.
    assert (high - low) * 1.5 * 2.1 <= 4 * motion.tolerance
    assert motion.joints == {"shoulder": pytest.approx(angle), "elbow": 0.0}
    assert motion.poses == (1, 2)
    assert motion.point == pytest.approx((x, y, motion.point[2]), abs=1e-9)
    assert abs(motion.point[2]) <= half + 1e-12


def test_a_sheet_between_two_free_poses(tmp_path: Path) -> None:
    """It is a micrometre thick, and no listed pose is near it."""
    scene = arm(tmp_path, fixed("sheet", "0 1.5 0", box("1e-6 1 1")))
    path = poses((0.1, 0.0), (3.0, 0.0))
    assert all(s.verdict == "pass" for s in check_poses(scene, path, QUICK).samples)
    finding = between(swept(scene, path), "fore", "sheet")
    assert finding.relation == "penetrating"
    assert finding.placed_relation == "separated"


def test_a_pair_that_stays_apart_is_free(tmp_path: Path) -> None:
    scene = arm(tmp_path, fixed("post", "0 2.2 0", box("0.1 0.1 1")))
    report = swept(scene, poses((0, 0), (3, 0), (1.5, 1), (0, 2)))
    assert report.summary.verdict == "pass"
    finding = between(report, "fore", "post")
    assert finding.motion is None or finding.motion.relation == "separated"


@pytest.mark.parametrize(("clearance", "verdict"), [(0.09, "pass"), (0.12, "fail")])
def test_the_nearest_pose_decides_a_clearance(
    tmp_path: Path, clearance: float, verdict: str
) -> None:
    """The tip of the straight arm passes the post at a distance of 0.1, less its rounding out."""
    scene = arm(tmp_path, fixed("post", "0 2.15 0", box("0.001 0.1 1")))
    gap = 2.1 - math.hypot(2.0, 0.04)
    report = swept(scene, poses((1.0, 0), (2.0, 0)), Settings(depth=False, clearance=clearance))
    assert report.summary.verdict == verdict
    motion = between(report, "fore", "post").motion
    assert motion is not None
    if verdict == "fail":
        assert motion.worst is not None
        assert motion.worst.distance is not None
        low, high = motion.worst.distance
        assert low <= gap * (1 + 1e-9)
        assert gap * (1 - 1e-9) <= high <= gap * 1.02
    else:
        assert motion.distance_at_least is not None
        assert clearance <= motion.distance_at_least <= gap


def test_joints_above_both_bodies_do_not_count(tmp_path: Path) -> None:
    """Whatever the shoulder does, the forearm stays a micrometre from a plate on the upper arm."""
    plate = box("0.5 1 0.1", "1.5 0 0.090001")
    text = robot_of(
        link("root", ""),
        link("upper", plate),
        link("fore", box("1 0.08 0.08", "0.5 0 0")),
        joint("shoulder", "root", "upper", "revolute", ABOUT_Z),
        joint("elbow", "upper", "fore", "revolute", f'<origin xyz="1 0 0"/>{ABOUT_Z}'),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    report = swept(scene, poses((-3, 0), (3, 0)))
    assert between(report, "upper", "fore").motion is None
    assert report.summary.verdict == "pass"


def test_a_planar_joint_turns_about_where_it_has_slid(tmp_path: Path) -> None:
    """A block at the origin of the joint passes a post on a circle about a far centre."""
    text = robot_of(
        link("post", box("0.02 0.02 1", "2 0.95 0")),
        link("hand", box("0.1 0.1 0.1", "-8 0 0")),
        joint("slide", "post", "hand", "planar", '<axis xyz="0 0 1"/>'),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    report = swept(scene, [{"slide": (10.0, 0.0, 0.3)}, {"slide": (10.0, 0.0, -0.3)}])
    assert between(report, "post", "hand").relation == "penetrating"


def test_fingers_that_close_touch(tmp_path: Path) -> None:
    """They slide towards each other until their faces meet, one as a mimic of the other."""
    slide = '<axis xyz="{} 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>'
    text = robot_of(
        link("palm", ""),
        link("left", box("1 1 1", "-1.5 0 0")),
        link("right", box("1 1 1", "1.5 0 0")),
        joint("grip", "palm", "left", "prismatic", slide.format(1)),
        joint("other", "palm", "right", "prismatic", slide.format(-1) + '<mimic joint="grip"/>'),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    touch = between(
        swept(scene, [{"grip": (0.0,)}, {"grip": (1.0,)}, {"grip": (0.5,)}]), "left", "right"
    )
    assert touch.relation == "touching"
    assert touch.motion is not None
    assert touch.motion.contact == pytest.approx(0.5, abs=1e-6)
    deep = between(swept(scene, [{"grip": (0.0,)}, {"grip": (1.25,)}]), "left", "right")
    assert deep.motion is not None
    assert deep.motion.time_of_impact is not None
    low, high = deep.motion.time_of_impact
    assert low * 1.25 - deep.motion.tolerance <= 1.0 <= high * 1.25 + 1e-12


BRACKET = '<mesh filename="l_bracket.obj" scale="0.2 0.2 0.2"/>'
CURVED = (
    '<sphere radius="0.3"/>',
    '<cylinder radius="0.2" length="0.9"/>',
    '<capsule radius="0.2" length="0.5"/>',
)


# A sweep of meshes that hit takes seconds: two of them.
@pytest.mark.parametrize(
    ("around", "seed"), [*product(CURVED, range(3)), (BRACKET, 0), (BRACKET, 2)]
)
def test_dense_samples_contradict_no_sweep(tmp_path: Path, around: str, seed: int) -> None:
    """Where a sample overlaps, the sweep says so, and no later."""
    (tmp_path / "l_bracket.obj").write_bytes((SAMPLES / "l_bracket.obj").read_bytes())
    scene = arm(
        tmp_path,
        fixed("thing", "0.9 1 0.1", solid(around)),
        fixed("other", "-1 0.8 0", solid(around)),
        forearm=solid(around, "0.5 0 0") + box("1 0.05 0.05", "0.5 0 0"),
    )
    robots = [robot.robot for robot in scene.robots]
    placed = with_joint_path(scene, list(RandomPoses(robots, 4, seed)))
    assert placed.joint_path is not None
    report = check(placed, QUICK)
    times = np.linspace(0, 1, 401)
    dense: list[Pose] = [
        {
            name: (value,)
            for name, value in placed.joint_path.pose(t).items()
            if isinstance(value, float)
        }
        for t in times
    ]
    findings = {(f.a, f.b): f for f in report.findings}
    for time, sample in zip(times, check_poses(scene, dense, QUICK).samples, strict=True):
        for overlap in (f for f in sample.findings if f.relation in OVERLAPS):
            finding = findings[overlap.a, overlap.b]
            assert finding.relation == "penetrating"
            if finding.motion is not None and finding.motion.time_of_impact is not None:
                assert finding.motion.time_of_impact[0] <= time + 1e-12
    assert all(f.relation != "indeterminate" for f in report.findings)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_any_scale(tmp_path: Path, scale: float) -> None:
    """A needle on a turning hand passes a wall."""
    size = f"{scale} {scale * 1e-3} {scale * 1e-3}"
    text = robot_of(
        link("root", box(f"{scale * 1e-3} {scale} {scale}", f"0 {scale} 0")),
        link("hand", box(size, f"{scale} 0 0")),
        joint("turn", "root", "hand", "revolute", ABOUT_Z),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    report = swept(scene, [{"turn": (0.0,)}, {"turn": (3.0,)}])
    assert between(report, "root", "hand").relation == "penetrating"


def test_a_disc_that_turns_flush_on_a_plate_touches_it(tmp_path: Path) -> None:
    """Its lowest points move along the plate."""
    text = robot_of(
        link("plate", box("2 2 1", "0 0 -0.5")),
        link("disc", solid('<cylinder radius="0.5" length="1"/>', "0 0 0.5")),
        joint("turn", "plate", "disc", "revolute", ABOUT_Z),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    finding = between(swept(scene, [{"turn": (0.0,)}, {"turn": (2.0,)}]), "plate", "disc")
    assert finding.motion is not None
    assert finding.motion.relation == "touching"
    assert finding.motion.reached == 1.0


def test_a_contact_that_lasts_under_two_joints_is_undecided(tmp_path: Path) -> None:
    """The forearm turns flush on a table: bounds of its acceleration let it press into it."""
    scene = arm(tmp_path, fixed("table", "0 0 -0.54", box("5 5 1")))
    report = swept(scene, poses((0, 0), (1, 1)))
    finding = between(report, "fore", "table")
    assert finding.relation == "indeterminate"
    assert finding.undecided == "motion"
    assert report.summary.verdict == "incomplete"


def test_scenes_without_an_answer_are_refused(tmp_path: Path) -> None:
    scene = arm(tmp_path, fixed("post", "0 2.2 0", box("0.1 0.1 1")))
    with pytest.raises(SatcheckError, match="--accuracy hull"):
        swept(scene, poses((0, 0), (1, 0)), Settings(depth=False, accuracy="hull"))


@pytest.mark.parametrize(
    "forearm",
    [solid('<mesh filename="lost.stl"/>', "0.5 0 0"), box("1e50 1e50 1e50", "0.5 0 0")],
    ids=["missing", "beyond the range"],
)
@pytest.mark.parametrize("others", [0, 1, 2])
def test_a_link_that_cannot_be_used_leaves_the_others_their_answers(
    tmp_path: Path, forearm: str, others: int
) -> None:
    """Its pairs are undecided; a hand on the same forearm still hits the post."""
    post, hand = (
        fixed("post", "1.2 1.2 0", box("0.1 0.1 1")),
        link("hand", box("1 0.08 0.08", "0.5 0 0")),
    )
    carried = joint("wrist", "fore", "hand")
    scene = arm(tmp_path, *(post, hand + carried)[:others], forearm=forearm)
    path = poses((0, 0), (1.5, 0))
    if len(scene.bodies) + len(scene.unreadable) < 2:
        with pytest.raises(SatcheckError, match="two bodies"):
            swept(scene, path)
        return
    report = swept(scene, path)
    assert report.summary.verdict == ("fail" if others == 2 else "incomplete")
    assert between(report, "fore", "post").relation == "indeterminate"
    if others == 2:
        motion = between(report, "hand", "post").motion
        assert motion is not None
        assert motion.relation == "penetrating"


@pytest.mark.parametrize(("share", "relation"), [(0.5, "touching"), (2.0, "penetrating")])
def test_the_touch_band_ends_at_the_tolerance_of_the_sweep(
    tmp_path: Path, share: float, relation: str
) -> None:
    """A block slides into a wall by a share of the least tolerance of a path."""
    slide = '<axis xyz="1 0 0"/><limit lower="0" upper="2" effort="1" velocity="1"/>'
    text = robot_of(
        link("wall", box("1 4 4", "2 0 0")),
        link("block", box("1 1 1")),
        joint("slide", "wall", "block", "prismatic", slide),
    )
    (tmp_path / "r.urdf").write_text(text)
    scene = load_scene([tmp_path / "r.urdf"])
    deep = swept(scene, [{"slide": (0.0,)}, {"slide": (1.5,)}])
    motion = between(deep, "wall", "block").motion
    assert motion is not None
    depth = share * motion.tolerance
    report = swept(scene, [{"slide": (0.0,)}, {"slide": (1.0 + depth,)}, {"slide": (0.0,)}])
    assert between(report, "wall", "block").relation == relation
