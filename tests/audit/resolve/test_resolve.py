"""Scenes with known answers, and what must hold of any answer."""

from __future__ import annotations

import math
import random
from itertools import combinations, product

import pytest

from satcheck.audit import Settings, check
from satcheck.audit.resolve import resolve
from satcheck.audit.resolve.least_motion import least_motion
from satcheck.audit.resolve.reasons import ONLY_MOVING
from satcheck.audit.resolve.wall import Wall
from satcheck.audit.vectors import dot, scaled
from satcheck.core.errors import SatcheckError
from satcheck.core.frozen import replace
from satcheck.scene import Rule, Scene, Selector, load_scene
from satcheck.scene.motion import Motion, Translation
from tests.audit.resolve.boxes import after, boxes_scene, moves, overlapping, unit_at
from tests.audit.shapes import bracket, moved, open_box, scene_of, unit_box, write
from tests.audit.test_samples import SAMPLES


def test_two_free_boxes_share_the_shortest_way(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75, 0.25)})
    found = resolve(scene)
    assert moves(found) == {"a": (-0.125, 0.0, 0.0), "b": (0.125, 0.0, 0.0)}
    assert found.verdict == "resolved"
    assert found.report.summary.by_relation["touching"] == 1
    assert (found.found, found.total_motion, found.largest_motion) == (1, 0.25, 0.125)


@pytest.mark.parametrize("how", ["static", "pin", "group"])
def test_a_box_beside_one_that_stays_moves_all_the_way(tmp_path, how) -> None:
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.75, 0.25)},
        static=("a",) if how == "static" else (),
        groups={"a": "fixed"},
    )
    pins = {"static": (), "pin": ("a*",), "group": ("group:fix*",)}[how]
    found = resolve(scene, pins=pins)
    assert moves(found) == {"b": (0.25, 0.0, 0.0)}
    assert found.pinned == ("a",)


def test_the_links_of_a_robot_stay(tmp_path) -> None:
    """A link goes where its joints put it; what it meets makes way."""
    link = (
        '<link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>'
    )
    (tmp_path / "robot.urdf").write_text(f'<robot name="r">{link}</robot>')
    found = resolve(load_scene([tmp_path / "robot.urdf", *write(tmp_path, box=unit_box())]))
    assert found.pinned == ("base",)
    assert list(moves(found)) == ["box"]
    assert found.verdict == "resolved"


def test_a_box_in_the_corner_of_two_walls_leaves_both(tmp_path) -> None:
    scene = boxes_scene(
        tmp_path,
        {
            "left": ((-1, -9, -9), (0, 9, 9)),
            "floor": ((-9, -9, -1), (9, 9, 0)),
            "box": ((-0.25, 0, -0.125), (0.75, 1, 0.875)),
        },
        static=("left", "floor"),
    )
    found = resolve(scene)
    assert moves(found) == {"box": (0.25, 0.0, 0.125)}
    # The walls cross each other, and both stay.
    assert [(one.a, one.b, one.reason) for one in found.left] == [
        ("left", "floor", "both bodies stay")
    ]
    assert found.verdict == "unresolved"


def test_a_stack_on_the_floor_rises(tmp_path) -> None:
    """The least sum of squares: 1/4 for the lowest box, 1/2 and 3/4 for those on it."""
    scene = boxes_scene(
        tmp_path,
        {
            "floor": ((-9, -9, -1), (9, 9, 0)),
            **{f"box{k}": unit_at(0, 0, 0.75 * k - 0.25) for k in range(3)},
        },
        static=("floor",),
    )
    found = resolve(scene)
    assert not overlapping(after(scene, found))
    rises = [moves(found)[f"box{k}"] for k in range(3)]
    for k, way in enumerate(rises):
        assert way == pytest.approx((0, 0, 0.25 * (k + 1)), abs=1e-12)


def test_a_free_row_spreads_about_its_middle(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {f"box{k}": unit_at(0.5 * k) for k in range(3)})
    found = resolve(scene)
    assert not overlapping(after(scene, found))
    assert set(moves(found)) == {"box0", "box2"}
    assert moves(found)["box0"] == pytest.approx((-0.5, 0, 0), abs=1e-12)


