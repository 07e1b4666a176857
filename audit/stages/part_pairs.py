"""The stage `part-pairs`: the convex parts of a pair, and which of them overlap. It runs only on
request, after the verdict, and changes nothing of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from heapq import nlargest

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.body import box_escape
from satcheck.audit.draft import Draft
from satcheck.audit.pair import Pair
from satcheck.audit.stages.parts import Covering, Part, covering, split_together, why_no_parts
from satcheck.audit.words import at_most
from satcheck.report.part_pairs import PartPair, PartPairs, PartRelation
from satcheck.report.report import OVERLAPS

STAGE = "part-pairs"
# Pairs of parts whose boxes meet that are tested: a few seconds. Those whose boxes overlap least
# are left out.
MAX_TESTED = 100_000
# Pairs of parts in a report: 300 kB. The table has the first few.
LISTED = 1_000


def find_part_pairs(draft: Draft) -> None:
    pair = draft.pair
    if why_not := why_no_parts(pair):
        draft.part_pairs = _none(draft, why_not)
        return
    split_together(pair)
    a, b = (covering(draft, body) for body in (pair.a, pair.b))
    if a is None or b is None:
        covers = {pair.a.id: a, pair.b.id: b}
        failed = " and ".join(id_ for id_, cover in covers.items() if cover is None)
        draft.part_pairs = _none(draft, f"{failed} could not be split, see the issues")
        return
    meeting, untested = _meeting(a.parts, b.parts, pair.tolerance)
    found = [each for i, j in meeting if (each := _compared(pair, a.parts[i], b.parts[j], i, j))]
    found.sort(key=_rank)
    relations = Counter(each.relation for each in found)
    made = PartPairs(
        parts=(len(a.parts), len(b.parts)),
        pairs=tuple(found[:LISTED]),
        overlapping=relations["penetrating"],
        touching=relations["touching"],
        undecided=relations["indeterminate"],
        untested=untested,
    )
    draft.part_pairs = replace(made, remark=_disagreement(draft, made, a, b))
    tried = f"{len(meeting)} pairs of {len(a.parts)} and {len(b.parts)} parts tested"
    draft.record(STAGE, f"{made.overlapping} overlap", tried)


def _none(draft: Draft, why: str) -> PartPairs:
    draft.record(STAGE, "none", why)
    return PartPairs(remark=f"no convex parts: {why}")


def _meeting(
    a: Sequence[Part], b: Sequence[Part], within: float
) -> tuple[list[tuple[int, int]], int]:
    """Return the pairs of parts whose boxes are within this distance, and the number of those
    beyond MAX_TESTED."""
    count = 0

    def ranked() -> Iterator[tuple[float, int, int]]:
        nonlocal count
        for i, j in _near(a, b, within):
            count += 1
            yield box_escape(a[i].bounds, b[j].bounds)[0], -i, -j

    meeting = [(-i, -j) for _, i, j in nlargest(MAX_TESTED, ranked())]
    return sorted(meeting), count - len(meeting)


def _near(a: Sequence[Part], b: Sequence[Part], within: float) -> Iterator[tuple[int, int]]:
    import numpy as np  # slow import, as that of what makes parts

    low, high = np.array([part.bounds for part in b]).swapaxes(0, 1)
    for i, part in enumerate(a):
        gaps = np.maximum(low - part.bounds[1], part.bounds[0] - high).max(axis=1)
        for j in np.flatnonzero(gaps <= within).tolist():
            yield i, j


def _compared(pair: Pair, a: Part, b: Part, i: int, j: int) -> PartPair | None:
    """i, j: the numbers of the parts, from 0. None: the parts are separated."""
    result = core.check_pair(a.shape, b.shape, a.pose, b.pose, method=pair.settings.method)
    relation, method, distance = _relation(result, a, b, pair.tolerance), result.method, None
    if relation is None:
        return None
    if relation != "indeterminate":
        distance = result.distance
    return PartPair(
        a=f"{pair.a.id}#{i + 1}",
        b=f"{pair.b.id}#{j + 1}",
        relation=relation,
        depth=None if distance is None else max(-distance, 0.0),
        axis=result.normal,
        method="gjk+epa" if method == "epa" else method,
        axes_tested=result.axes_tested,
        iterations=result.gjk_iterations + result.epa_iterations,
    )


def _relation(result: core.PairResult, a: Part, b: Part, tolerance: float) -> PartRelation | None:
    """None: separated, by more than the tolerance."""
    if result.outcome == "undecided" or result.lower is None or result.upper is None:
        return "indeterminate"
    if result.outcome == "touching":
        return "touching"
    sign = 1 if result.outcome == "separated" else -1
    limit = sign * tolerance
    side: int | None = -1 if result.upper < limit else 1
    if result.lower <= limit <= result.upper:
        side = core.compare_signed_distance(a.shape, b.shape, limit, a.pose, b.pose)
    if side is None:
        return "indeterminate"
    if side != sign:
        return "touching"
    return None if sign == 1 else "penetrating"


def _rank(pair: PartPair) -> tuple[bool, float]:
    """Return a sort key, the deepest first, those that touch last."""
    return pair.relation == "touching", -(pair.depth or 0.0)


def _disagreement(draft: Draft, found: PartPairs, a: Covering, b: Covering) -> str | None:
    """Return how the parts contradict what is proven of the bodies."""
    ids = draft.pair.a.id, draft.pair.b.id
    is_settled = not (found.overlapping or found.undecided or found.untested)
    if is_settled and draft.relation in OVERLAPS and (draft.exact_proven or draft.overlaps):
        if found.touching:  # by the tolerance, which the overlap of the bodies exceeds
            return "parts only touch where the bodies overlap"
        errors = zip(ids, (a.missing, b.missing), strict=True)
        why = [f"{id_} sticks out of its parts by up to {at_most(e)}" for id_, e in errors if e]
        return "; ".join(["no parts overlap where the bodies do", *why])
    if found.overlapping and draft.exact_proven and draft.exact not in OVERLAPS:
        errors = zip(ids, (a.outside, b.outside), strict=True)
        why = [f"parts of {id_} stick out of it by up to {at_most(e)}" for id_, e in errors if e]
        where = "touch" if draft.exact == "touching" else "are apart"
        deepest = at_most(found.pairs[0].depth or 0.0)
        return "; ".join([f"parts overlap by up to {deepest} where the bodies {where}", *why])
    return None
