"""Where two bodies meet in a report: the contacts of their surfaces, and the connected components
of their overlap."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.values import Count, Interval, Length, Value, Vector

Passing = Literal["a-through-b", "b-through-a", "both", "none"]


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


class Component(Value, frozen=True, kw_only=True):
    """A connected component of the overlap of both bodies.

    bounds: the least and the greatest corner, world frame. thickness_bounds: contain the diameter
    of the largest ball in it; None: not resolved. point: the centre of a ball with the diameter of
    their lower end; if that is 0, a point of the boundary. curves: the curves along which the
    surfaces cross there; curve_length: their total length. volume, volume_error: as in a finding;
    None: not requested. passes: the body that enters the other and leaves it again; None:
    undecided, for example if faces coincide. resolved: false: a surface meets itself, so that this
    may be several components, or a part of one.
    """

    bounds: tuple[Vector, Vector]
    point: Vector
    thickness_bounds: Interval | None
    volume: Length | None = None
    volume_error: Length | None = None
    curves: Count
    curve_length: Length
    passes: Passing | None
    resolved: bool


class Components(Value, frozen=True):
    """items: the thickest first, by the upper end of their bounds. resolved: false: the number of
    components may differ, because a surface meets itself or is not closed."""

    items: tuple[Component, ...] = ()
    resolved: bool = True
