"""The signed distance of curved shapes and convex bodies, with bounds that hold for the bodies.

Bounds of a signed distance decide, widened by what placing a shape may have rounded: a gap above 0
separates, a penetration above 0 is one. Between the two the bodies touch as far as float64 tells,
and the answer says that it is not exact.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck import core

if TYPE_CHECKING:
    from satcheck.audit.bodies.placed_body import PlacedBody

Vector = tuple[float, float, float]
AT_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
ORIGIN: Vector = (0.0, 0.0, 0.0)

Outcome = Literal["separated", "touching", "penetrating", "undecided"]


class Signed(Struct, frozen=True):
    """A signed distance with bounds that hold for the bodies; fields as of core.PairResult.

    exact: the outcome does not hang on the width of the bounds.
    """

    distance: float
    lower: float
    upper: float
    normal: Vector | None
    witness_a: Vector | None
    witness_b: Vector | None
    outcome: Outcome
    exact: bool

    def swapped(self) -> Signed:
        normal = self.normal and (-self.normal[0], -self.normal[1], -self.normal[2])
        return replace(self, normal=normal, witness_a=self.witness_b, witness_b=self.witness_a)


def signed(found: core.PairResult, slack: float) -> Signed | None:
    """None when the solver could not close its bounds."""
    if found.outcome == "undecided" or found.distance is None:
        return None
    lower = (found.distance if found.lower is None else found.lower) - slack
    upper = (found.distance if found.upper is None else found.upper) + slack
    outcome: Outcome = "separated" if lower > 0 else "penetrating" if upper < 0 else "touching"
    if slack == 0.0:
        outcome = found.outcome
    exact = outcome != "touching" or lower == upper == 0.0
    return Signed(
        found.distance,
        lower,
        upper,
        found.normal,
        found.witness_a,
        found.witness_b,
        outcome,
        exact,
    )


def convex_pair(a: PlacedBody, b: PlacedBody, move: Vector = ORIGIN) -> Signed | None:
    """Two bodies of which each is a curved shape or a convex mesh, A moved by `move`."""
    (shape_a, pose_a, slack_a), (shape_b, pose_b, slack_b) = _placed(a, move), _placed(b, ORIGIN)
    found = core.check_pair(shape_a, shape_b, pose_a, pose_b, query="depth")
    return signed(found, slack_a + slack_b)


def compare(a: PlacedBody, b: PlacedBody, length: float) -> int | None:
    """The sign of (signed distance - length), exactly; None where a shape is not a ball around a
    point or a segment, was rounded when it was placed, or a mesh is not convex."""
    if not all(body.curved is not None or body.convex for body in (a, b)):
        return None
    (shape_a, pose_a, slack_a), (shape_b, pose_b, slack_b) = _placed(a, ORIGIN), _placed(b, ORIGIN)
    if slack_a or slack_b:
        return None
    return core.compare_signed_distance(shape_a, shape_b, length, pose_a, pose_b)


def _placed(body: PlacedBody, move: Vector) -> tuple[core.Shape, tuple[float, ...], float]:
    curved = body.curved
    if curved is None:
        return body.hull_shape(), (*move, *AT_ORIGIN[3:]), 0.0
    return curved.shape, curved.moved(move), curved.slack
