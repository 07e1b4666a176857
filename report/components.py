"""The connected components of an overlap, as data of the report."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Length, Value, Vector

Passing = Literal["a-through-b", "b-through-a", "both", "none"]


class Component(Value, frozen=True, kw_only=True):
    """A connected component of what both bodies have in common.

    bounds: the least and the greatest corner, world frame. thickness_bounds: contain the diameter
    of the largest ball in it; None: not resolved. point: the centre of a ball as thick as their
    lower end; where that is 0, a point of its boundary. curves: along which the surfaces cross
    there, curve_length in all. volume, volume_error: as those of a finding; None: not asked for.
    passes: which body enters the other and leaves it there; None: undecided, where faces lie in
    each other for instance. resolved: false where a surface meets itself, so that this may be
    several, or a part of one.
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
    """items: the thickest first, by the upper end of their bounds. resolved: false where there may
    be others, or fewer: a surface meets itself, or is not closed."""

    items: tuple[Component, ...] = ()
    resolved: bool = True
