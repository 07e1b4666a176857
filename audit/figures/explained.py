"""Whether surfaces that may be off by a little explain an overlap of closed bodies.

The surface of each body X may be off by e_X: by half of the touch band, or by its surface tolerance
where that is more. An overlap is real where a point lies deeper than e_A in A and deeper than e_B
in B. The core looks for such a point, or proves that there is none. Nothing is explained where all
of a body is as thin as its own tolerance, where one body passes through the other: enters it in one
place and leaves it in another, and where a thin part of a body, as a fin or a wire, reaches deep
into the other one: no point of it is deep in its own body.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from satcheck import core
from satcheck.audit.figures.search_progress import shown
from satcheck.audit.figures.thickness import across, why_not_thick
from satcheck.audit.rounding import EXACT_WIDTH

if TYPE_CHECKING:
    from satcheck.audit.bodies.pair import Pair
    from satcheck.audit.bodies.placed_body import PlacedBody
    from satcheck.audit.request.trace import Trace

STAGE = "touch-band"
# Pairs of triangles that meet, at most, where it is asked whether a body passes through another.
MOST_CROSSINGS = 100_000
# A thin part of a body reaches deeper into the other one than this, times e_A + e_B. The edge of a
# wedge of angle w that is nowhere deeper than e reaches e (1 + 1 / sin(w / 2)) deep: no more than
# that, with e_A = e_B = e, if w is 17 degrees or more.
MOST_REACH = 4.0


Explained = Literal["within", "deeper", "not excused", "undecided"]


def may_be_explained(pair: Pair) -> bool:
    return max(pair.off) > 0 and why_not_thick(pair) is None


def explain(pair: Pair, trace: Trace, nanoseconds: int = 0) -> tuple[Explained, str]:
    """Of an overlap of closed bodies, with the open question if it is undecided, and why it is not
    excused. nanoseconds: what was spent before."""
    result, detail = _decided(pair)
    off = " and ".join(f"{length:.3g} in {body.id}" for length, body in surfaces(pair))
    told = f"{detail} is open" if result == "undecided" else detail
    joint = " " if result in ("within", "deeper") else "; the surfaces are off by "
    trace.add_since(STAGE, result, f"{told}{joint}{off}", nanoseconds)
    return result, detail


def _decided(pair: Pair) -> tuple[Explained, str]:
    """The result, and what is said of it: "within" and "deeper" are followed by the lengths."""
    for length, body in surfaces(pair):
        if not ball_in(pair, body, length).lower > 0:
            return "not excused", f"{body.id} is not known to be thicker than its tolerance"
    through = core.passes_through(pair.a.surface(), pair.b.surface(), MOST_CROSSINGS)
    if through:
        return "not excused", "one body passes through the other"
    limit = limit_of(pair)
    interval = deeper(pair, prove=False)
    if interval.lower > limit:
        return "deeper", "a point lies deeper than"
    if interval.upper > limit:
        return "undecided", "whether a point lies deeper in both than the surfaces may be off"
    reach = _reach(pair, limit)
    if through is None and (reach is None or reach[0] == "undecided"):
        return "undecided", "whether one body passes through the other"
    return reach or ("within", "no point lies deeper than")


def _reach(pair: Pair, limit: float) -> tuple[Explained, str] | None:
    """Whether a thin part of one body lies deeper in the other than what is off explains; None: no
    part does."""
    most = MOST_REACH * sum(pair.off)
    for off, body, other in (((0.0, most), pair.a, pair.b), ((most, 0.0), pair.b, pair.a)):
        interval = _search(pair, pair.a, pair.b, off, limit, prove=False)
        reaches = None if interval.lower <= limit < interval.upper else interval.lower > limit
        if reaches is None and pair.settings.across < 0:
            work = pair.settings.thickness_work
            reaches = core.reaches_deeper(body.surface().mesh, other.surface(), most, work)
        if reaches:
            return "not excused", f"a thin part of {body.id} reaches more than {most:.3g} deep"
        if reaches is None:
            return "undecided", f"whether a thin part of {body.id} reaches {most:.3g} deep"
    return None


def surfaces(pair: Pair) -> list[tuple[float, PlacedBody]]:
    return list(zip(pair.off, (pair.a, pair.b), strict=True))


def ball_in(pair: Pair, body: PlacedBody, off: float) -> core.ThicknessInterval:
    """Over 0: of a body that is thicker than its surface may be off."""
    return _search(pair, body, body, (off, off), 0.0, prove=False)


def limit_of(pair: Pair) -> float:
    """The band ends exactly, a surface tolerance to rounding."""
    return EXACT_WIDTH * max(pair.off) if pair.excuses else 0.0


def deeper(pair: Pair, *, prove: bool) -> core.ThicknessInterval:
    """By how much a point lies deeper in both than their surfaces may be off, twice. prove: with
    what shows the upper end."""
    return _search(pair, pair.a, pair.b, pair.off, limit_of(pair), prove=prove)


def _search(
    pair: Pair,
    a: PlacedBody,
    b: PlacedBody,
    off: tuple[float, float],
    limit: float,
    *,
    prove: bool,
) -> core.ThicknessInterval:
    with shown("thickness beyond the surface tolerances", pair) as progress:
        return core.search_thickness(
            a.surface(),
            b.surface(),
            width=0.0,
            work=pair.settings.thickness_work,
            less_a=off[0],
            less_b=off[1],
            limit=limit,
            across=across(pair, prove=prove),
            prove=prove,
            progress=progress,
        )
