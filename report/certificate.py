"""The certificate of a finding: evidence that `satcheck verify` checks.

Exact numbers are JSON numbers, or "numerator/denominator" if no float64 is exact. Vertices and
triangles of a mesh are numbered from 0. A key that is not needed is left out.
"""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, Meta, UnsetType

from satcheck.report.values import Count, Length, Value, Vector

# Longer numbers would take unbounded time.
Exact = float | Annotated[str, Meta(pattern="^-?[0-9]{1,4000}(/[0-9]{1,4000})?$")]
ExactVector = tuple[Exact, Exact, Exact]
Indices = tuple[Count, Count]


class OnBody(Value, frozen=True):
    """A point of a body. For a mesh: weights of sum 1 on the corners of one triangle, or on any
    vertices of a convex body. For a curved shape: a point in world coordinates."""

    vertices: tuple[Count, ...] | UnsetType = UNSET
    weights: tuple[Exact, ...] | UnsetType = UNSET
    point: ExactVector | UnsetType = UNSET


class Ends(Value, frozen=True):
    """A point of each body."""

    a: OnBody
    b: OnBody


class Polytope(Value, frozen=True):
    """vertices: pairs of vertices of A and B, for their differences. faces: outward."""

    vertices: tuple[Indices, ...]
    faces: tuple[tuple[Count, Count, Count], ...]


class AxisProof(Value, frozen=True, tag_field="kind", tag="axis"):
    """The axis, from A to B, separates the bodies. contact: a common point."""

    axis: ExactVector
    contact: Ends | UnsetType = UNSET


class SurfacesProof(Value, frozen=True, tag_field="kind", tag="surfaces"):
    """For meshes: the checker decides all close pairs of triangles again. triangles: one of A and
    one of B that meet, beside which an overlap is looked for first."""

    triangles: Indices | UnsetType = UNSET


class PointProof(Value, frozen=True, tag_field="kind", tag="point"):
    """For a pair with a curved shape: a point inside one body that belongs to the other, an axis
    along which A reaches at least as far as B, and an axis along which B reaches at least as far as
    A."""

    both: Ends
    a_reaches: ExactVector
    b_reaches: ExactVector


class PolytopeProof(Value, frozen=True, tag_field="kind", tag="polytope"):
    """For convex bodies: vertex differences around the origin, an axis along which A reaches at
    least as far as B, and an axis along which B reaches at least as far as A."""

    vertices: tuple[Indices, ...]
    faces: tuple[tuple[Count, Count, Count], ...]
    a_reaches: ExactVector
    b_reaches: ExactVector


class NestedProof(Value, frozen=True, tag_field="kind", tag="nested"):
    """For a curved shape and a convex body, one inside the other. The checker computes this
    again."""


Proof = AxisProof | SurfacesProof | PointProof | PolytopeProof | NestedProof


class DepthProof(Value, frozen=True):
    """For convex bodies: a polytope that contains a ball of the lower bound, and an axis along
    which a translation of the upper bound frees A."""

    lower: Polytope
    upper: ExactVector


class Region(Value, frozen=True):
    """The hull of points inside a solid, in world coordinates minus an origin. Each triangle of the
    surface is at least as far along one of the normals as all of them."""

    vertices: tuple[Vector, ...]
    normals: tuple[Vector, ...]


class OverlapSet(Value, frozen=True):
    """Translations of A after which regions of both bodies overlap. difference: its vertices are
    pairs of a vertex of the region of A and one of B, for the second minus the first."""

    a: Region
    b: Region
    difference: Polytope


class Cover(Value, frozen=True):
    """For solids of which one is not convex: a cube around all translations of A that are shorter
    than the lower bound of the depth, in parts. half: of its edge.

    parts: as a tree from the cube on. -1: two halves, across the longest edge (x before y before
    z), the lower one first. -2: no translation in it is shorter. Else: the number of a set that
    holds all shorter ones.
    """

    origin: Vector
    half: Length
    sets: tuple[OverlapSet, ...]
    parts: tuple[Annotated[int, Meta(ge=-2)], ...]


class Face(Value, frozen=True, tag_field="kind", tag="face"):
    """A triangle, or several triangles that lie nearly in one plane and together form a convex
    polygon."""

    body: Literal["a", "b"]
    triangles: tuple[Count, ...]


class Plane(Value, frozen=True, tag_field="kind", tag="plane"):
    """The plane normal . x = height. No point of the body within `reach` of a cell that the plane
    bounds lies beyond it; without a reach, no point at all. Coordinates are those of the cells."""

    body: Literal["a", "b"]
    normal: Vector
    height: float
    reach: Length | UnsetType = UNSET


# Numbers of patches, each with its weight. Only the ratios of the weights count.
Weighted = tuple[tuple[Count, Length], ...]


class Cells(Value, frozen=True):
    """For solids: a partition of a box that contains their whole overlap, as a tree from its root
    on. Coordinates are world coordinates minus the origin.

    cells: 0, 1, 2: cut across that axis at the next number of `at`. 3: cut by the next of `cuts`, a
    normal and a height; the side with normal . x <= height comes first. 4: outside of A. 5: outside
    of B. 6: bounded by the next of `sums`: a weighted sum of distances from patches.
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
    """A ball in the world that lies within a body."""

    centre: Vector
    radius: Length


class Excuse(Value, frozen=True):
    """For solids: the proof that surfaces that may be off explain their overlap. a, b: balls that
    prove that each body is thicker than its surface may be off. cells: prove that no point lies
    deeper than that in both. The checker decides again that no body passes through the other."""

    a: InnerBall
    b: InnerBall
    cells: Cells


class Band(Value, frozen=True):
    """The proof that an overlap is within the touch band: an axis across it; a translation that
    frees A, with its proof; or surfaces that may be off."""

    axis: ExactVector | UnsetType = UNSET
    move: ExactVector | UnsetType = UNSET
    free: Proof | UnsetType = UNSET
    excuse: Excuse | UnsetType = UNSET


class Certificate(Value, frozen=True):
    """The evidence for a finding. Each part proves one statement.

    relation: proves exact_relation. mtv: proves that A, moved by mtv, has no common interior with
    B. depth: for convex bodies. distance: for convex meshes, a point of each, as far apart as they
    are; of other meshes the checker looks again at all triangles that could be nearer. cover:
    proves the lower end of a concave depth. thickness: proves the upper end of the thickness; a
    ball proves the lower end. gap: points of separated convex bodies that are close enough to be
    touching or near. band: proves that an overlap counts as touching.
    """

    relation: Proof
    mtv: Proof | UnsetType = UNSET
    depth: DepthProof | UnsetType = UNSET
    distance: Ends | UnsetType = UNSET
    cover: Cover | UnsetType = UNSET
    thickness: Cells | UnsetType = UNSET
    gap: Ends | UnsetType = UNSET
    band: Band | UnsetType = UNSET