def test_a_row_too_long_for_its_place_sends_some_elsewhere(tmp_path) -> None:
    """Ten boxes between walls that leave room for nine."""
    scene = boxes_scene(
        tmp_path,
        {
            "left": ((-1, -1, -1), (0, 2, 2)),
            "right": ((9.5, -1, -1), (10, 2, 2)),
            **{f"box{k}": unit_at(8.5 * k / 9) for k in range(10)},
        },
        static=("left", "right"),
    )
    found = resolve(scene)
    assert found.verdict == "resolved"
    assert not overlapping(after(scene, found))
    assert not {"left", "right"} & set(moves(found))
    # One box gives way by its width, shared with a neighbour; the others close up.
    assert 0.5 <= found.largest_motion <= 1
    assert found.total_motion <= 3


def test_a_box_in_another_comes_out(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"big": ((0, 0, 0), (8, 8, 8)), "small": unit_at(6.5, 3, 3)})
    found = resolve(scene, pins=["big"])
    assert moves(found) == {"small": (1.5, 0.0, 0.0)}


def test_what_nobody_asks_about_stays(tmp_path) -> None:
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(9), "d": unit_at(9.5)},
        groups={"c": "g", "d": "g"},
        allowed_pairs=[["a", "b", "welded"]],
        ignore_within_groups=["g"],
    )
    found = resolve(scene)
    assert (found.found, found.moves, found.verdict) == (0, (), "resolved")


def test_exempt_pairs_stay_together_only_as_far_as_others_let_them(tmp_path) -> None:
    """a and b may overlap, but c has to leave both."""
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.25), "c": unit_at(0.75, 0.5, 0.5)},
        allowed_pairs=[["a", "b"]],
    )
    found = resolve(scene)
    assert found.verdict == "resolved"
    assert overlapping(after(scene, found)) <= {("a", "b")}


def test_nothing_to_do(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(1), "c": unit_at(3)})
    found = resolve(scene)
    assert (found.found, found.moves, found.rounds, found.verdict) == (0, (), 0, "resolved")


def test_an_overlap_of_two_that_stay_is_said_and_the_rest_resolved(tmp_path) -> None:
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(5), "d": unit_at(5.5)},
        static=("a",),
    )
    found = resolve(scene, pins=["b"])
    assert [(one.a, one.b, one.relation) for one in found.left] == [("a", "b", "penetrating")]
    assert set(moves(found)) == {"c", "d"}
    assert found.verdict == "unresolved"


def test_a_longest_motion_is_kept_or_the_pair_is_left(tmp_path) -> None:
    boxes = {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(5), "d": unit_at(5.125)}
    scene = boxes_scene(tmp_path, boxes)
    found = resolve(scene, max_motion=0.3)
    assert found.largest_motion <= 0.3
    assert set(moves(found)) == {"a", "b"}
    assert [(one.a, one.b) for one in found.left] == [("c", "d")]
    assert "longest motion" in found.left[0].reason


def test_a_longest_motion_is_kept_where_one_body_could_make_way_for_many(tmp_path) -> None:
    """Least squares alone would move the one by (-0.8, -0.8, 0)."""
    boxes = {"tall": ((-5.0, -5.0, -20.0), (5.0, 5.0, 20.0))}
    for k in range(8):
        low, high = -19.5 + 5 * k, -15.5 + 5 * k
        boxes[f"x{k}"] = ((4.1, -4.0, low), (14.1, 4.0, high))
        boxes[f"y{k}"] = ((-4.0, 4.1, low), (4.0, 14.1, high))
    scene = boxes_scene(tmp_path, boxes)
    assert resolve(scene).largest_motion > 1.1
    found = resolve(scene, max_motion=1.0)
    assert found.verdict == "resolved"
    assert found.largest_motion <= 1.0


def test_the_clearance_is_what_is_left_between(tmp_path) -> None:
    boxes = {"a": unit_at(0), "b": unit_at(0.75, 0.25), "c": unit_at(5), "d": unit_at(6.125)}
    scene = boxes_scene(tmp_path, boxes)
    found = resolve(scene, Settings(clearance=0.25))
    assert found.verdict == "resolved"
    assert moves(found)["a"] == pytest.approx((-0.25, 0, 0), abs=1e-12)
    assert moves(found)["d"] == pytest.approx((0.0625, 0, 0), abs=1e-12)


def test_touching_concave_bodies_can_be_given_a_clearance(tmp_path) -> None:
    """A box in the notch of a bracket, flush with both walls."""
    scene = scene_of(tmp_path, bracket=bracket(), box=unit_box(2, 2, 1))
    found = resolve(scene, Settings(clearance=0.25), pins=["bracket"])
    assert found.verdict == "resolved"
    assert found.total_motion <= 0.75


