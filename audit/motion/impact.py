"""The first moment at which moving bodies overlap by more than the touch band: a scan along t.

Conservative advancement: Brian Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems"
(1996), 2.3; Xinyu Zhang, Minkyoung Lee, Young J. Kim, "Interactive Continuous Collision Detection
for Non-convex Polyhedra" (2006). The gap at t proves that the bodies stay apart for some time. The
scan goes to the end of that time and measures the gap again. It skips no moment, so it misses no
body, however fast or thin.

Where we deviate: a contact is no collision. While bodies touch, the scan goes on as long as it can
prove that they overlap by no more than the touch band. For two convex bodies the signed distance
proves it; else contact.py does. If the proof fails, the scan looks for an overlap
later in the motion. If it finds none, the answer is open.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck import core
from satcheck.audit.motion.contact import ContactOffsets, safe_slide
from satcheck.audit.motion.moving_pair import (
    SLID,
    MovingPair,
    Unanswerable,
    overlaps,
)
from satcheck.audit.stages.depth import FREE
from satcheck.audit.stages.thickness import why_not_thick
from satcheck.report.report import OVERLAPS
from satcheck.report.sweep import Sweep, SweptRelation
from satcheck.report.values import Interval

if TYPE_CHECKING:
    from satcheck.audit.pair import Pair
    from satcheck.core.conventions import Vector

# If no step of at least this share keeps the bodies farther apart than a length, the scan no longer
# tries to prove that they stay so far apart.
SHORTEST_WIDE_STEP = 2.0**-12
# Poses after an unproven contact in which an overlap is searched.
PROBES = 64
# The point is the centre of a ball in both bodies. The search ends once the thickest ball is at
# most twice as thick, so that it is a ball of the impact, not of a contact before it. Or it ends
# after this work, less than a tenth of a second after its preparation.
COARSE = 0.5
WORK = 10_000_000


def first_impact(pair: MovingPair, gap: float = 0.0) -> Sweep:
    """Scan the stretches in which the bodies may meet. The relation of bodies that stay free is the
    closest that is not excluded yet. gap: the scan proves on its way that the bodies stay farther
    apart than this, if it can."""
    try:
        start = pair.found_at(pair.stretches[0][0])
        if overlaps(start):
            return open_sweep(pair, 0.0, (0.0, 0.0), 0.0)
        if start.relation == "indeterminate" or start.relation in OVERLAPS:
            reason = f"undecided where the motion starts: {start.reason}"
            upper = _first_overlap(pair, 0.0) if pair.pair.may("exact") else None
            if upper is None:
                return open_sweep(pair, 0.0, contact=0.0, reason=reason)
            return open_sweep(pair, 0.0, (0.0, upper), 0.0)
    except Unanswerable as why:
        return open_sweep(pair, 0.0, reason=str(why))
    # A possible touch counts as a contact; the scan itself proves how deep it is.
    scan = _Scan(pair, gap, outside=start.exact_relation in FREE)
    try:
        scan.run()
    except Unanswerable as why:
        scan.reason = f"{why}, at t = {scan.t:.6g}"
    return scan.swept()


def open_sweep(
    pair: MovingPair,
    reached: float,
    impact: Interval | None = None,
    contact: float | None = None,
    reason: str | None = None,
) -> Sweep:
    """Return a sweep without its figures."""
    relation: SweptRelation = "indeterminate" if reason else "touching"
    return Sweep(
        relation="penetrating" if impact else relation,
        time_of_impact=impact,
        reached=reached,
        contact=contact,
        reason=reason,
        tolerance=pair.tolerance,
        steps=pair.steps,
    )


def possible_overlap(pair: MovingPair, start: float) -> float | None:
    """A t >= start at which the bodies may overlap, by the last test that --accuracy allows; None:
    no probe shows one."""
    try:
        return next(
            (t for t in _probes(pair, start) if pair.found_at(t).relation in OVERLAPS), None
        )
    except Unanswerable:
        return None


class _Scan:
    """t: until t the bodies are free or within the touch band. met: where the contact at t began,
    the lower end of the interval that is reported. outside: the bodies are known to have no common
    interior at t. Separate surfaces do not prove that: a body smaller than the touch band may have
    entered the other body. gap: until t the bodies are farther apart than this."""

    def __init__(self, pair: MovingPair, gap: float, outside: bool) -> None:
        self.t = 0.0
        self._outside = outside
        self.met = 0.0
        self.contact: float | None = None
        self.reason: str | None = None
        self._pair = pair
        self._gap = gap
        self._offsets = ContactOffsets(pair)

    def run(self) -> None:
        for start, end in self._pair.stretches:
            if self.reason is not None:
                return
            if start > self.t:  # they are apart until there
                self.t = self.met = start
                self._outside = True
            self._scan(end)

    def _scan(self, end: float) -> None:
        while self.t < end and self.reason is None:
            if self._advance(self._apart(end), end):
                self.met = self.t
                continue
            if self.contact is None:
                self.contact = self.t
            since, self._outside = self.t, False
            if not self._advance(self._in_contact(end), end):
                self.reason = (
                    f"not proven apart at t = {self.t:.6g}, and nothing proves that an overlap "
                    f"stays within the tolerance {self._pair.tolerance:.3g}"
                )
            elif (self.t - since) * self._pair.fastest(since) > SLID * self._pair.tolerance:
                self.met = self.t

    def _apart(self, end: float) -> float:
        """The time for which the bodies are proven to stay apart."""
        time = self._farther_apart(end)
        if time > 0.0 and not self._outside and not self._pair.convex:
            self._outside = self._pair.found_at(self.t).exact_relation in FREE
            return time if self._outside else 0.0
        return time

    def _farther_apart(self, end: float) -> float:
        """The time for which the surfaces are farther apart than the gap, or than nothing."""
        if self._gap > 0.0:
            time = self._pair.apart(self.t, end, gap=self._gap)
            if time >= min(SHORTEST_WIDE_STEP, end - self.t):
                return time
            self._gap = 0.0
        return self._pair.apart(self.t, end)

    def _in_contact(self, end: float) -> float:
        on = self._pair.shallow(self.t, end)
        if self._pair.is_step(on, self.t, end) or not self._pair.pair.may("exact"):
            return on
        # Most contacts are so short that they count as the start of an overlap.
        if overlaps(self._pair.found_at(self._pair.soon(self.t, end, SLID))):
            return 0.0
        slide = safe_slide(self._pair, self.t, end)
        if self._pair.is_step(slide, self.t, end):
            return slide
        return self._offsets.safe_time(self.t, end)

    def swept(self) -> Sweep:
        pair, contact = self._pair, self.contact
        try:
            upper = self._inside_at_rest() if self.reason is None else _first_overlap(pair, self.t)
        except Unanswerable as why:
            return open_sweep(pair, self.t, None, contact, str(why))
        if upper is None and self.reason is None:
            free = open_sweep(pair, 1.0, None, contact)
            return replace(free, distance_at_least=self._gap or None)
        if upper is None:
            return open_sweep(pair, self.t, None, contact, self.reason)
        # If the budget ended before a contact, they stay apart until t.
        contact = self.t if contact is None else contact
        return open_sweep(pair, min(self.t, upper), (min(self.met, upper), upper), contact)

    def _inside_at_rest(self) -> float | None:
        """The start or the end of the motion, if the bodies touch on the way and this pose fails at
        rest, where the tolerance may be smaller than the touch band of the sweep."""
        tolerance = self._pair.pair.tolerance
        if self.contact is None or tolerance >= self._pair.tolerance:
            return None
        ends = (t for t in (0.0, 1.0) if overlaps(self._pair.found_at(t, tolerance=tolerance)))
        return next(ends, None)

    def _advance(self, step: float, end: float) -> bool:
        """Moves t on by the step, which is proven. Returns whether it is a long one."""
        is_long = self._pair.is_step(step, self.t, end)
        later = math.nextafter(self.t + step, 0.0)
        self.t = end if self.t + step >= end else max(self.t, later)
        return is_long


def _first_overlap(pair: MovingPair, start: float) -> float | None:
    """A t >= start at which the bodies overlap; None: no probe overlaps. The steps first double and
    are then halved, so that t is near the first overlap."""
    before, overlap_time = start, None
    for t in _probes(pair, start):
        if overlaps(pair.found_at(t)):
            overlap_time = t
            break
        before = t
    if overlap_time is None:
        return None
    while overlap_time - before > pair.shortest_step(before):
        middle = 0.5 * (before + overlap_time)
        if overlaps(pair.found_at(middle)):
            overlap_time = middle
        else:
            before = middle
    return overlap_time


def _probes(pair: MovingPair, start: float) -> list[float]:
    """After steps that double, and evenly over what is left of the motion, where the bodies may
    meet."""
    step, times = pair.shortest_step(start), {start, 1.0}
    while start + step < 1.0:
        times.add(start + step)
        step *= 2.0
    rest = 1.0 - start
    times |= {start + rest * k / PROBES for k in range(1, PROBES)}
    times |= {0.5 * (s + e) for s, e in pair.stretches if s >= start}
    starts = [s for s, _ in pair.stretches]
    before = ((t, bisect_right(starts, t) - 1) for t in sorted(times))
    return [t for t, k in before if k >= 0 and t <= pair.stretches[k][1]]


def impact_point(placed: Pair, moved: float) -> Vector | None:
    """A world point of both bodies, which overlap as they are placed.

    Of closed meshes it is the centre of a ball that is proven to lie in both, if a short search
    finds one. Else, and of other meshes, it is a common point, rounded: of the surfaces, or of one
    surface and the inside of the other body. Of curved shapes it is at most the tolerance and
    `moved` away from both. moved: how far the bodies moved since they did not overlap. None: no
    point is known.
    """
    if placed.curved:
        return _between_witnesses(placed, moved)
    a, b = placed.a.surface(), placed.b.surface()
    if why_not_thick(placed) is None:
        thick = core.search_thickness(a, b, width=COARSE, work=WORK)
        if thick.centre is not None and thick.lower > 0:
            return thick.centre
    return core.mesh_relation(a, b).point


def _between_witnesses(placed: Pair, moved: float) -> Vector | None:
    """The middle between the deepest points of two bodies, one of them a curved shape."""
    from satcheck.core.curved.freeing import sides
    from satcheck.core.curved.placed import is_convex
    from satcheck.core.curved.signed import convex_pair
    from satcheck.core.curved.triangles import against_triangles

    if is_convex(placed.a) and is_convex(placed.b):
        signed = convex_pair(placed.a, placed.b)
    else:
        curved, mesh, _ = sides(placed.a, placed.b)
        signed = against_triangles(curved, mesh.mesh, 0.0).nearest
    if signed is None or signed.witness_a is None or signed.witness_b is None:
        return None
    off = 0.5 * math.dist(signed.witness_a, signed.witness_b)
    if off > moved + 0.5 * placed.tolerance:  # the other half of the tolerance is for rounding
        return None
    x, y, z = (0.5 * (p + q) for p, q in zip(signed.witness_a, signed.witness_b, strict=True))
    return x, y, z
