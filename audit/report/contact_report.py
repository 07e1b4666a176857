"""Where two surfaces meet, as data of the report."""

from __future__ import annotations

from typing import Any

from msgspec import Struct

Vector = tuple[float, float, float]


class Curve(Struct, frozen=True):
    """A polyline along which the surfaces cross or touch; a closed one does not repeat its start.

    It does not branch: curves that meet end there.
    """

    points: tuple[Vector, ...]
    closed: bool
    length: float


class Patch(Struct, frozen=True):
    """A flat polygon in which faces of both surfaces lie.

    outlines: the outer one first, then its holes; counter-clockwise about `normal`, the unit normal
    of A's face. opposed: the surfaces face each other, as two bodies do that stand on each other;
    otherwise both bodies lie on the same side of the patch.
    """

    outlines: tuple[tuple[Vector, ...], ...]
    normal: Vector
    opposed: bool
    area: float


class ContactTotals(Struct, frozen=True):
    """Everything there is, listed or not."""

    curves: int = 0
    length: float = 0.0
    patches: int = 0
    area: float = 0.0
    points: int = 0
    triangle_pairs: int = 0


class Contacts(Struct, frozen=True):
    """The common points of two surfaces: curves by falling length, patches by falling area, points.

    triangle_pairs: a triangle of A and one of B that have a common point, by their numbers.
    truncated: the smallest curves and patches, or the last points and pairs, were left out of the
    lists; totals count them all.
    """

    curves: tuple[Curve, ...] = ()
    patches: tuple[Patch, ...] = ()
    points: tuple[Vector, ...] = ()
    triangle_pairs: tuple[tuple[int, int], ...] = ()
    totals: ContactTotals = ContactTotals()
    truncated: bool = False

    def to_dict(self) -> dict[str, Any]:
        """JSON values in the fixed key order of the schema."""
        totals = self.totals
        return {
            "curves": [
                {
                    "points": [_plain(p) for p in curve.points],
                    "closed": curve.closed,
                    "length": curve.length,
                }
                for curve in self.curves
            ],
            "patches": [
                {
                    "outlines": [[_plain(p) for p in outline] for outline in patch.outlines],
                    "normal": _plain(patch.normal),
                    "opposed": patch.opposed,
                    "area": patch.area,
                }
                for patch in self.patches
            ],
            "points": [_plain(p) for p in self.points],
            "triangle_pairs": [list(pair) for pair in self.triangle_pairs],
            "totals": {
                "curves": totals.curves,
                "length": totals.length,
                "patches": totals.patches,
                "area": totals.area,
                "points": totals.points,
                "triangle_pairs": totals.triangle_pairs,
            },
            "truncated": self.truncated,
        }


def _plain(vector: Vector) -> list[float]:
    """Without negative zeros."""
    return [c + 0.0 for c in vector]
