"""The certificate of a finding: evidence that `satcheck verify` checks.

Exact numbers are JSON numbers, or "numerator/denominator" where no float64 is exact. Vertices and
triangles of a mesh are numbered from 0. A key that is not needed is left out.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, Meta, UnsetType

from satcheck.report.values import Count, Length, Value, Vector

Exact = float | Annotated[str, Meta(pattern="^-?[0-9]+(/[0-9]+)?$")]
ExactVector = tuple[Exact, Exact, Exact]
Indices = tuple[Count, Count]


class OnBody(Value, frozen=True):
    """A point of a body. Of a mesh: weights, of sum 1, on corners of one triangle, or on any
    vertices of a convex body. Of a curved shape: a point in world coordinates."""

    vertices: tuple[Count, ...] | UnsetType = UNSET
    weights: tuple[Exact, ...] | UnsetType = UNSET
    point: ExactVector | UnsetType = UNSET


class Ends(Value, frozen=True):
    """A point of each body."""

    a: OnBody
    b: OnBody


# Coordinates, or, where one body is an open surface, a point of that.
Point = ExactVector | OnBody


class Polytope(Value, frozen=True):
    """vertices: pairs of vertices of A and B, for their differences. faces: outward."""

    vertices: tuple[Indices, ...]
    faces: tuple[tuple[Count, Count, Count], ...]


class AxisProof(Value, frozen=True, tag_field="kind", tag="axis"):
    """The axis, from A to B, separates the bodies. contact: a point that both have."""

    axis: ExactVector
    contact: Ends | UnsetType = UNSET


class SurfacesProof(Value, frozen=True, tag_field="kind", tag="surfaces"):
    """All close pairs of triangles are decided again. contact: a point that both boundaries have.
    both: a point inside both bodies."""

    contact: Ends | UnsetType = UNSET
    both: Point | UnsetType = UNSET


class OverlapProof(Value, frozen=True, tag_field="kind", tag="overlap"):
    """A point inside both bodies, and one inside each alone; or one inside one of them alone, and
    one where both end."""

    both: Point
    a_alone: Point | UnsetType = UNSET
    b_alone: Point | UnsetType = UNSET
    meet: Ends | UnsetType = UNSET


class PointProof(Value, frozen=True, tag_field="kind", tag="point"):
    """Of a curved shape: a point inside one body and of the other, and axes along which A, and B,
    reaches at least as far as the other."""

    both: Ends
    a_reaches: ExactVector
    b_reaches: ExactVector


class PolytopeProof(Value, frozen=True, tag_field="kind", tag="polytope"):
    """Of convex bodies: vertex differences around the origin, and axes along which A, and B,
    reaches at least as far as the other."""

    vertices: tuple[Indices, ...]
    faces: tuple[tuple[Count, Count, Count], ...]
    a_reaches: ExactVector
    b_reaches: ExactVector


class CrossingProof(Value, frozen=True, tag_field="kind", tag="crossing"):
    """Of open surfaces: a triangle of A and one of B that pass through each other."""

    triangles: Indices


class SameProof(Value, frozen=True, tag_field="kind", tag="same"):
    """The surfaces are compared. both: a point inside both bodies."""

    both: Point | UnsetType = UNSET


class NestedProof(Value, frozen=True, tag_field="kind", tag="nested"):
    """Of a curved shape and a convex body: one lies inside the other, which is computed again."""


Proof = (
    AxisProof
    | SurfacesProof
    | OverlapProof
    | PointProof
    | PolytopeProof
    | CrossingProof
    | SameProof
    | NestedProof
)


class DepthProof(Value, frozen=True):
    """Of convex bodies: a polytope that holds a ball of the lower bound, and an axis along which A
    leaves B within the upper one."""

    lower: Polytope
    upper: ExactVector


class Cover(Value, frozen=True):
    """Of solids of which one is not convex: cubes that cover the translations of A shorter than the
    lower bound of the depth, an octree from its root on. Cubes outside of the ball are left out.

    cubes: -1: eight children, x changing first; else the number of a pair of triangles, one of A
    and one of B, that cross for every translation of the cube.
    """

    pairs: tuple[Indices, ...]
    cubes: tuple[Annotated[int, Meta(ge=-1)], ...]


class Face(Value, frozen=True, tag_field="kind", tag="face"):
    """A triangle, or more that lie in one plane, about, and together are a convex polygon."""

    body: Literal["a", "b"]
    triangles: tuple[Count, ...]


class Plane(Value, frozen=True, tag_field="kind", tag="plane"):
    """normal . x = height: within `reach` of each cell that it bounds, nothing of the body lies
    beyond it; where there is no reach, nowhere. Coordinates are those of the cells."""

    body: Literal["a", "b"]
    normal: Vector
    height: float
    reach: Length | UnsetType = UNSET


# Numbers of patches, each with its weight; the weights stand for their shares.
Weighted = tuple[tuple[Count, Length], ...]


class Cells(Value, frozen=True):
    """Of solids: a partition of the box that holds all that they can share, a tree from its root
    on. Coordinates are those of the world less the origin.

    cells: 0, 1, 2: halved across that axis, at the next number of `at`. 3: cut by the next of
    `cuts`, a normal and a height; the side with normal . x <= height comes first. 4: outside of A.
    5: outside of B. 6: bounded by the next of `sums`: a weighted sum of distances from patches.
    """

    origin: Vector
    low: Vector
    high: Vector
    patches: tuple[Face | Plane, ...]
    cells: tuple[Annotated[int, Meta(ge=0, le=6)], ...]
    at: tuple[float, ...]
    cuts: tuple[tuple[Vector, float], ...]
    sums: tuple[Weighted, ...]


class InnerBall(Value, frozen=True):
    """World: it lies within a body."""

    centre: Vector
    radius: Length


class Excuse(Value, frozen=True):
    """Of solids: why surfaces that may be off explain their overlap. a, b: each is thicker than its
    surface may be off. cells: no point lies deeper than that in both. That neither passes through
    the other is decided again."""

    a: InnerBall
    b: InnerBall
    cells: Cells


class Band(Value, frozen=True):
    """Why an overlap is within the touch band: an axis across it; a move that frees A, and the
    proof of that; or surfaces that may be off."""

    axis: ExactVector | UnsetType = UNSET
    move: ExactVector | UnsetType = UNSET
    free: Proof | UnsetType = UNSET
    excuse: Excuse | UnsetType = UNSET


class Certificate(Value, frozen=True):
    """One part for each thing that the finding says.

    relation: proves exact_relation. mtv: proves that A, moved by mtv, has no common interior with
    B. depth: of convex bodies. distance: of meshes of which one is not convex, a point of either
    boundary, as far apart as the bodies; all triangles that could be nearer are looked at again.
    cover: of the lower end of a concave depth. thickness: of its upper end; a ball shows the lower
    one. gap: points that show how close separated bodies
    are, where that makes them touching or near. band: of an overlap that is called touching.
    """

    relation: Proof
    mtv: Proof | UnsetType = UNSET
    depth: DepthProof | UnsetType = UNSET
    distance: Ends | UnsetType = UNSET
    cover: Cover | UnsetType = UNSET
    thickness: Cells | UnsetType = UNSET
    gap: Ends | UnsetType = UNSET
    band: Band | UnsetType = UNSET
