"""Scenes with known answers, and what is refused or left."""

from __future__ import annotations

import math
import sys

import pytest

from satcheck.audit import Settings
from satcheck.audit.finding import examine
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from tests.audit.resolve.boxes import after, boxes_scene, moves, overlapping, resolve, unit_at
from tests.audit.shapes import bracket, open_box, scene_of, unit_box, write


def test_two_free_boxes_share_the_shortest_way(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.75, 0.25)})
    resolution = resolve(scene)
    assert moves(resolution) == {"a": (-0.125, 0.0, 0.0), "b": (0.125, 0.0, 0.0)}
    assert resolution.summary.verdict == "resolved"
    assert resolution.check.by_relation["touching"] == 1
    assert (
        resolution.summary.conflicts,
        resolution.summary.total_motion,
        resolution.summary.largest_motion,
    ) == (
        1,
        0.25,
        0.125,
    )


@pytest.mark.parametrize("how", ["static", "pin", "group"])
def test_a_box_beside_one_that_stays_moves_all_the_way(tmp_path, how) -> None:
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.75, 0.25)},
        static=("a",) if how == "static" else (),
        groups={"a": "fixed"},
    )
    pins = {"static": (), "pin": ("a*",), "group": ("group:fix*",)}[how]
    resolution = resolve(scene, pins=pins)
    assert moves(resolution) == {"b": (0.25, 0.0, 0.0)}
    assert resolution.pinned == ("a",)


def test_a_pin_is_the_body_of_that_very_name(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"br[0]": unit_at(0), "br0": unit_at(9)})
    assert resolve(scene, pins=("br[0]",)).pinned == ("br[0]",)


def test_the_links_of_a_robot_stay(tmp_path) -> None:
    """A link goes where its joints put it; what it meets makes way."""
    link = (
        '<link name="base"><collision><geometry><box size="1 1 1"/></geometry></collision></link>'
    )
    (tmp_path / "robot.urdf").write_text(f'<robot name="r">{link}</robot>')
    files = [tmp_path / "robot.urdf", *write(tmp_path, box=unit_box())]
    resolution = resolve(load_scene(files, units="m"))
    assert resolution.pinned == ("base",)
    assert list(moves(resolution)) == ["box"]
    assert resolution.summary.verdict == "resolved"


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
    resolution = resolve(scene)
    assert moves(resolution) == {"box": (0.25, 0.0, 0.125)}
    # The walls cross each other, and both stay.
    assert [(one.a, one.b, one.reason) for one in resolution.left] == [
        ("left", "floor", "both bodies stay")
    ]
    assert resolution.summary.verdict == "unresolved"


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
    resolution = resolve(scene)
    assert not overlapping(after(scene, resolution))
    rises = [moves(resolution)[f"box{k}"] for k in range(3)]
    for k, way in enumerate(rises):
        assert way == pytest.approx((0, 0, 0.25 * (k + 1)), abs=1e-9)


def test_a_free_row_spreads_about_its_middle(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {f"box{k}": unit_at(0.5 * k) for k in range(3)})
    resolution = resolve(scene)
    assert not overlapping(after(scene, resolution))
    assert moves(resolution)["box0"] == pytest.approx((-0.5, 0, 0), abs=0.02)
    assert resolution.summary.total_motion <= 1.02


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
    resolution = resolve(scene)
    assert resolution.summary.verdict == "resolved"
    assert not overlapping(after(scene, resolution))
    assert not {"left", "right"} & set(moves(resolution))
    # One box gives way by its width, shared with a neighbour; the others close up.
    assert 0.5 <= resolution.summary.largest_motion <= 1 + 1e-9
    assert resolution.summary.total_motion <= 3


def test_a_box_in_another_comes_out(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"big": ((0, 0, 0), (8, 8, 8)), "small": unit_at(6.5, 3, 3)})
    resolution = resolve(scene, pins=["big"])
    assert moves(resolution) == {"small": (1.5, 0.0, 0.0)}


def test_what_nobody_asks_about_stays(tmp_path) -> None:
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(9), "d": unit_at(9.5)},
        groups={"c": "g", "d": "g"},
        allowed_pairs=[["a", "b", "welded"]],
        ignore_within_groups=["g"],
    )
    resolution = resolve(scene)
    assert (resolution.summary.conflicts, resolution.moves, resolution.summary.verdict) == (
        0,
        (),
        "resolved",
    )


def test_exempt_pairs_stay_together_only_as_far_as_others_let_them(tmp_path) -> None:
    """a and b may overlap, but c has to leave both."""
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.25), "c": unit_at(0.75, 0.5, 0.5)},
        allowed_pairs=[["a", "b"]],
    )
    resolution = resolve(scene)
    assert resolution.summary.verdict == "resolved"
    assert overlapping(after(scene, resolution)) <= {("a", "b")}


def test_nothing_to_do(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(1), "c": unit_at(3)})
    resolution = resolve(scene)
    assert (
        resolution.summary.conflicts,
        resolution.moves,
        resolution.summary.rounds,
        resolution.summary.verdict,
    ) == (
        0,
        (),
        0,
        "resolved",
    )


def test_an_overlap_of_two_that_stay_is_said_and_the_rest_resolved(tmp_path) -> None:
    scene = boxes_scene(
        tmp_path,
        {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(5), "d": unit_at(5.5)},
        static=("a",),
    )
    resolution = resolve(scene, pins=["b"])
    assert [(one.a, one.b, one.relation) for one in resolution.left] == [("a", "b", "penetrating")]
    assert set(moves(resolution)) == {"c", "d"}
    assert resolution.summary.verdict == "unresolved"