def test_a_box_leaves_the_notch_of_a_bracket_by_the_notch(tmp_path) -> None:
    scene = scene_of(tmp_path, bracket=bracket(), box=unit_box(1.75, 1.875, 1))
    found = resolve(scene, pins=["bracket"])
    assert found.verdict == "resolved"
    assert moves(found)["box"] == pytest.approx((0.25, 0.125, 0), abs=0.02)


def test_an_open_surface_is_left(tmp_path) -> None:
    scene = scene_of(tmp_path, tray=open_box(), box=unit_box(1.5, 1.5, -0.25))
    found = resolve(scene, Settings(allow_open=True), pins=["tray"])
    assert found.verdict == "resolved"
    assert moves(found)["box"] == pytest.approx((0, 0, 0.25), abs=0.01)


def test_coincident_bodies_part(tmp_path) -> None:
    scene = scene_of(tmp_path, a=bracket(), b=bracket())
    found = resolve(scene)
    assert found.verdict == "resolved"
    assert found.found == 1


def test_an_unreadable_mesh_is_left_alone(tmp_path) -> None:
    paths = write(tmp_path, a=unit_box(), b=unit_box(0.5))
    (tmp_path / "c.obj").write_text("no mesh\n")
    found = resolve(load_scene([*paths, tmp_path / "c.obj"]))
    assert len(found.moves) == 2
    assert found.verdict == "incomplete"


@pytest.mark.parametrize("seed", range(12))
def test_random_boxes_end_free(tmp_path, seed) -> None:
    dice = random.Random(seed)
    boxes = {}
    for k in range(dice.randrange(2, 26)):
        low = tuple(dice.uniform(0, 3) for _ in range(3))
        boxes[f"box{k}"] = (low, tuple(c + dice.uniform(0.2, 1.5) for c in low))
    static = tuple(id_ for id_ in boxes if dice.random() < 0.15)
    scene = boxes_scene(tmp_path, boxes, static=static)
    before = overlapping(scene)
    found = resolve(scene)
    still = {pair for pair in before if set(pair) <= set(static)}
    assert overlapping(after(scene, found)) == still
    assert not set(moves(found)) & set(static)
    assert found.verdict == ("unresolved" if still else "resolved")
    # Scaled about one corner by the largest extent over the least distance of two centres, free
    # boxes would be apart; that is far more than what is needed, so a bound that is easy to keep.
    if not static:
        spread = sum(math.dist(low, (0, 0, 0)) for low, _ in boxes.values())
        assert found.total_motion <= spread * 4


@pytest.mark.parametrize("seed", range(4))
def test_random_brackets_end_free(tmp_path, seed) -> None:
    dice = random.Random(seed)
    meshes = {
        f"bracket{k}": moved(bracket(), *(dice.uniform(0, 9) for _ in range(3))) for k in range(8)
    }
    scene = scene_of(tmp_path, **meshes)
    found = resolve(scene)
    report = check(after(scene, found), Settings(depth=False, tolerance=0.0))
    assert report.summary.verdict == "pass"
    assert found.verdict == "resolved"


def test_the_order_of_the_scene_changes_nothing(tmp_path) -> None:
    boxes = {f"box{k}": unit_at(0.7 * k, 0.1 * k * k, 0.3 * (k % 3)) for k in range(6)}
    one = resolve(boxes_scene(tmp_path, boxes, static=("box2",)))
    other = resolve(boxes_scene(tmp_path, dict(reversed(boxes.items())), static=("box2",)))
    assert moves(one) == moves(other)


def test_threads_change_nothing(tmp_path) -> None:
    meshes = {f"bracket{k}": moved(bracket(), 3.5 * k, 2.5 * (k % 3), k) for k in range(9)}
    scene = scene_of(tmp_path, **meshes)
    one, many = (resolve(scene, Settings(jobs=jobs)).to_dict() for jobs in (1, 4))
    assert one == many


@pytest.mark.parametrize(
    ("code", "arguments"),
    [
        ("unknown-pin", {"pins": ["c*"]}),
        ("bad-setting", {"max_motion": 0.0}),
        ("bad-setting", {"max_motion": math.nan}),
        ("bad-setting", {"iterations": -1}),
    ],
)
def test_wrong_arguments_are_refused(tmp_path, code, arguments) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.5)})
    with pytest.raises(SatcheckError) as error:
        resolve(scene, **arguments)
    assert error.value.code == code


def test_without_rounds_bodies_are_taken_out(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {f"box{k}": unit_at(0.5 * k) for k in range(4)})
    found = resolve(scene, iterations=0)
    assert found.verdict == "resolved"
    assert not overlapping(after(scene, found))


