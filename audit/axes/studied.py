"""What the study of two hulls, or of two outlines, gives to the report."""

from __future__ import annotations

from msgspec import Struct

from satcheck.audit.axes.projected_axes import ProjectedAxes
from satcheck.core.errors import SatcheckError
from satcheck.report.axes import AxesBody, AxesWinner, AxisCounts, HullRelation

# Candidates that are compared in some seconds.
MOST_EDGE_PAIRS = 10_000_000
MOST_FACET_PAIRS = 250_000

_RELATIONS: dict[str, HullRelation] = {
    "separating": "separated",
    "touching": "touching",
    "mtv": "penetrating",
}


class Studied(Struct, frozen=True):
    """relation: by the check of convex pairs. distance: its figure; negative for a depth; None in a
    plane, as gjk_steps: how many steps GJK and EPA take."""

    a: AxesBody
    b: AxesBody
    counts: AxisCounts
    axes: ProjectedAxes
    relation: HullRelation
    distance: float | None = None
    gjk_steps: int | None = None

    def winner(self) -> AxesWinner | None:
        """None where no candidate axis shows the relation."""
        winner = self.axes.winner()
        return winner if winner and _RELATIONS[winner.kind] == self.relation else None


def relation_shown(axes: ProjectedAxes) -> HullRelation:
    """By the theorem, for solids and for outlines."""
    winner = axes.winner()
    return "indeterminate" if winner is None else _RELATIONS[winner.kind]


def require_few(a: AxesBody, b: AxesBody, count: int, limit: int, what: str) -> None:
    if count <= limit:
        return
    message = (
        f"the hulls of {a.id} ({a.faces:,} faces, {a.edges:,} edges) and {b.id} ({b.faces:,} "
        f"faces, {b.edges:,} edges) have {count:,} {what}, and axes compares {limit:,} at most. "
        "Their number is the product of the numbers of edges. A check asks GJK for a few support "
        "points instead: satcheck A B. For the axes, give meshes with fewer faces"
    )
    raise SatcheckError("too-many-axes", message)
