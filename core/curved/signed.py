"""The signed distance of curved shapes and convex bodies, with bounds for the true bodies.

The bounds of the signed distance, widened by the rounding error of the placement, decide: the
bodies are separated if the lower bound is above 0, and penetrate if the upper bound is below 0.
Otherwise they touch as far as float64 tells, and the answer is marked as not exact.
"""

from __future__ import annotations

import math
from typing import Literal

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core import PairResult, Shape, check_pair, compare_signed_distance
from satcheck.core.conventions import Vector
from satcheck.core.curved.placed import Body, Pose, is_convex

AT_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
ORIGIN: Vector = (0.0, 0.0, 0.0)

Outcome = Literal["separated", "touching", "penetrating", "undecided"]


class Signed(Struct, frozen=True):
    """A signed distance with bounds for the true bodies; fields as in core.PairResult.

    normal: None if an overlap is only known to be deep enough. exact: the outcome does not depend
    on the width of the bounds.
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


def signed(result: PairResult, slack: float) -> Signed | None:
    """result: of the solver. slack: rounding error of the placements. None: the solver could not
    close its bounds."""
    if result.outcome == "undecided" or result.distance is None:
        return None
    lower = (result.distance if result.lower is None else result.lower) - slack
    upper = (result.distance if result.upper is None else result.upper) + slack
    outcome: Outcome = "separated" if lower > 0 else "penetrating" if upper < 0 else "touching"
    if slack == 0.0:
        outcome = result.outcome
    exact = outcome != "touching" or lower == upper == 0.0
    return Signed(
        result.distance,
        lower,
        upper,
        result.normal,
        result.witness_a,
        result.witness_b,
        outcome,
        exact,
    )


def convex_pair(a: Body, b: Body, move: Vector = ORIGIN, enough: float = math.inf) -> Signed | None:
    """The signed distance of two bodies, each a curved shape or a convex mesh; A is translated by
    `move`. enough: if they are proven to overlap by more, that is all that is found."""
    (shape_a, pose_a, slack_a), (shape_b, pose_b, slack_b) = _placed(a, move), _placed(b, ORIGIN)
    slack = slack_a + slack_b
    result = check_pair(shape_a, shape_b, pose_a, pose_b, query="depth", enough=enough + slack)
    if result.outcome == "penetrating" and result.distance is None:
        upper = math.nextafter(-enough, -math.inf)
        return Signed(upper, -math.inf, upper, None, None, None, "penetrating", exact=True)
    return signed(result, slack)


def compare(a: Body, b: Body, length: float) -> int | None:
    """The exact sign of (signed distance - length). None if a shape is not a sphere or a capsule,
    if placing a shape was rounded, or if a mesh is not convex."""
    if not (is_convex(a) and is_convex(b)):
        return None
    (shape_a, pose_a, slack_a), (shape_b, pose_b, slack_b) = _placed(a, ORIGIN), _placed(b, ORIGIN)
    if slack_a or slack_b:
        return None
    return compare_signed_distance(shape_a, shape_b, length, pose_a, pose_b)


def _placed(body: Body, move: Vector) -> tuple[Shape, Pose, float]:
    if body.curved is None:
        return body.hull_shape(), (*move, *AT_ORIGIN[3:]), 0.0
    curved = body.curved.moved(move)
    return curved.shape, curved.pose, curved.slack
