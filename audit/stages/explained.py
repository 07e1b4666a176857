"""Whether surfaces that may be off by a little explain an overlap of closed bodies.

The surface of each body X may be off by e_X: by half of the touch band, or by its surface tolerance
where that is more. An overlap is real where a point lies deeper than e_A in A and deeper than e_B
in B. The core looks for such a point, or proves that there is none: at once if the bodies are free
of each other when each is made smaller by what it may be off, or by the planes of their faces, else
by a search. Nothing is explained where one body passes through the other: enters it in one place
and leaves it in another. Where no vertex has to move farther than e_X until the bodies are free,
neither does; nor where their faces fit and both bodies are thicker than the band there. Slivers
between such faces may look like it.

A surface tolerance also explains nothing where all of a body is as thin as that, and where a thin
part of a body, as a fin or a wire, reaches deep into the other one: no point of it is deep in its
own body. The touch band has no such exceptions: nothing thicker than the tolerance lies in both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from satcheck import core
from satcheck.audit.draft import Band, Draft
from satcheck.audit.stages.thickness import across, why_not_thick
from satcheck.report.judge import EXACT_WIDTH

if TYPE_CHECKING:
    from satcheck.audit.body import PlacedBody
    from satcheck.audit.pair import Pair

STAGE = "touch-band"
# Pairs of triangles that meet, at most, where it is asked whether a body passes through another.
MOST_CROSSINGS = 100_000
# A thin part of a body reaches deeper into the other one than this, times e_A + e_B. The edge of a
# wedge of angle w that is nowhere deeper than e reaches e (1 + 1 / sin(w / 2)) deep: no more than
# that, with e_A = e_B = e, if w is 17 degrees or more.
MOST_REACH = 4.0
# Steps of a search that decides most overlaps that are well within the tolerance or well beyond it.
QUICK_WORK = 1_000_000
# Steps of the proof by the planes of faces, which decides bodies that fit at once, if at all.
FIT_WORK, FIT_WORK_PER_TRIANGLE = 100_000_000, 20_000
# Steps of the scene, each about a nanosecond: of a step of that proof, and of a triangle that is
# made smaller.
STEPS_OF_FIT, STEPS_OF_SHRUNK_TRIANGLE = 4, 100
# Of the length by which vertices may move, if that itself shows nothing: of a few units in the last
# place, rounding may leave a narrow triangle in the way at one of them.
SHARES = (0.9, 0.8)


WITHIN, DEEPER = Band("within"), Band("deeper")
THROUGH = Band("open", unexcused="one body passes through the other")
THROUGH_OPEN = Band("hidden", why="whether one body passes through the other")
DEPTH_OPEN = Band("hidden", why="whether a point lies deeper in both than the surfaces may be off")


def may_be_explained(pair: Pair) -> bool:
    return max(pair.off) > 0 and why_not_thick(pair) is None


def explain(draft: Draft, nanoseconds: int = 0) -> Band:
    """Return whether that explains an overlap of closed bodies: `hidden` if that is undecided, and
    `open` if it is not excused. nanoseconds: what was spent before."""
    pair = draft.pair
    pair.explain_steps = 0
    band = _decided(pair)
    draft.steps += pair.explain_steps
    off = " and ".join(f"{length:.3g} in {body.id}" for length, body in surfaces(pair))
    match band.side:
        case "within":
            told = "within", f"no point lies deeper than {off}"
        case "deeper":
            told = "deeper", f"a point lies deeper than {off}"
        case "hidden":
            told = "undecided", f"{band.why} is open; the surfaces are off by {off}"
        case _:
            told = "not excused", f"{band.unexcused}; the surfaces are off by {off}"
    draft.record(STAGE, *told, nanoseconds)
    return band


def _decided(pair: Pair) -> Band:
    if not pair.excuses:
        return _decided_by_band(pair)
    band = _decided_by_surfaces(pair)
    if band.side in ("open", "hidden") and pair.tolerance > 0:
        by_band = _decided_by_band(pair)
        if by_band.side == "within":
            return by_band
    return band


def _decided_by_band(pair: Pair) -> Band:
    """Decide whether a ball thicker than the tolerance lies in both."""
    half = 0.5 * pair.tolerance
    if _free_when_shrunk(pair, (half, half)):
        return WITHIN
    quick = _search(pair, pair.a, pair.b, (0.0, 0.0), pair.tolerance, prove=False, work=QUICK_WORK)
    if quick.lower > pair.tolerance:
        return DEEPER
    if quick.upper <= pair.tolerance and passes(pair) is False:
        return WITHIN
    if any(_free_when_shrunk(pair, (share * half, share * half)) for share in SHARES):
        return WITHIN
    fit = _fit_of_convex(pair) or _fit(pair)
    if fit == "deeper":
        return DEEPER
    if fit == "fit":
        return WITHIN
    through = passes(pair)
    if through:
        return THROUGH
    if fit is None:
        interval = _search(pair, pair.a, pair.b, (0.0, 0.0), pair.tolerance, prove=False)
        if interval.lower > pair.tolerance:
            return DEEPER
        if interval.upper > pair.tolerance:
            return DEPTH_OPEN
    return THROUGH_OPEN if through is None else WITHIN


def _fit_of_convex(pair: Pair) -> Literal["deeper", "thin"] | None:
    """Return how two convex bodies fit at the tolerance; None: not decided."""
    if not pair.both_convex or pair.on_half_space or pair.settings.across >= 0:
        return None
    from satcheck.audit.stages.convex_ball import holds_thicker_ball

    thicker = holds_thicker_ball(pair.a.hull(), pair.b.hull(), pair.tolerance)
    return None if thicker is None else "deeper" if thicker else "thin"


def _fit(pair: Pair) -> Literal["deeper", "thin", "fit"] | None:
    """Return how the faces of the bodies fit at the tolerance; None: they do not decide it."""
    if pair.settings.across >= 0:  # the faces across the axis of prisms do not count
        return None
    a, b = pair.a.surface(), pair.b.surface()
    most = min(pair.thickness_work, FIT_WORK + FIT_WORK_PER_TRIANGLE * pair.triangles)
    fit, steps = core.fit_by_faces(a, b, pair.tolerance, most)
    pair.explain_steps += STEPS_OF_FIT * steps
    return fit


def _free_when_shrunk(pair: Pair, off: tuple[float, float]) -> bool:
    pair.explain_steps += STEPS_OF_SHRUNK_TRIANGLE * pair.triangles
    return core.free_when_shrunk(pair.a.surface(), pair.b.surface(), *off)


def passes(pair: Pair) -> bool | None:
    """Return whether one body passes through the other; None: not decided."""
    return core.passes_through(pair.a.surface(), pair.b.surface(), MOST_CROSSINGS)


def _decided_by_surfaces(pair: Pair) -> Band:
    for length, body in surfaces(pair):
        if not ball_in(pair, body, length).lower > 0:
            why = f"{body.id} is not known to be thicker than its tolerance"
            return Band("open", unexcused=why)
    if _free_when_shrunk(pair, pair.off):
        return WITHIN
    through = passes(pair)
    if through:
        return THROUGH
    limit = limit_of(pair)
    interval = deeper(pair, prove=False)
    if interval.lower > limit:
        return DEEPER
    if interval.upper > limit:
        return DEPTH_OPEN
    reach = reaching(pair)
    if through is None and (reach is None or reach.side == "hidden"):
        return THROUGH_OPEN
    return reach or WITHIN


def reaching(pair: Pair) -> Band | None:
    """Return what follows where a thin part of one body lies deeper in the other than what is off
    explains; None: no part does."""
    most, limit = MOST_REACH * sum(pair.off), limit_of(pair)
    for off, body, other in (((0.0, most), pair.a, pair.b), ((most, 0.0), pair.b, pair.a)):
        interval = _search(pair, pair.a, pair.b, off, limit, prove=False)
        reaches = None if interval.lower <= limit < interval.upper else interval.lower > limit
        if reaches is None and pair.settings.across < 0:
            work = pair.thickness_work
            reaches = core.reaches_deeper(body.surface().mesh, other.surface(), most, work)
        if reaches:
            why = f"a thin part of {body.id} reaches more than {most:.3g} deep"
            return Band("open", unexcused=why)
        if reaches is None:
            why = f"whether a thin part of {body.id} reaches {most:.3g} deep"
            return Band("hidden", why=why)
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
    work: int | None = None,
) -> core.ThicknessInterval:
    """work: steps; None: as many as the settings grant."""
    with pair.searching("thickness beyond the surface tolerances") as progress:
        interval = core.search_thickness(
            a.surface(),
            b.surface(),
            width=0.0,
            work=pair.thickness_work if work is None else work,
            less_a=off[0],
            less_b=off[1],
            limit=limit,
            across=across(pair, prove=prove),
            prove=prove,
            progress=progress,
        )
    pair.explain_steps += interval.work
    return interval
