"""The health of a mesh, as its inspection finds it."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, Struct

Count = Annotated[int, Meta(ge=0)]


class MeshHealth(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The result of the inspection of a mesh. Edges are counted where triangles meet.

    cracks: gaps between faces no wider than the precision of the file; they are closed. holes:
    loops of the boundary that remain, and parts that may be solid or cavities. largest_hole:
    diagonal of the box around the largest of these, file units; 0 without them. closed: every edge
    has an even number of triangles, once cracks are closed. manifold: exactly two. oriented: all
    triangles agree on which side is outside. volume: signed, file units cubed. inside_out: some
    parts faced inward and were turned. double_sided: each face exists in both orientations. flat:
    all vertices in one plane. solid: after the repair, inside and outside are defined, and the
    inside is not empty.
    """

    vertices: Count
    triangles: Count
    components: Count
    boundary_edges: Count
    nonmanifold_edges: Count
    misoriented_edges: Count
    degenerate_triangles: Count
    duplicate_triangles: Count
    cracks: Count
    holes: Count
    largest_hole: Annotated[float, Meta(ge=0)]
    closed: bool
    manifold: bool
    oriented: bool
    volume: float
    inside_out: bool
    double_sided: bool
    flat: bool
    solid: bool

    @property
    def doubtful(self) -> bool:
        """Return whether parts of a closed mesh may be solid or cavities: what looks like holes."""
        return bool(self.closed and self.oriented and self.holes)

    @property
    def plain_solid(self) -> bool:
        """Return whether the mesh is one shell that was closed and wound outward as read."""
        is_closed = self.closed and not self.cracks
        is_one = self.components == 1 and self.manifold and self.oriented
        return is_closed and is_one and self.volume > 0
