"""The contacts of two surfaces in a report."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from satcheck.report.values import Count, Length, Value, Vector


class Curve(Value, frozen=True):
    """A polyline along which the surfaces cross or touch.

    A closed one does not repeat its start. Curves do not branch. Where several meet, each of them
    ends.
    """

    points: Annotated[tuple[Vector, ...], Meta(min_length=2)]
    closed: bool
    length: Length


class Patch(Value, frozen=True):
    """A flat polygon in which faces of both surfaces lie.

    outlines: the outer one first, then its holes; counter-clockwise about `normal`, the unit normal
    of A's face. opposed: the surfaces face each other, as if one body stands on the other;
    otherwise both bodies lie on the same side of the patch.
    """

    outlines: Annotated[
        tuple[Annotated[tuple[Vector, ...], Meta(min_length=3)], ...], Meta(min_length=1)
    ]
    normal: Vector
    opposed: bool
    area: Length


class ContactTotals(Value, frozen=True):
    """Totals of all contacts, including those that are not listed."""

    curves: Count = 0
    length: Length = 0.0
    patches: Count = 0
    area: Length = 0.0
    points: Count = 0
    triangle_pairs: Count = 0


class Contacts(Value, frozen=True):
    """The common points of two surfaces: curves by decreasing length, patches by decreasing area,
    points. Points are exact intersections, each coordinate rounded once.

    No contact is in two lists. triangle_pairs: a triangle of A and one of B with a common point.
    Triangles are numbered from 0, sorted by their corners (x, y, z), each starting at its least
    corner. truncated: the smallest curves and patches, or the last points and pairs, are not
    listed, because the lists hold at most settings.contact_points points. The totals count all.
    """

    curves: tuple[Curve, ...] = ()
    patches: tuple[Patch, ...] = ()
    points: tuple[Vector, ...] = ()
    triangle_pairs: tuple[tuple[Count, Count], ...] = ()
    totals: ContactTotals = ContactTotals()
    truncated: bool = False
