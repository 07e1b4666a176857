"""Where two surfaces meet, as data of the report."""

from __future__ import annotations

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
