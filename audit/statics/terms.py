"""Gravity, friction and tolerance of a check, with what the scene states and what is assumed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from msgspec import Struct

from satcheck.core.conventions import Vector
from satcheck.scene.statics import FRICTION, BodyTerms, StaticsTerms
from satcheck.scene.units import MICROMETRES, unit_of

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.scene import Scene

TOLERANCE_MICROMETRES = 1000  # 1 mm, if the unit of length is known
TOLERANCE_SHARE = 1e-3  # of the smallest free body, if it is not

Stated = Literal["gravity", "friction", "tolerance"]

_DOWN_Z: Vector = (0.0, 0.0, -1.0)
_DOWN_Y: Vector = (0.0, -1.0, 0.0)
_Y_UP = frozenset(("glb", "gltf"))  # "The scene's up is +Y": the glTF 2.0 specification, 3.4


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
    gravity = stated.gravity or _down(scene)
    size = math.hypot(*gravity)
    x, y, z = (c / size for c in gravity)
    tolerance = stated.tolerance
    if tolerance is None:
        tolerance = _tolerance(scene, free)
    names: tuple[Stated, ...] = ("gravity", "friction", "tolerance")
    return Terms(
        (x, y, z),
        FRICTION if stated.friction is None else stated.friction,
        tolerance,
        tuple(name for name in names if getattr(stated, name) is not None),
    )


def _down(scene: Scene) -> Vector:
    """Along the up axis of the format if the bodies are nodes of files that state one."""
    formats = {body.file.format for body in scene.bodies}
    return _DOWN_Y if formats and formats <= _Y_UP and not scene.entries else _DOWN_Z


def _tolerance(scene: Scene, free: Sequence[PlacedBody]) -> float:
    unit = unit_of(scene.units)
    if unit is not None:
        return TOLERANCE_MICROMETRES / MICROMETRES[unit]
    return TOLERANCE_SHARE * min((body.diagonal for body in free), default=0.0)
