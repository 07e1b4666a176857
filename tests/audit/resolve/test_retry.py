"""The shortest way of one body among others: over all of them at once."""

from __future__ import annotations

import pytest

from satcheck.audit import Settings
from satcheck.audit.resolve.layout import Layout
from satcheck.audit.resolve.retry import way_alone
from tests.audit.resolve.boxes import boxes_scene, unit_at
from tests.audit.shapes import open_box, scene_of, unit_box


def crowd_of(scene, settings: Settings | None = None) -> Layout:
    layout = Layout(scene, settings or Settings(), frozenset())
    layout.look_closely(1)
    return layout


def test_out_of_two_at_once(tmp_path) -> None:
    """The nearest side of b leads into c."""
    boxes = {"a": unit_at(0), "b": unit_at(0.75, 0.5, 0.5), "c": unit_at(-1.125, 0.5, 0.5)}
    layout = crowd_of(boxes_scene(tmp_path, boxes))
    way = way_alone(layout, 0, 2.0)
    assert way is not None
    assert sorted(map(abs, way)) == pytest.approx([0, 0, 0.5], abs=0.005)


def test_others_count_where_they_were_moved_to(tmp_path) -> None:
    layout = crowd_of(boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.5)}))
    layout.move({1: (0.25, 0.0, 0.0)})
    assert way_alone(layout, 0, 2.0) == pytest.approx((-0.25, 0, 0), abs=0.0025)
    layout.move({1: (3.0, 0.0, 0.0)})
    assert way_alone(layout, 0, 2.0) == (0, 0, 0)


def test_only_what_is_shorter_is_found(tmp_path) -> None:
    layout = crowd_of(boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.5)}))
    assert way_alone(layout, 0, 0.49) is None
    assert way_alone(layout, 0, 0.51) is not None


def test_no_answer_where_more_is_asked_than_to_leave_a_solid(tmp_path) -> None:
    boxes = boxes_scene(tmp_path, {"a": unit_at(0), "b": unit_at(0.5)})
    assert way_alone(crowd_of(boxes, Settings(clearance=0.125)), 0, 2.0) is None
    tray = scene_of(tmp_path, tray=open_box(), box=unit_box(1.5, 1.5, -0.25))
    assert way_alone(crowd_of(tray), 0, 2.0) is None
