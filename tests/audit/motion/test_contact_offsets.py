"""Contact that goes on: sliding on a table, in a corner, turning on the spot, leaving."""

from __future__ import annotations

import pytest

from satcheck.scene.motion import PosePath, Rotation, Translation, Waypoint
from tests.audit.motion.pairs import first_impact, moving
from tests.audit.motion.slots import tee, tee_slot
from tests.audit.shapes import box, bracket, moved, unit_box

TABLE = box((-9, -9, -1), (9, 9, 0))
DEEPER = 2.0**-24  # a power of two, so that moving by it rounds nothing
BANDS = [0.0, 1e-6]


def impact_of(a, path, b, tolerance=1e-6):
    return first_impact(moving(a, path, b, tolerance=tolerance))


@pytest.mark.parametrize("tolerance", BANDS)
@pytest.mark.parametrize("body", [unit_box(), bracket()])
@pytest.mark.parametrize(
    "path",
    [
        Translation((3.0, 2.0, 0.0)),
        Translation((-0.3, 0.7, 1e-3)),
        Rotation((0.3, 0.7, 0.0), (0.0, 0.0, 1.0), 500.0),
        PosePath(
            (
                Waypoint(0.0, (0.0, 0.0, 0.0)),
                Waypoint(0.5, (1.0, 1.0, 0.0), (0.0, 0.0, 0.6, 0.8)),
                Waypoint(1.0, (1.0, -1.0, 0.0)),
            )
        ),
    ],
)
def test_on_a_table(body, path, tolerance):
    impact = impact_of(body, path, TABLE, tolerance)
    assert impact.free
    assert impact.contact == 0.0


@pytest.mark.parametrize("body", [unit_box(), bracket()])
def test_set_into_the_table_within_the_band(body):
    impact = impact_of(moved(body, 0, 0, -DEEPER), Translation((3.0, 2.0, 0.0)), TABLE)
    assert impact.free


@pytest.mark.parametrize("body", [unit_box(), bracket()])
def test_into_the_table(body):
    """Along it for half of the time, then into it: by the band after half its length."""
    path = PosePath(
        (
            Waypoint(0.0, (0.0, 0.0, 0.0)),
            Waypoint(0.5, (2.0, 0.0, 0.0)),
            Waypoint(1.0, (2.0, 0.0, -0.5)),
        )
    )
    impact = impact_of(body, path, TABLE)
    assert impact.lower == pytest.approx(0.5, abs=1e-6)
    assert impact.lower <= 0.5 <= impact.upper <= 0.5 + 2e-6


@pytest.mark.parametrize("tolerance", BANDS)
@pytest.mark.parametrize(
    "path",
    [Translation((0.0, 0.0, 2.0)), Translation((0.0, 1.0, 1.0)), Translation((3.0, 1.0, 0.0))],
)
def test_along_the_walls_of_a_corner(path, tolerance):
    """A box in the notch of an L, at both of its walls; no plane separates the two."""
    impact = impact_of(unit_box(2, 2, 1), path, bracket(), tolerance)
    assert impact.free
    assert impact.contact == 0.0


def test_opening_like_a_door():
    """The arm of an L lies on a ledge and turns off it; its back end goes down where nothing is."""
    path = Rotation((-4.0, 1.0, -6.0), (0.0, 0.0, 1.0), 90.0)
    impact = impact_of(moved(bracket(), -5, 4, 2), path, moved(bracket(), -2, -2, 5))
    assert impact.free
    assert impact.contact == 0.0


@pytest.mark.parametrize("tolerance", BANDS)
@pytest.mark.parametrize("frame", [box((-1, -1, 0), (0, 0, 8)), moved(bracket(), -6, -2, 0)])
@pytest.mark.parametrize("door", [box((0, -1, 0), (5, 0, 8)), moved(bracket(), 0, -2, 0)])
def test_on_a_flush_hinge(door, frame, tolerance):
    """The door touches its frame along the axis of its turn, at every moment."""
    impact = impact_of(door, Rotation((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 85.0), frame, tolerance)
    assert impact.free
    assert impact.contact == 0.0


def test_into_the_wall_of_a_corner():
    path = Translation((-0.5, 0.0, 1.0))
    impact = impact_of(unit_box(3, 2, 1), path, bracket())
    assert impact.free
    further = impact_of(unit_box(3, 2, 1), Translation((-2.0, 0.0, 1.0)), bracket())
    assert further.lower <= 0.5 <= further.upper <= 0.5 + 2e-6


@pytest.mark.parametrize("into", [0.0, -0.05])
def test_a_body_that_is_smaller_than_the_band_is_not_lost_in_the_other(into):
    """A speck at an arm of the L, or within the band in it, goes on into the arm, and soon no
    surface is in its way."""
    speck = box((4, 2 + into, 1), (4.11, 2.11 + into, 1.11))
    impact = impact_of(speck, Translation((0.0, -1.0, 0.0)), bracket(), tolerance=0.1)
    assert impact.lower <= 0.1 + into <= impact.upper
    along = impact_of(speck, Translation((1.0, 0.0, 0.0)), bracket(), tolerance=0.1)
    assert along.upper is None


def test_a_body_that_is_thinner_than_the_band_has_no_impact():
    """No overlap of it is thicker than the band; that it stays so all the way is open."""
    speck = box((4, 2, 1), (4.09, 2.09, 1.09))
    impact = impact_of(speck, Translation((0.0, -1.0, 0.0)), bracket(), tolerance=0.1)
    assert impact.upper is None


def test_where_nothing_is_proven_the_answer_is_open():
    """A T in a slot of the same outline has no offset that frees it, and its hull overlaps the
    slot. It never overlaps."""
    impact = impact_of(tee(1.0, 2.0), Translation((0.0, 0.5, 0.0)), tee_slot())
    assert not impact.free
    assert impact.upper is None
    assert impact.reason.startswith("not proven apart at t = ")
