"""Where two surfaces meet, as data of the report."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from satcheck.report.values import Count, Length, Value, Vector


class Curve(Value, frozen=True):
    """A polyline along which the surfaces cross or touch; a closed one does not repeat its start.

    It does not branch: curves that meet end there.
    """

    points: Annotated[tuple[Vector, ...], Meta(min_length=2)]
    closed: bool
    length: Length


class Patch(Value, frozen=True):
    """A flat polygon in which faces of both surfaces lie.

    outlines: the outer one first, then its holes; counter-clockwise about `normal`, the unit normal
    of A's face. opposed: the surfaces face each other, as two bodies do that stand on each other;
    otherwise both bodies lie on the same side of the patch.
    """

    outlines: Annotated[
        tuple[Annotated[tuple[Vector, ...], Meta(min_length=3)], ...], Meta(min_length=1)
    ]
    normal: Vector
    opposed: bool
    area: Length


class ContactTotals(Value, frozen=True):
    """Everything there is, listed or not."""

    curves: Count = 0
    length: Length = 0.0
    patches: Count = 0
    area: Length = 0.0
    points: Count = 0
    triangle_pairs: Count = 0


class Contacts(Value, frozen=True):
    """The common points of two surfaces: curves by falling length, patches by falling area, points.
    Points are exact intersections, each coordinate rounded once. Nothing is in two lists.

    triangle_pairs: a triangle of A and one of B that have a common point, numbered from 0 in the
    order of their corners in the file: each triangle from its least corner on, by x, y, z.
    truncated: the smallest curves and patches, or the last points and pairs, were left out of the
    lists, which hold no more than settings.contact_points points; totals count them all.
    """

    curves: tuple[Curve, ...] = ()
    patches: tuple[Patch, ...] = ()
    points: tuple[Vector, ...] = ()
    triangle_pairs: tuple[tuple[Count, Count], ...] = ()
    totals: ContactTotals = ContactTotals()
    truncated: bool = False
