"""The stage `contacts`: where the surfaces of a pair meet. It runs only on request."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Protocol, TypeVar

from satcheck import core
from satcheck.audit.draft import Draft
from satcheck.report.contacts import Contacts, ContactTotals, Curve, Patch

# Pairs of triangles that may meet: a report about more is nothing that anybody could use. Each
# takes 0.2 kB on its way, 0.7 kB where it shares a patch: 2 GB at most.
MAX_TRIANGLE_PAIRS = 3_000_000
TOO_MANY_PAIRS = f"more than {MAX_TRIANGLE_PAIRS:,} pairs of triangles meet"
TOO_MANY_STEPS = "finding where the triangles meet takes more steps than a pair may"
# Surfaces without a common point.
APART = frozenset({"separated", "contains", "inside"})


class Counted(Protocol):
    @property
    def point_count(self) -> int: ...


T = TypeVar("T", bound=Counted)


def find_contacts(draft: Draft) -> None:
    """Find where the triangles of the pair meet, exactly and whatever the touch band; nothing is
    found if they are too many."""
    if draft.exact_proven and draft.exact in APART:
        draft.contacts = Contacts()
        return
    pair = draft.pair
    found = contacts_of(pair.a.surface(), pair.b.surface(), pair.settings.contact_points)
    if isinstance(found, str):
        draft.record("contacts", "too many", found)
        draft.complain("too-many-contacts", None, f"{pair.a.id} and {pair.b.id}: {found}")
        return
    draft.contacts, totals = found, found.totals
    draft.record(
        "contacts",
        "found" if totals.triangle_pairs else "none",
        f"{totals.triangle_pairs} triangle pairs: {totals.curves} curves, "
        f"{totals.patches} patches, {totals.points} points",
    )


def contacts_of(a: core.Surface, b: core.Surface, limit: int) -> Contacts | str:
    """Return where the surfaces meet, or the reason why there is no list. limit: points in all
    lists together, and triangle pairs. Curves and patches come whole."""
    intersection = core.surface_intersection(a, b, MAX_TRIANGLE_PAIRS)
    if not intersection.complete:
        return TOO_MANY_PAIRS if intersection.within_budget else TOO_MANY_STEPS
    curves, patches, points, pairs = (
        intersection.curves,
        intersection.patches,
        intersection.points,
        intersection.triangle_pairs,
    )
    shown_curves, left = _fitting(curves, limit)
    shown_patches, left = _fitting(patches, left)
    shown_points = points[:left]
    return Contacts(
        curves=tuple(Curve(tuple(c.points), c.closed, c.length) for c in shown_curves),
        patches=tuple(
            Patch(tuple(map(tuple, p.outlines)), p.normal, p.opposed, p.area) for p in shown_patches
        ),
        points=tuple(shown_points),
        triangle_pairs=tuple(pairs[:limit]),
        totals=ContactTotals(
            curves=len(curves),
            length=math.fsum(curve.length for curve in curves),
            patches=len(patches),
            area=math.fsum(patch.area for patch in patches),
            points=len(points),
            triangle_pairs=len(pairs),
        ),
        truncated=len(shown_curves) < len(curves)
        or len(shown_patches) < len(patches)
        or len(shown_points) < len(points)
        or len(pairs) > limit,
    )


def _fitting(items: Iterable[T], limit: int) -> tuple[list[T], int]:
    """The first items that have no more points than the limit, and what is left of it."""
    shown: list[T] = []
    for item in items:
        if item.point_count > limit:
            return shown, 0
        limit -= item.point_count
        shown.append(item)
    return shown, limit
