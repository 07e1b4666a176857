"""How a curved shape relates to a mesh that is not convex."""

from __future__ import annotations

import math
from typing import Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import Surface
from satcheck.core.conventions import Vector
from satcheck.core.curved.nesting import box_holds, shape_holds
from satcheck.core.curved.placed import Body, CurvedShape
from satcheck.core.curved.signed import Signed
from satcheck.core.curved.triangles import Nearest, against_triangles

Hole = tuple[int, int]  # (number from 0, count of holes)
# Points of the unit ball that are tried in order. If the centre lies on the surface, another point
# may not.
_TRIED: tuple[Vector, ...] = (
    (0.0, 0.0, 0.0),
    (0.37, 0.61, 0.53),
    (-0.59, 0.31, -0.47),
    (0.23, -0.71, 0.41),
)


class InMesh(Struct, frozen=True):
    """relation: of the shape to the mesh. proven: False: either only an overlap is proven, and
    containment is undecided, or a contact is undecided.

    crossed: the number of triangles that meet the inside of the shape. touched: a triangle that the
    shape touches from within the mesh. hole: if the relation is undecided, the hole whose fill
    decides; None: bounds did not close. signed: the signed distance, if known; the shape is A.
    gap_lower: a lower bound of the distance.
    """

    relation: Literal["separated", "touching", "penetrating", "contains", "inside", "undecided"]
    proven: bool = True
    crossed: int = 0
    touched: int | None = None
    hole: Hole | None = None
    signed: Signed | None = None
    gap_lower: float = 0.0


def relate(curved: CurvedShape, mesh: Body, seen: Nearest, reach: float) -> InMesh:
    """seen: the result of the shape against the triangles within reach."""
    ends = ends_crossed(mesh, seen)
    if ends:
        return _crossing(curved, mesh, len(ends))
    hole = hole_in_the_way(curved, mesh, _outcome(seen))
    winding = 0 if hole is not None else winding_within(curved, mesh)
    if winding:
        return _within(mesh, seen)
    if len(seen.crossed):
        return _crossing(curved, mesh, len(seen.crossed))
    if winding is None or seen.undecided or hole is not None:
        return InMesh("undecided", False, hole=hole)
    return _apart(curved, mesh, seen, reach)


def is_free(curved: CurvedShape, mesh: Body) -> bool:
    """Whether the shape and the mesh provably have no common interior."""
    seen = against_triangles(curved, mesh.mesh, 0.0)
    apart = seen.nearest is None or seen.nearest.outcome == "separated" or seen.nearest.lower >= 0
    if not apart or seen.undecided or hole_in_the_way(curved, mesh, _outcome(seen)) is not None:
        return False
    return winding_within(curved, mesh) == 0


def ends_crossed(mesh: Body, seen: Nearest) -> list[int]:
    """The triangles that meet the inside of the shape and bound the body. For a body with holes,
    all triangles count."""
    crossed: list[int] = seen.crossed.tolist()
    closed, hulls = mesh.surface().closed()
    return crossed if hulls else [k for k in crossed if closed.is_boundary(k)]


def _touched(seen: Nearest) -> tuple[int, ...]:
    """The triangles that the shape provably touches, if it enters none; else empty."""
    if seen.undecided or seen.nearest is None or not seen.nearest.exact:
        return ()
    return seen.touched


def _outcome(seen: Nearest) -> str:
    return "separated" if seen.nearest is None else seen.nearest.outcome


def hole_in_the_way(curved: CurvedShape, mesh: Body, outcome: str) -> Hole | None:
    """The hole of the mesh whose fill may overlap the shape, or touch a shape that the mesh does
    not touch; None: there is no such hole. outcome: of the triangles of the mesh."""
    _, hulls = mesh.surface().closed()
    for number, hull in enumerate(hulls):
        seen = against_triangles(curved, hull.mesh, 0.0)
        harmless = _outcome(seen) in ("separated", "touching" if outcome == "touching" else "")
        if seen.undecided or not harmless or _holds_middle(hull, curved):
            return number, len(hulls)
    return None


def _holds_middle(hull: Surface, curved: CurvedShape) -> bool:
    return hull.winding_number(curved.centre) != 0


def _within(mesh: Body, seen: Nearest) -> InMesh:
    """The result if a point inside the shape lies within the mesh, so that they overlap."""
    surface = mesh.surface()
    touched = next((k for k in _touched(seen) if surface.is_boundary(k)), None)
    if touched is not None:
        return InMesh("penetrating", touched=touched)
    proven = not seen.undecided and _outcome(seen) == "separated"
    return InMesh("inside" if proven else "penetrating", proven)


def _crossing(curved: CurvedShape, mesh: Body, triangles: int) -> InMesh:
    holds = box_holds(curved.bounds(), mesh.bounds) and shape_holds(curved, mesh)
    return InMesh("contains" if holds else "penetrating", holds is not None, crossed=triangles)


def _apart(curved: CurvedShape, mesh: Body, seen: Nearest, reach: float) -> InMesh:
    of_holes = _gap_of_holes(curved, mesh, reach)
    nearest = seen.nearest
    if nearest is None:
        return InMesh("separated", gap_lower=min(math.nextafter(reach, math.inf), of_holes))
    if nearest.outcome == "separated":
        nearest = replace(nearest, lower=min(nearest.lower, of_holes))
        return InMesh("separated", nearest.exact, signed=nearest, gap_lower=max(nearest.lower, 0.0))
    proven = bool(_touched(seen))
    return InMesh("touching", proven, signed=nearest, gap_lower=max(nearest.lower, 0.0))


def _gap_of_holes(curved: CurvedShape, mesh: Body, reach: float) -> float:
    """A lower bound of the distance of the shape from the fills of all holes; inf: no hole is
    within reach."""
    _, hulls = mesh.surface().closed()
    seen = [against_triangles(curved, hull.mesh, reach) for hull in hulls]
    if any(nearest.undecided for nearest in seen):
        return 0.0
    lower = [nearest.nearest.lower for nearest in seen if nearest.nearest is not None]
    return max(min(lower, default=math.inf), 0.0)


def winding_within(curved: CurvedShape, mesh: Body) -> int | None:
    """The winding number of the closed mesh about a point inside the shape. None: all tried points
    lie on the surface."""
    closed, _ = mesh.surface().closed()
    x, y, z = curved.centre
    step = 0.5 * curved.inner_radius
    for u, v, w in _TRIED:
        winding = closed.winding_number((x + step * u, y + step * v, z + step * w))
        if winding is not None:
            return winding
    return None
