"""Is what changed within what the variant may change?

Relations are exact, so where the surfaces were not moved they must be the same. Where they were
moved by at most d, a relation may change only if d is enough to bring surfaces that are apart
together, to draw crossing triangles off each other, or two convex bodies apart. Figures may differ
by d and by their own rounding; of proven intervals that means that they come that close. The depth
of concave bodies jumps where a fit is snug, so beside a contact that a displacement may open or
close it is not compared.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct

from satcheck.audit.report.report import OVERLAPS
from satcheck.studies.stability.answer import NESTED, Answer
from satcheck.studies.stability.bounds import rounding_of_figures
from satcheck.studies.stability.variant import Variant

Judgement = Literal["same", "within", "beyond", "undecided"]
# Not part of the answer: how it was come by.
UNCOMPARED = frozenset({"largest", "convex", "reason", "hold"})


class Comparison(Struct, frozen=True):
    """relation_changed: and may, where the judgement is within. change: of the signed distance, in
    units of the files, None where one answer has no figure. bound: how much of it was allowed.
    beyond: what changed that must not have."""

    judgement: Judgement
    relation_changed: bool
    change: float | None
    bound: float
    beyond: tuple[str, ...] = ()


def compare(asked: Answer, seen: Answer, variant: Variant) -> Comparison:
    changed = asked.relation != seen.relation
    if "indeterminate" in (asked.relation, seen.relation):
        return Comparison("undecided", changed, None, 0.0)
    if variant.identical:
        return _must_be_equal(asked, seen)
    displacement = variant.displacement / variant.scale
    rounding = rounding_of_figures(asked.largest) + rounding_of_figures(seen.largest)
    bound = displacement + rounding
    beyond = []
    if changed and not (displacement and _may_change(asked, seen, bound)):
        beyond.append("relation")
    change = _change(asked, seen)
    if change is not None and change > bound and not _may_jump(asked, seen, displacement):
        beyond.append("depth" if asked.relation in OVERLAPS else "distance")
    same = not changed and not change
    judgement: Judgement = "beyond" if beyond else "same" if same else "within"
    return Comparison(judgement, changed, change, bound, tuple(beyond))


def _must_be_equal(asked: Answer, seen: Answer) -> Comparison:
    beyond = tuple(
        name
        for name in Answer.__struct_fields__
        if name not in UNCOMPARED and getattr(asked, name) != getattr(seen, name)
    )
    change = 0.0 if asked.signed == seen.signed else _change(asked, seen)
    changed = "relation" in beyond
    return Comparison("beyond" if beyond else "same", changed, change, 0.0, beyond)


def _change(asked: Answer, seen: Answer) -> float | None:
    """How much the signed distance changed for sure: the figures of convex pairs, and gaps, by
    their difference, proven intervals by what lies between them."""
    one, other = asked.signed, seen.signed
    if one is None or other is None:
        return None
    if asked.convex and seen.convex:
        return abs(one[0] - other[0])
    return max(one[0] - other[1], other[0] - one[1], 0.0)


def _may_change(asked: Answer, seen: Answer, bound: float) -> bool:
    """Whether surfaces that moved by so little can have made one relation the other."""
    both_overlap = asked.relation in OVERLAPS and seen.relation in OVERLAPS
    holding = [one.hold for one in (asked, seen) if not (both_overlap and _crosses(one))]
    if any(hold > bound for hold in holding):
        return False
    if not asked.convex or both_overlap:
        return True
    change = _change(asked, seen)
    return change is None or change <= bound


def _crosses(answer: Answer) -> bool:
    return answer.relation not in NESTED


def _may_jump(asked: Answer, seen: Answer, displacement: float) -> bool:
    in_contact = "touching" in (asked.relation, seen.relation) or (
        (asked.relation in OVERLAPS) != (seen.relation in OVERLAPS)
    )
    return displacement > 0 and not asked.convex and in_contact
