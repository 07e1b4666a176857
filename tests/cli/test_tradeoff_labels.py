"""Labels beside points, off everything that is drawn."""

from __future__ import annotations

from satcheck.cli.report.tradeoff_labels import Box, around, baseline, place

FRAME = (0.0, 0.0, 200.0, 100.0)


def apart(one: Box, other: Box) -> bool:
    return one[2] <= other[0] or other[2] <= one[0] or one[3] <= other[1] or other[3] <= one[1]


def test_a_label_stands_above_its_point_where_there_is_room() -> None:
    box = place("hull", (100, 100, 50), [around(100, 50)], FRAME)
    assert box[3] <= around(100, 50)[1]
    assert box[0] + box[2] == 200
    x, y = baseline(box)
    assert x == box[0]
    assert box[1] < y < box[3]


def test_labels_of_points_on_each_other_keep_apart() -> None:
    taken = [around(100, 50), around(104, 50), around(108, 50)]
    for text in ("aabb", "obb", "hull", "parts 0.5"):
        box = place(text, (104, 104, 50), taken, FRAME)
        assert all(apart(box, other) for other in taken), text
        taken.append(box)


def test_a_label_stays_within_the_frame() -> None:
    for x, y in ((1, 8), (199, 8), (1, 92), (199, 92), (100, 50)):
        box = place("boolean", (x, x, y), [around(x, y)], FRAME)
        assert box[0] >= 0
        assert box[1] >= 0
        assert box[2] <= 200
        assert box[3] <= 100
        assert apart(box, around(x, y))
