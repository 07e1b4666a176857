"""A cover of the translations that are shorter than the depth, by the search for the depth."""

from __future__ import annotations

from satcheck import core
from satcheck.report.certificate import Cover, OverlapSet, Polytope, Region
from satcheck.verify.depth import MOST_PARTS, MOST_SETS


def cover(a: core.Surface, b: core.Surface, depth: float, work: int) -> Cover | None:
    """None: the search finds none by regions inside two solids. work: steps that it may take."""
    if depth <= 0:
        return None
    search = core.search_depth(a, b, upper=depth, lower=0.0, width=0.0, work=work, prove=True)
    proof = search.proof
    if proof is None or len(proof.parts) > MOST_PARTS or len(proof.sets) > MOST_SETS:
        return None
    return Cover(proof.origin, proof.half, tuple(map(_set, proof.sets)), tuple(proof.parts))


def _set(overlap: core.OverlapSet) -> OverlapSet:
    facets = tuple((p, q, r) for p, q, r in overlap.facets)
    difference = Polytope(tuple(overlap.corners), facets)
    return OverlapSet(_region(overlap.a), _region(overlap.b), difference)


def _region(region: core.InnerRegion) -> Region:
    return Region(tuple(region.vertices), tuple(region.normals))
