"""Open pieces around a body. Each is a sheet, but together they may be the wall of a solid.

Example: a box whose faces miss each other by more than the precision of the file has six open
parts. They count as six sheets, but the box may be meant as a solid.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.body import PlacedBody
from satcheck.audit.pair import Pair
from satcheck.scene.health import MOST_AROUND

if TYPE_CHECKING:
    from satcheck.core.conventions import Vector


def open_pieces_around(pair: Pair) -> str | None:
    """Why one of two bodies that do not meet may still lie in the other; None: neither does."""
    if pair.settings.allow_open:
        return None
    for outer, inner in ((pair.a, pair.b), (pair.b, pair.a)):
        if _is_in_pieces(outer) and _is_around(outer, _point_of(inner)):
            return (
                f"open pieces of {outer.id} surround {inner.id}: close them, or say with "
                "--allow-open that they are meant to be open"
            )
    return None


def _is_in_pieces(body: PlacedBody) -> bool:
    health = body.body.file.health
    return not (body.solid or health.closed or health.flat or body.curved)


def _point_of(body: PlacedBody) -> Vector:
    if body.curved is not None:
        return body.curved.centre
    return body.mesh.vertex(0)


def _is_around(body: PlacedBody, point: Vector) -> bool:
    low, high = body.bounds
    if not all(a <= c <= b for a, c, b in zip(low, point, high, strict=True)):
        return False
    return abs(body.surface().sheets_around(point)) > MOST_AROUND