def test_a_longest_motion_is_kept_or_the_pair_is_left(tmp_path) -> None:
    boxes = {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(5), "d": unit_at(5.125)}
    scene = boxes_scene(tmp_path, boxes)
    resolution = resolve(scene, max_motion=0.3)
    assert resolution.summary.largest_motion <= 0.3
    assert set(moves(resolution)) == {"a", "b"}
    assert [(one.a, one.b) for one in resolution.left] == [("c", "d")]
    assert "longest motion" in resolution.left[0].reason


def test_a_longest_motion_is_kept_where_one_body_could_make_way_for_many(tmp_path) -> None:
    """The others alone would make the one go too far."""
    boxes = {"tall": ((-5.0, -5.0, -20.0), (5.0, 5.0, 20.0))}
    for k in range(8):
        low, high = -19.5 + 5 * k, -15.5 + 5 * k
        boxes[f"x{k}"] = ((4.1, -4.0, low), (14.1, 4.0, high))
        boxes[f"y{k}"] = ((-4.0, 4.1, low), (4.0, 14.1, high))
    scene = boxes_scene(tmp_path, boxes)
    assert resolve(scene).summary.largest_motion > 1.1
    resolution = resolve(scene, max_motion=1.0)
    assert resolution.summary.verdict == "resolved"
    assert resolution.summary.largest_motion <= 1.0


def test_the_clearance_is_what_is_left_between(tmp_path) -> None:
    boxes = {"a": unit_at(0), "b": unit_at(0.75, 0.25), "c": unit_at(5), "d": unit_at(6.125)}
    scene = boxes_scene(tmp_path, boxes)
    resolution = resolve(scene, Settings(clearance=0.25))
    assert resolution.summary.verdict == "resolved"
    assert moves(resolution)["a"] == pytest.approx((-0.25, 0, 0), abs=1e-12)
    assert moves(resolution)["d"] == pytest.approx((0.0625, 0, 0), abs=1e-12)


def test_touching_concave_bodies_can_be_given_a_clearance(tmp_path) -> None:
    """A box in the notch of a bracket, flush with both walls."""
    scene = scene_of(tmp_path, bracket=bracket(), box=unit_box(2, 2, 1))
    resolution = resolve(scene, Settings(clearance=0.25), pins=["bracket"])
    assert resolution.summary.verdict == "resolved"
    assert resolution.summary.total_motion <= 0.75


def test_a_box_leaves_the_notch_of_a_bracket_by_the_notch(tmp_path) -> None:
    scene = scene_of(tmp_path, bracket=bracket(), box=unit_box(1.75, 1.875, 1))
    resolution = resolve(scene, pins=["bracket"])
    assert resolution.summary.verdict == "resolved"
    assert moves(resolution)["box"] == pytest.approx((0.25, 0.125, 0), abs=0.02)


def test_an_open_surface_is_left(tmp_path) -> None:
    scene = scene_of(tmp_path, tray=open_box(), box=unit_box(1.5, 1.5, -0.25))
    resolution = resolve(scene, Settings(allow_open=True), pins=["tray"])
    assert resolution.summary.verdict == "resolved"
    assert moves(resolution)["box"] == pytest.approx((0, 0, 0.25), abs=0.01)


def test_coincident_bodies_part(tmp_path) -> None:
    scene = scene_of(tmp_path, a=bracket(), b=bracket())
    resolution = resolve(scene)
    assert resolution.summary.verdict == "resolved"
    assert resolution.summary.conflicts == 1


def test_an_unreadable_mesh_is_left_alone(tmp_path) -> None:
    paths = write(tmp_path, a=unit_box(), b=unit_box(0.5))
    (tmp_path / "c.obj").write_text("no mesh\n")
    resolution = resolve(load_scene([*paths, tmp_path / "c.obj"]))
    assert len(resolution.moves) == 2
    assert resolution.summary.verdict == "incomplete"


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
    resolution = resolve(scene, iterations=0)
    assert resolution.summary.verdict == "resolved"
    assert not overlapping(after(scene, resolution))


def test_rounds_are_counted(tmp_path) -> None:
    scene = boxes_scene(tmp_path, {f"box{k}": unit_at(0.5 * k) for k in range(4)})
    resolution = resolve(scene, iterations=1)
    assert resolution.summary.rounds == 1
    assert resolution.summary.verdict == "resolved"


def test_a_pair_that_fails_does_not_take_the_others_with_it(tmp_path, monkeypatch) -> None:
    """The check of the moved scene asks for no depth."""

    def broken(draft, climb=None):
        if "c" in (draft.pair.a.id, draft.pair.b.id) and draft.pair.request.wants("depth"):
            raise RuntimeError("a fault")
        return examine(draft, climb)

    monkeypatch.setattr(sys.modules["satcheck.audit.checked_pairs"], "examine", broken)
    scene = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.5), "c": unit_at(-0.5)})
    resolution = resolve(scene)
    assert {move.body for move in resolution.moves} == {"a", "b"}
    assert (
        resolution.summary.verdict == "unresolved"
    )  # a and c were not looked at while b was pushed
    assert [(one.a, one.b) for one in resolution.left] == [("a", "c")]


def test_a_moved_body_does_not_end_inside_an_open_one(tmp_path) -> None:
    """The box could come to lie in the tray, which has no lid and so no inside."""
    scene = scene_of(tmp_path, tray=open_box(), box=unit_box(1.5, 1.5, -0.875))
    assert resolve(scene, pins=["tray"]).summary.verdict == "resolved"
