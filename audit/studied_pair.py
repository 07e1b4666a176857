"""A new pair of bodies without cached data, as a check makes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_bodies import BodyCache, code_of_placing
from satcheck.audit.request.planner import request_for
from satcheck.audit.request.settings import Settings
from satcheck.core.errors import SatcheckError
from satcheck.scene import Body

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.core.overlap_volume import VolumeMeter

Bodies = tuple[Body, Body]


def pair_of(bodies: Bodies, settings: Settings, meter: VolumeMeter | None = None) -> Pair:
    """Raises SatcheckError where a body cannot be placed."""
    cache = BodyCache()
    a, b = (_placed(cache, body, settings) for body in bodies)
    return Pair(a, b, settings, request_for(settings), meter)


def _placed(cache: BodyCache, body: Body, settings: Settings) -> PlacedBody:
    try:
        return cache.place(body, settings, None)
    except (OverflowError, ValueError) as error:
        raise SatcheckError(
            code_of_placing(error), f"cannot be placed: {error}", body=body.id
        ) from None
