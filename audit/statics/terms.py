"""Gravity, friction and tolerance of a check, with what the scene states and what is assumed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.scene.statics import FRICTION, BodyTerms, StaticsTerms, down_of
from satcheck.scene.units import MICROMETRES, unit_of

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.scene import Scene

TOLERANCE_MICROMETRES = 1000  # 1 mm, if the unit of length is known
TOLERANCE_SHARE = 1e-3  # of the smallest free body, if it is not

Stated = Literal["gravity", "friction", "tolerance"]


class Terms(Struct, frozen=True):
    """gravity: unit. stated: which of these the scene states."""

    gravity: Vector
    friction: float
    tolerance: float
    stated: tuple[Stated, ...]

    def friction_of(self, a: BodyTerms, b: BodyTerms) -> float:
        """Of a contact of two bodies: the smaller of theirs."""
        own = [terms.value("friction") for terms in (a, b)]
        return min([value for value in own if value is not None], default=self.friction)


def terms_for(scene: Scene, free: Sequence[PlacedBody]) -> Terms:
    """free: the bodies that may fall."""
    stated = scene.statics or StaticsTerms()
    gravity = stated.gravity or down_of(scene)
    size = math.hypot(*gravity)
    x, y, z = (c / size for c in gravity)
    names: tuple[Stated, ...] = ("gravity", "friction", "tolerance")
    return Terms(
        (x, y, z),
        FRICTION if stated.friction is None else stated.friction,
        contact_tolerance(scene, free),
        tuple(name for name in names if getattr(stated, name) is not None),
    )


def contact_tolerance(scene: Scene, free: Sequence[PlacedBody]) -> float:
    """As stated, else by the unit of length, else by the smallest of these bodies."""
    if scene.statics is not None and scene.statics.tolerance is not None:
        return scene.statics.tolerance
    unit = unit_of(scene.units)
    if unit is not None:
        return TOLERANCE_MICROMETRES / MICROMETRES[unit]
    return TOLERANCE_SHARE * min((body.diagonal for body in free), default=0.0)
