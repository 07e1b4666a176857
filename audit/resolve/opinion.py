"""What a pair says of where its bodies are: whether anybody objects, and which way ends that."""

from __future__ import annotations

import math
from typing import Literal

from msgspec import Struct

from satcheck.audit.asked.settings import FailOn
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.report.report import OVERLAPS, SEVERITIES, Finding, Vector
from satcheck.audit.resolve.separation import longer, nudge, way_outside
from satcheck.audit.vectors import scaled


class Opinion(Struct, frozen=True):
    """How a pair is judged where it is.

    open: a hole of one body leaves open whether they overlap. push: a translation of the first body
    that ends the overlap, widens the gap to the clearance, or leads away from the hole; None: none
    was found. excused: no check fails on them where the scene has them, although they overlap or
    may overlap: within the touch band, for instance.
    """

    kind: Literal["free", "overlap", "near", "open", "undecided"]
    push: Vector | None = None
    excused: bool = False


def is_objected(finding: Finding, fail_on: FailOn) -> bool:
    """Whether a check fails on what the pair is known to be, or cannot tell whether an overlap is
    within its limits."""
    if finding.undecided == "limit" and finding.at_rest in OVERLAPS:
        return True
    grave = SEVERITIES[: SEVERITIES.index(fail_on) + 1]
    return finding.severity in grave and (finding.undecided is None or finding.severity == "error")


def opinion_of(pair: Pair, found: Finding) -> Opinion:
    """found: what was found where the bodies are."""
    clearance = pair.asked.clearance or 0.0
    if found.relation == "indeterminate":
        push = None if pair.both_solid or pair.curved else way_outside(pair)
        return Opinion("undecided" if push is None else "open", push)
    if not is_objected(found, pair.settings.fail_on):
        return Opinion("free")
    if found.relation in OVERLAPS:
        return Opinion("overlap", found.mtv and longer(found.mtv, clearance - may_overlap(pair)))
    if found.normal is None:
        return Opinion("near", nudge(pair, clearance))
    return Opinion("near", scaled(found.normal, (found.distance or 0.0) - clearance))


def may_overlap(pair: Pair) -> float:
    """How deep the bodies may overlap. Where depth is an interval, less than the limit by its
    width, so that the interval can end below the limit. A limit of the volume is no length."""
    if pair.asked.max_depth is None or pair.asked.max_volume is not None:
        return 0.0
    width = 0.0 if pair.both_convex else pair.settings.depth_width
    return pair.asked.max_depth * (1 - width)


def is_overlap_excused(found: Finding) -> bool:
    """Of a finding that no check fails on: whether it is an overlap, or may be one."""
    return found.exact_relation in OVERLAPS or found.undecided is not None


def length_of(push: Vector | None) -> float:
    return math.hypot(*push) if push else 0.0
