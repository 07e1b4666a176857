"""The rung of half spaces: a body against a plane, by its least height over it.

The height is that of the hull, so that no hole and no hollow of the body leaves it open: `core/
half_space.py` computes it exactly. The triangles of the block of the half space (`core.shapes`)
answer for what is not a height. If the block is turned, its corners are rounded, and so is the
plane through them: whether a body crosses it within this rounding is left to the block.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from satcheck.core.curved.signed import Outcome, Signed
from satcheck.core.half_space import (
    Height,
    Plane,
    heights_of_points,
    heights_of_shape,
    plane_of,
)
from satcheck.core.shape_mesh import mesh_of
from satcheck.core.shapes import HalfSpace

if TYPE_CHECKING:
    from collections.abc import Callable

    from satcheck.audit.draft import Draft
    from satcheck.audit.pair import Pair
    from satcheck.core.conventions import Vector
    from satcheck.core.transform import Transform
    from satcheck.report.report import Relation

STAGE = "half-space"


class Above(Struct, frozen=True):
    """A body over the plane of a half space. low, high: its least and its greatest height. slack:
    how far the plane of the placed block is off; 0.0: it is exact. floor_is_a: the half space is
    body A."""

    plane: Plane
    low: Height
    high: Height
    slack: float
    floor_is_a: bool

    def signed(self) -> Signed:
        """The signed distance of the pair."""
        value, side = self.low.value, self.side
        lower, upper = (math.nextafter(value + s * self.slack, s * math.inf) for s in (-1, 1))
        if self.slack == 0.0 and self.low.compare(value) == 0:
            lower = upper = value
        outcome: Outcome = "touching" if not side else "separated" if side > 0 else "penetrating"
        up = self.plane.unit
        x, y, z = self.low.point
        foot: Vector = (x - value * up[0], y - value * up[1], z - value * up[2])
        # From A to B, with distance * normal = witness_b - witness_a.
        signed = Signed(value, lower, upper, up, foot, (x, y, z), outcome, exact=self.decides)
        return signed if self.floor_is_a else signed.swapped()

    @property
    def side(self) -> int:
        """The sign of the signed distance; 0: it may also be within the slack."""
        if self.low.compare(self.slack) > 0:
            return 1
        return -1 if self.low.compare(-self.slack) < 0 else 0

    def compare(self, length: float) -> int:
        """The exact sign of (signed distance - length), from the plane itself."""
        return self.low.compare(length)

    @property
    def decides(self) -> bool:
        """Return whether the height proves the relation of the pair with the block."""
        return self.slack == 0.0 or self.side != 0


def above(pair: Pair) -> Above:
    """The height of the body that is not the half space."""
    floor_is_a = isinstance(pair.a.body.shape, HalfSpace)
    floor, other = (pair.a, pair.b) if floor_is_a else (pair.b, pair.a)
    assert isinstance(floor.body.shape, HalfSpace)
    plane, slack = _plane(floor.body.transform, floor.body.shape)
    if other.curved is not None:
        low, high = heights_of_shape(plane, other.curved.image)
    else:
        low, high = heights_of_points(plane, np.asarray(other.mesh.vertices))
    return Above(plane, low, high, slack, floor_is_a)


def settle_half_space(draft: Draft, by_block: Callable[[], None]) -> None:
    """Find how a body and a half space relate. by_block: finds it with the block instead. Of meshes
    that is needed in any case; of a curved shape only if the plane does not decide."""
    curved = draft.pair.curved
    if not curved:
        by_block()
    over = above(draft.pair)
    signed = over.signed()
    heights = f"least height {signed.distance:.6g}, greatest {over.high.value:.6g}"
    if not over.decides:
        draft.record(STAGE, "undecided", f"{heights}: within the rounding of the block")
        if curved:
            by_block()
        if draft.signed is not None or draft.exact != "indeterminate":
            draft.signed = signed
        return
    draft.record(STAGE, signed.outcome, heights)
    relation: Relation = "penetrating"
    if over.side >= 0:
        relation = "separated" if over.side else "touching"
    elif over.high.compare(-over.slack) < 0:
        relation = "contains" if over.floor_is_a else "inside"
    draft.found(relation, True, max(signed.lower, 0.0), signed, overlaps=over.side < 0)
    draft.point = over.low.point if relation == "touching" else None


@lru_cache(maxsize=64)
def _plane(transform: Transform | None, block: HalfSpace) -> tuple[Plane, float]:
    """The plane of a half space, and how far the triangles on top of its placed block are off: no
    farther than their corners."""
    plane, mesh = plane_of(transform), mesh_of(block)
    placed = mesh if transform is None else mesh.transformed(transform)
    top = np.asarray(placed.vertices)[np.asarray(mesh.vertices)[:, 2] == 0.0]
    low, high = heights_of_points(plane, top)
    off = max(-low.value, high.value)
    return plane, math.nextafter(off, math.inf) if low.p or high.p else 0.0