def test_rounds_are_counted(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {f"box{k}": unit_at(0.5 * k) for k in range(4)})
    found = resolve(scene, iterations=1)
    assert found.rounds == 1
    assert found.verdict == "resolved"


def test_a_pair_that_fails_does_not_take_the_others_with_it(tmp_path, monkeypatch) -> None:
    from satcheck.audit.resolve import crowd

    examine = crowd.examine

    def broken(pair, plan):
        if "c" in (pair.a.id, pair.b.id):
            raise RuntimeError("a fault")
        return examine(pair, plan)

    monkeypatch.setattr(crowd, "examine", broken)
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(-0.5)})
    found = resolve(scene)
    assert {move.body for move in found.moves} == {"a", "b"}
    assert found.verdict == "unresolved"  # a and c were not looked at while b was pushed
    assert [(one.a, one.b) for one in found.left] == [("a", "c")]


def test_a_moved_body_does_not_end_inside_an_open_one(tmp_path) -> None:
    """The box could come to lie in the tray, which has no lid and so no inside."""
    scene = scene_of(tmp_path, tray=open_box(), box=unit_box(1.5, 1.5, -0.875))
    assert resolve(scene, pins=["tray"]).verdict == "resolved"


def with_rules(scene: Scene, *rules: dict[str, object]) -> Scene:
    """The scene with rules about all pairs, or about those that a rule names."""
    made = [
        Rule(**{"a": Selector("*"), "b": Selector("*")} | keys)  # type: ignore[arg-type]
        for keys in rules
    ]
    return replace(scene, rules=tuple(made))


def test_rules_decide_what_is_resolved(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75), "c": unit_at(5)})
    for keys in ({"max_depth": 0.5}, {"severity": "note"}, {"severity": "warning"}):
        assert resolve(with_rules(scene, keys)).moves == ()
    assert len(resolve(with_rules(scene, {"max_depth": 0.1})).moves) == 2
    apart = resolve(with_rules(scene, {"clearance": 0.5}))
    assert moves(apart)["b"] == pytest.approx((0.375, 0, 0), abs=1e-12)


def test_what_no_check_fails_on_is_left_alone(tmp_path) -> None:
    """Below a clearance, but a warning is no failure, unless somebody says so."""
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(1.25)})
    scene = with_rules(scene, {"clearance": 0.5, "severity": "warning"})
    assert resolve(scene).moves == ()
    found = resolve(scene, Settings(fail_on="warning"))
    assert (found.overlaps, found.gaps, found.verdict) == (0, 1, "resolved")
    assert found.total_motion == pytest.approx(0.25, abs=1e-12)


def test_an_overlap_is_only_reduced_to_its_limit(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75, 0.125)})
    found = resolve(with_rules(scene, {"max_depth": 0.125}))
    assert found.total_motion == pytest.approx(0.125, abs=1e-9)
    assert found.verdict == "resolved"


def test_an_overlap_of_concave_bodies_is_reduced_to_its_limit(tmp_path) -> None:
    """Up to the width of the interval of their depth."""
    scene = scene_of(tmp_path, bracket=bracket(), box=unit_box(1.5, 2, 1))
    found = resolve(with_rules(scene, {"max_depth": 0.25}), pins=["bracket"])
    assert found.verdict == "resolved"
    assert 0.25 * (1 - 1e-9) <= found.total_motion <= 0.25 * 1.02


def test_pushing_others_keeps_an_overlap_within_its_limit(tmp_path) -> None:
    """b gives way to c by s, and a by what is more than 0.5 of it: s^2 + (2 - s)^2 + (s - 0.5)^2 is
    least at 5/6."""
    boxes = {name: ((x, 0, 0), (x + 10, 10, 10)) for name, x in (("a", 0), ("b", 9), ("c", 17))}
    scene = boxes_scene(tmp_path, boxes)
    found = resolve(with_rules(scene, {"a": Selector("a"), "b": Selector("b"), "max_depth": 1.5}))
    assert found.verdict == "resolved"
    ways = {"a": -1 / 3, "b": -5 / 6, "c": 7 / 6}
    for body, way in ways.items():
        # Written with 9 digits, of which 2 are before the point.
        assert moves(found)[body] == pytest.approx((way, 0, 0), abs=1e-7)


def test_an_overlap_beyond_its_limit_of_volume_ends(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75)})
    assert resolve(with_rules(scene, {"max_volume": 0.5})).moves == ()
    assert resolve(with_rules(scene, {"max_volume": 0.1})).verdict == "resolved"


