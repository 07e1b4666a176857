"""Volumes of an L and of what rungs put in its place, by hand, as it stands, turned and scaled."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from satcheck.audit.bodies.placed_bodies import BodyCache
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.request.settings import Settings
from satcheck.scene import Body, load_scene
from satcheck.studies.tradeoff.volumes import body_volume, stand_in_volume

SAMPLES = Path(__file__).resolve().parents[3] / "sample_meshes"
# Areas: arms of 6 by 2 and 2 by 4; with the triangle between them; of the square around.
L, L_HULL, L_BOX, THICK = 20.0, 28.0, 36.0, 4.0
ROUNDOFF = 1e-12  # relative: a chain of some tens of operations


def placed(name: str, transform: tuple[float, ...] | None = None) -> PlacedBody:
    (file,) = {body.file for body in load_scene([SAMPLES / name]).bodies}
    return BodyCache().place(Body("a", "", file, transform), Settings(), None)


def turned(angle: float, scale: float) -> tuple[float, ...]:
    """About z, then scaled."""
    c, s = scale * math.cos(angle), scale * math.sin(angle)
    return (c, -s, 0.0, 5.0, s, c, 0.0, 6.0, 0.0, 0.0, scale, 7.0, 0.0, 0.0, 0.0, 1.0)


def test_of_an_l_as_it_stands() -> None:
    body = placed("l_bracket.obj")
    known = {rung: stand_in_volume(rung, body) for rung in ("aabb", "obb", "hull")}
    expected = {"aabb": L_BOX * THICK, "obb": L_BOX * THICK, "hull": L_HULL * THICK}
    assert known == pytest.approx(expected, rel=ROUNDOFF)
    assert body_volume(body) == pytest.approx(L * THICK, rel=ROUNDOFF)
    assert stand_in_volume("parts", body) is None  # nobody has made any


@pytest.mark.parametrize("scale", [0.5, 3.0])
def test_turned_and_scaled_the_box_of_the_world_alone_takes_more(scale: float) -> None:
    still = placed("l_bracket.obj")
    body = placed("l_bracket.obj", turned(math.pi / 4, scale))
    for rung in ("obb", "hull"):
        assert stand_in_volume(rung, body) == pytest.approx(
            scale**3 * (stand_in_volume(rung, still) or 0), rel=ROUNDOFF
        )
    assert body_volume(body) == pytest.approx(scale**3 * (body_volume(still) or 0), rel=ROUNDOFF)
    # Turned by an eighth, y runs from 0 at the outer corner to 8 / sqrt(2) at the ends of the arms.
    area = (12.0 * math.sqrt(0.5)) * (8.0 * math.sqrt(0.5))
    assert stand_in_volume("aabb", body) == pytest.approx(scale**3 * area * THICK, rel=ROUNDOFF)


@pytest.mark.parametrize("name", ["open_box.off", "kettle.obj"])
def test_what_is_no_solid_or_overlaps_itself_has_none(name: str) -> None:
    assert body_volume(placed(name)) is None
