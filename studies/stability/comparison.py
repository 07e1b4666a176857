"""Whether the change of an answer is within the bound of its variant.

Relations are exact, so where the surfaces were not moved they must be the same. Where they were
moved by at most d, a relation may change only if d is enough to bring surfaces that are apart
together, to draw crossing triangles off each other, or two convex bodies apart. Figures may differ
by d and by their own rounding; of proven intervals that means that they come that close. The depth
of concave bodies jumps where a fit is snug, so beside a contact that a displacement may open or
close it is not compared. The thickness never jumps: where surfaces are moved by d, a point lies
deeper or less deep by d at most. Its interval depends on the order of the triangles, also where
the other figures do not.
"""

from __future__ import annotations

from msgspec import Struct

from satcheck.report.report import OVERLAPS
from satcheck.report.stability import Judgement as Judgement
from satcheck.studies.stability.answer import NESTED, Answer
from satcheck.studies.stability.variant import Variant, rounding_of_figures

# Not what a variant must keep, but what a comparison needs to know.
UNCOMPARED = frozenset({"largest", "convex", "reason", "hold", "thickness_bounds"})


class Comparison(Struct, frozen=True):
    """change: of the signed distance, in units of the files; None where one answer has none.
    bound: the largest change that the variant allows. beyond: what changed although it must not.
    thickness_change: of the thickness, by what lies between its intervals; it may be twice the
    bound."""

    judgement: Judgement
    change: float | None
    bound: float
    beyond: tuple[str, ...] = ()
    thickness_change: float | None = None


def compare(given: Answer, varied: Answer, variant: Variant) -> Comparison:
    changed = given.relation != varied.relation
    if "indeterminate" in (given.relation, varied.relation):
        return Comparison("undecided", None, 0.0)
    if variant.identical:
        return _must_be_equal(given, varied)
    displacement = variant.displacement / variant.scale
    rounding = rounding_of_figures(given.largest) + rounding_of_figures(varied.largest)
    bound = displacement + rounding
    beyond = []
    if changed and not (displacement and _may_change(given, varied, bound)):
        beyond.append("relation")
    change = _change(given, varied)
    if change is not None and change > bound and not _may_jump(given, varied, displacement):
        beyond.append("depth" if given.relation in OVERLAPS else "distance")
    thicker = _between(given.thickness_bounds, varied.thickness_bounds)
    if thicker is not None and thicker > 2 * bound:
        beyond.append("thickness")
    same = not changed and not change and not thicker
    judgement: Judgement = "beyond" if beyond else "same" if same else "within"
    return Comparison(judgement, change, bound, tuple(beyond), thicker)


def _must_be_equal(given: Answer, varied: Answer) -> Comparison:
    beyond = tuple(
        name.removesuffix("_bounds")
        for name in Answer.__struct_fields__
        if name not in UNCOMPARED and getattr(given, name) != getattr(varied, name)
    )
    change = 0.0 if given.signed == varied.signed else _change(given, varied)
    thicker = _between(given.thickness_bounds, varied.thickness_bounds)
    if thicker:
        beyond = (*beyond, "thickness")
    return Comparison("beyond" if beyond else "same", change, 0.0, beyond, thicker)


def _change(given: Answer, varied: Answer) -> float | None:
    """How much the signed distance changed for sure: the figures of convex pairs, and gaps, by
    their difference, proven intervals by what lies between them."""
    before, after = given.signed, varied.signed
    if before is None or after is None:
        return None
    if given.convex and varied.convex:
        return abs(before[0] - after[0])
    return _between(before, after)


def _between(before: tuple[float, float] | None, after: tuple[float, float] | None) -> float | None:
    """How far two intervals are apart."""
    if before is None or after is None:
        return None
    return max(before[0] - after[1], after[0] - before[1], 0.0)


def _may_change(given: Answer, varied: Answer, bound: float) -> bool:
    """Whether surfaces that moved by so little can have made one relation the other."""
    both_overlap = given.relation in OVERLAPS and varied.relation in OVERLAPS
    for answer in (given, varied):
        crosses = answer.relation not in NESTED
        if answer.hold > bound and not (both_overlap and crosses):
            return False
    if not given.convex or both_overlap:
        return True
    change = _change(given, varied)
    return change is None or change <= bound


def _may_jump(given: Answer, varied: Answer, displacement: float) -> bool:
    in_contact = "touching" in (given.relation, varied.relation) or (
        (given.relation in OVERLAPS) != (varied.relation in OVERLAPS)
    )
    return displacement > 0 and not given.convex and in_contact