def test_a_hit_on_the_way_is_none_of_its_business(tmp_path) -> None:
    boxes = {"door": unit_at(0), "post": unit_at(0, 3)}
    scene = boxes_scene(tmp_path, boxes)
    motion = Motion(("door",), Translation((0.0, 5.0, 0.0)))
    found = resolve(replace(scene, motions=(motion,)))
    assert (found.found, found.moves) == (0, ())
    assert [(one.relation, one.reason) for one in found.left] == [("penetrating", ONLY_MOVING)]


AXES = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]


def least_squares_of(boxes) -> float:
    """The least sum of squares that parts three boxes: over all choices of a side for each pair."""
    names = list(boxes)
    pairs = list(combinations(range(len(names)), 2))
    sides = []
    for a, b in pairs:
        (a_low, a_high), (b_low, b_high) = boxes[names[a]], boxes[names[b]]
        sides.append(
            [(axis, b_high[k] - a_low[k]) for k, axis in enumerate(AXES)]
            + [(scaled(axis, -1.0), a_high[k] - b_low[k]) for k, axis in enumerate(AXES)]
        )
    best = math.inf
    for chosen in product(*sides):
        walls = [Wall(a, b, n, d) for (a, b), (n, d) in zip(pairs, chosen, strict=True)]
        found = least_motion(walls, {})
        if not found.broken:
            best = min(best, sum(dot(t, t) for t in found.offsets.values()))
    return best


@pytest.mark.parametrize("seed", range(7))
def test_three_boxes_move_little_more_than_they_have_to(tmp_path, seed) -> None:
    """No promise, but what is reached: mostly the least, and here never a fifth above it."""
    dice = random.Random(seed)
    boxes = {}
    for k in range(3):
        low = tuple(dice.uniform(0, 1) for _ in range(3))
        boxes[f"b{k}"] = (low, tuple(c + dice.uniform(0.5, 1.2) for c in low))
    found = resolve(boxes_scene(tmp_path, boxes))
    reached = sum(dot(move.translation, move.translation) for move in found.moves)
    least = least_squares_of(boxes)
    assert least * (1 - 1e-9) <= reached <= least * 1.2


@pytest.mark.parametrize(
    "names", [("ring.glb", "link_b.glb"), ("kettle.obj", "snowflake.obj")], ids="-".join
)
@pytest.mark.parametrize("pinned", [0, 1])
def test_a_pair_alone_moves_by_its_depth(names, pinned) -> None:
    """As far as a check says that one of them has to, together or one alone."""
    scene = load_scene([SAMPLES / name for name in names], split="none")
    (pair,) = check(scene, Settings(depth=True)).findings
    found = resolve(scene, pins=[body.id for body in scene.bodies[:pinned]])
    assert found.verdict == "resolved"
    assert len(found.moves) == 2 - pinned
    assert pair.depth_bounds is not None
    # Decimals are rounded by up to 1e-6 of the size.
    low, high = pair.depth_bounds
    assert low - 1e-5 <= found.total_motion <= high + 1e-5


def test_a_finger_leaves_what_it_presses_and_the_others_make_room() -> None:
    """The left finger is 0.25 in the payload, which touches the right one: s^2 for the left and
    twice (0.25 - s)^2 for the others is least at 1/6. The palm touches both, and stays."""
    found = resolve(load_scene([SAMPLES / "gripper.glb"]))
    reached = moves(found)
    assert set(reached) == {"gripper/left", "gripper/right", "payload"}
    assert reached["gripper/left"] == pytest.approx((-1 / 6, 0, 0), abs=1e-6)
    assert reached["payload"] == pytest.approx((1 / 12, 0, 0), abs=1e-6)


def test_a_body_goes_first_where_that_is_shorter(tmp_path) -> None:
    """Four boxes are 0.2 in the one between them sideways, 0.3 from below. Aside each moves by
    0.2; up is longer, but one goes for all: s^2 + 4 (0.3 - s)^2 is least at 0.24."""
    boxes = {"box": unit_at(0)}
    for k, (x, y) in enumerate([(0.8, 0.3), (-0.8, 0.3), (0.3, 0.8), (0.3, -0.8)]):
        width = (1.0, 0.4) if k < 2 else (0.4, 1.0)
        boxes[f"side{k}"] = ((x, y, -0.7), (x + width[0], y + width[1], 0.3))
    found = resolve(boxes_scene(tmp_path, boxes))
    assert found.verdict == "resolved"
    squares = sum(dot(move.translation, move.translation) for move in found.moves)
    assert squares == pytest.approx(0.24**2 + 4 * 0.06**2, rel=0.02)
