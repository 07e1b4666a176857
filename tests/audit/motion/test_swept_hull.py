"""Solids that slide in contact: sliders in slots of their own width, and obstacles in their way."""

from __future__ import annotations

import math

import pytest

from satcheck.audit.motion.contact import safe_slide
from satcheck.scene.motion import Rotation, Translation
from tests.audit.motion.pairs import first_impact, moving
from tests.audit.motion.slots import channel, tee, tee_slot
from tests.audit.shapes import box

TOLERANCE = 1e-6
SLIDER = box((1, 1, 0), (2, 3, 1))
ALONG = Translation((0.0, 1.5, 0.0))


def impact_of(a, path, b, path_b=None):
    return first_impact(moving(a, path, b, path_b, tolerance=TOLERANCE))


def joined(*meshes):
    """One mesh of several; they may overlap."""
    points, faces = [], []
    for corners, polygons in meshes:
        faces += [tuple(k + len(points) for k in polygon) for polygon in polygons]
        points += corners
    return points, faces


def turned(mesh, degrees):
    """About z; the corners are rounded, so that the slider no longer fits to the last bit."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    points, faces = mesh
    return [(c * x - s * y, s * x + c * y, z) for x, y, z in points], faces


def test_a_slider_in_its_slot_touches_it_all_the_way():
    impact = impact_of(SLIDER, ALONG, channel())
    assert impact.free
    assert impact.contact == 0.0


@pytest.mark.parametrize("degrees", [7, 30, 45, 61, 123])
def test_a_turned_slot(degrees):
    x, y, z = turned(([ALONG.vector], []), degrees)[0][0]
    slider, slot = turned(SLIDER, degrees), turned(channel(), degrees)
    assert impact_of(slider, Translation((x, y, z)), slot).free


def test_the_slot_may_move_instead_or_too():
    assert impact_of(channel(), ALONG, SLIDER).free
    assert impact_of(SLIDER, ALONG, channel(), Translation((3.0, 7.0, 1.0))).upper is not None
    both = Translation((3.0, 7.0, 1.0)), Translation((3.0, 6.0, 1.0))
    assert impact_of(SLIDER, both[0], channel(), both[1]).free


@pytest.mark.parametrize("size", [1e-5, 1e-2])
def test_an_obstacle_in_the_slot_is_hit(size):
    """A block on the floor of the slot, 0.75 ahead of the slider and thicker than the band."""
    block = box((1.5, 3.75, -0.5), (1.5 + size, 3.75 + size, size))
    impact = impact_of(SLIDER, ALONG, joined(channel(), block))
    assert impact.lower <= 0.5 + TOLERANCE
    assert 0.5 <= impact.upper <= 0.5 + 4 * TOLERANCE


def test_a_slot_that_narrows_is_hit():
    """Its walls end, and two blocks, closer by 1e-4, go on at y = 3.75."""
    block = box((1.9999, 3.75, 0.25), (2.5, 4.5, 0.75))
    impact = impact_of(SLIDER, ALONG, joined(channel(), block))
    assert 0.5 <= impact.upper <= 0.5 + 4 * TOLERANCE


def test_a_slot_that_is_too_narrow_is_hit_at_once():
    impact = impact_of(box((0.9999, 1, 0), (2, 3, 1)), ALONG, channel())
    assert impact.upper == 0.0


def test_only_lines_of_hulls_beside_the_other_body_are_proven():
    """Not a turn, not a speck within the wall that is smaller than the band, not two concave
    bodies."""
    about = Rotation((1.5, 2.0, 0.0), (0.0, 0.0, 1.0), 1e-3)
    assert safe_slide(moving(SLIDER, about, channel(), tolerance=TOLERANCE), 0.0, 1.0) == 0.0
    speck = box((0.9999, 1, 0), (1.0001, 1.0002, 0.0002))
    assert safe_slide(moving(speck, ALONG, channel(), tolerance=1e-3), 0.0, 1.0) == 0.0
    pair = moving(tee(1.0, 2.0), ALONG, tee_slot(), tolerance=TOLERANCE)
    assert safe_slide(pair, 0.0, 1.0) == 0.0


def test_a_part_of_the_way_is_proven():
    """The end of the slide overlaps a wall, its first half does not."""
    wall = box((1, 4.0, -0.5), (2, 4.25, 0.5))
    pair = moving(SLIDER, ALONG, joined(channel(), wall), tolerance=TOLERANCE)
    assert safe_slide(pair, 0.0, 1.0) == 0.5
