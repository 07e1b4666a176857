"""Why an overlap is no thicker: the cells of the search, as a certificate has them.

The checker proves in rationals what they show (`satcheck.verify.thickness`).
"""

from __future__ import annotations

import math
from typing import Literal

from msgspec import UNSET

from satcheck import core
from satcheck.report.certificate import Cells, Face, Plane
from satcheck.verify.partition import MOST_CELLS

BODIES: tuple[Literal["a"], Literal["b"]] = ("a", "b")


def cells(proof: core.ThicknessProof) -> Cells | None:
    """None: there are too many."""
    if len(proof.cells) > MOST_CELLS:
        return None
    return Cells(
        proof.origin,
        proof.low,
        proof.high,
        tuple(map(_patch, proof.bounds)),
        tuple(proof.cells),
        tuple(proof.at),
        tuple(proof.cuts),
        tuple(map(tuple, proof.sums)),
    )


def _patch(bound: core.DepthBound) -> Face | Plane:
    body = BODIES[bound.body]
    if bound.triangles:
        return Face(body, tuple(bound.triangles))
    reach = bound.reach if math.isfinite(bound.reach) else UNSET
    return Plane(body, bound.normal, bound.height, reach)
