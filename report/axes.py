"""The candidate axes of the separating axis theorem for two bodies, with both shadows on each."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from satcheck.report.values import Count, Length, Tool, Value, Vector

AxisKind = Literal["face-a", "face-b", "edge-edge", "edge-a", "edge-b"]
AxisState = Literal["gap", "touch", "overlap", "unknown"]
HullRelation = Literal["separated", "touching", "penetrating", "indeterminate"]
# From 1, in the order of testing.
Place = Annotated[int, Meta(ge=1)]
# The least and the greatest coordinate along an axis.
Shadow = tuple[float, float]


class AxesBody(Value, frozen=True):
    """convex: the body is its own hull, or its outline is. faces, edges: of the hull, where faces
    that are flat within the precision of the file are one; in a plane, edges of the outline."""

    id: str
    file: str
    convex: bool
    vertices: Count
    faces: Count
    edges: Count


class CandidateAxis(Value, frozen=True):
    """number: its place in the order of testing: faces of A, faces of B, pairs of edges.

    kind: what the axis comes from: a face normal, or the cross product of two edges; in a plane an
    edge normal. index_a, index_b: the number of that face or edge; null: none of this body.
    candidates: how many faces and pairs of edges have this axis, because they are parallel within
    the precision of the files; 0: only edges that are parallel or within a face, up to that.
    direction: unit, from A to B. shadow_a, shadow_b: of the bodies, as world coordinates along it.
    gap: between the shadows, negative where they overlap, by how much.
    gap_bounds: proven bounds of it. state: the sign of the gap, proven by exact arithmetic where
    float64 does not decide; unknown where curves became polygons and the sign hangs on that.
    """

    number: Place
    kind: AxisKind
    index_a: Count | None
    index_b: Count | None
    candidates: Count
    direction: Vector
    shadow_a: Shadow
    shadow_b: Shadow
    gap: float
    gap_bounds: tuple[float, float]
    state: AxisState


class AxisCounts(Value, frozen=True):
    """candidates: faces of A and of B and all pairs of edges; in a plane all edges.

    edge_pairs: how many of these are pairs of edges. facet_pairs: pairs of edges that can make a
    face of the Minkowski difference (their arcs on the Gauss map may cross); no other pair can be
    needed. directions: how many candidates differ in direction within their kind: face normals
    of A, of B, and pairs of edge directions; for two boxes 3, 3 and 9. distinct: axes that differ
    in direction, among the faces and the facet_pairs.
    """

    candidates: Count
    edge_pairs: Count
    facet_pairs: Count
    directions: tuple[Count, Count, Count]
    distinct: Count


class EarlyOut(Value, frozen=True):
    """A test for overlap stops at the first axis with a gap. tested: axes up to there, all of them
    if no axis has a gap. not_needed: those after it. axis: the number of the first axis with a
    gap."""

    tested: Count
    not_needed: Count
    axis: Place | None


class AxesWinner(Value, frozen=True):
    """kind: separating: the axis with the largest gap. touching: the first axis on which the
    shadows only touch; no axis has a gap. mtv: the axis with the smallest overlap. length: that gap
    or overlap. mtv: the translation of A along the axis that ends the overlap."""

    kind: Literal["separating", "touching", "mtv"]
    axis: Place
    length: Length
    mtv: Vector | None


class AxesReport(Value, frozen=True, kw_only=True):
    """Lengths in `units`, null if the files state none.

    of: what the axes are about: bodies (both are convex, so the answer is theirs) or hulls (a gap
    separates the bodies, too; an overlap is one of the hulls only). relation, distance: of them,
    by the check of convex pairs; the distance is negative for a depth. It may exceed the largest
    gap, because between two corners the nearest way is no candidate axis. Null in a plane.
    tolerance: up to this gap or depth a check says touching; axes use none. gjk_steps: how many
    steps GJK and EPA take to the same answer, one support point each; null in a plane.
    axes: the largest gap first, then the smallest overlap. left_out: how many --top leaves out.
    """

    schema: Literal["satcheck.axes/1"] = "satcheck.axes/1"
    tool: Tool
    units: str | None
    planar: Literal["xy", "yz", "xz"] | None
    of: Literal["bodies", "hulls"]
    a: AxesBody
    b: AxesBody
    relation: HullRelation
    distance: float | None
    tolerance: Length
    gjk_steps: Count | None
    counts: AxisCounts
    early_out: EarlyOut
    winner: AxesWinner | None
    axes: tuple[CandidateAxis, ...]
    left_out: Count

    @property
    def in_band(self) -> bool:
        """Whether a check says touching, and the axes do not."""
        winner = self.winner
        return winner is not None and 0 < winner.length <= self.tolerance
