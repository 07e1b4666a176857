"""The connected components of an overlap in a report."""

from __future__ import annotations

from typing import Literal

from satcheck.report.values import Count, Interval, Length, Value, Vector

Passing = Literal["a-through-b", "b-through-a", "both", "none"]


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
