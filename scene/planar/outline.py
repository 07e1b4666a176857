"""Polygons that a scene file states as the shapes of bodies, for checks in a plane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from msgspec import Meta, Struct, ValidationError, convert
from msgspec.structs import force_setattr

from satcheck.core import Mesh
from satcheck.core.shapes import Primitive
from satcheck.scene.table import Number

if TYPE_CHECKING:
    from satcheck.scene.planar.region import Floats

Point = tuple[Number, Number]
Points = Annotated[tuple[Point, ...], Meta(min_length=3, extra_json_schema={"uniqueItems": True})]


class Outline(Struct, frozen=True, forbid_unknown_fields=True, tag_field="type", tag="outline"):
    """A polygon in the plane z = 0 around one region, whose edges do not meet; else raises
    ValueError.

    points: Its corners in the order of its edges; checked with --planar xy. Whatever order is
        given, it is stored counter-clockwise from the least one, so that it changes no answer.
    """

    points: Points

    def __post_init__(self) -> None:
        # No negative zeros.
        force_setattr(self, "points", tuple((x + 0.0, y + 0.0) for x, y in self.points))
        first: dict[tuple[float, float], int] = {}
        for k, point in enumerate(self.points):
            if (other := first.setdefault(point, k)) != k:
                raise ValueError(f"points[{k}] repeats points[{other}]: state each corner once")
        _refuse_crossing(self.points)
        force_setattr(self, "points", _in_order(self.points))

    def mesh(self) -> Mesh:
        """A sheet that covers the polygon. No corner is added, moved or left out."""
        import numpy as np

        from satcheck.scene.files.polygons import triangles_of
        from satcheck.scene.planar.region import turns

        corners, count = _floats(self.points), len(self.points)
        vertices = np.column_stack((corners, np.zeros(count)))
        triangles = triangles_of(vertices, range(count), [count])
        if not (turns(corners, triangles) > 0).all():
            raise ValueError("the outline is too thin to be cut into triangles")
        return Mesh(vertices, triangles.astype(np.uint32))


Shape = Primitive | Outline


def shape_from(values: object) -> Shape:
    """The shape that a report states. Raises ValueError."""
    try:
        return convert(values, Shape)  # type: ignore[no-any-return]
    except ValidationError as error:
        raise ValueError(str(error)) from None


def _refuse_crossing(points: tuple[Point, ...]) -> None:
    """Raises ValueError if all points lie on a line, or if two edges have a common point that is no
    common corner. Exact."""
    import numpy as np

    from satcheck.scene.planar.region import fan_of, turns

    corners, count = _floats(points), len(points)
    if not turns(corners, fan_of(count)).any():
        raise ValueError("the outline has no area: its points lie on a line")
    ends = np.roll(corners, -1, axis=0)
    low, high = np.minimum(corners, ends), np.maximum(corners, ends)
    for k in range(count - 2):
        rest = slice(k + 2, count - (k == 0))  # without the neighbours of edge k
        meets = (low[rest] <= high[k]).all(axis=1) & (high[rest] >= low[k]).all(axis=1)
        first = np.flatnonzero(meets) + k + 2
        if not len(first):
            continue
        last = (first + 1) % count
        start, end = np.full_like(first, k), np.full_like(first, k + 1)
        sides = [(start, end, first), (start, end, last), (first, last, start), (first, last, end)]
        a, b, c, d = turns(corners, np.hstack(sides).T).reshape(4, -1)
        # The ends of either edge lie on different sides of the other one, or on it.
        common = first[(a * b <= 0) & (c * d <= 0)]
        if len(common):
            message = f"the edges from points[{k}] and points[{common[0]}] cross or touch"
            raise ValueError(f"{message}: an outline runs around one region")


def _in_order(points: tuple[Point, ...]) -> tuple[Point, ...]:
    """The corners as `Outline` has them."""
    from satcheck.scene.planar.region import fan_of, turns

    least = points.index(min(points))
    start, *others = points[least:] + points[:least]
    # At the least corner a polygon is convex. Where it is straight, it has folded back: it crosses.
    if turns(_floats((others[-1], start, others[0])), fan_of(3))[0] < 0:
        others.reverse()
    return (start, *others)


def _floats(points: tuple[Point, ...]) -> Floats:
    import numpy as np

    return np.array(points, dtype=np.float64)
