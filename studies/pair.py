"""A new pair of bodies without cached data, as a check makes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_bodies import BodyCache
from satcheck.audit.request.planner import request_for
from satcheck.audit.request.settings import Settings
from satcheck.scene import Body

if TYPE_CHECKING:
    from satcheck.core.overlap_volume import VolumeMeter

Bodies = tuple[Body, Body]


def pair_of(bodies: Bodies, settings: Settings, meter: VolumeMeter | None = None) -> Pair:
    cache = BodyCache()
    a, b = (cache.place(body, settings, None) for body in bodies)
    return Pair(a, b, settings, request_for(settings), meter)
