"""The result of `satcheck axes` as text: the counts, a row for each axis, where a test stops, and
the winner."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.audit.words import counted, number, vector, with_unit
from satcheck.cli.formats.tables import (
    BOLD_MAGENTA,
    GREEN,
    YELLOW,
    Column,
    fitted_each,
    joined,
    table,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.cli.output import Page
    from satcheck.report.axes import AxesReport, AxisState, CandidateAxis, Shadow

_STYLES: dict[AxisState, str] = {
    "gap": GREEN,
    "touch": YELLOW,
    "overlap": "",
    "unknown": BOLD_MAGENTA,
}


def render(result: AxesReport, page: Page) -> str:
    """Return the whole text, final newline included."""
    axes = result.axes
    columns = (
        Column("test", tuple(str(axis.number) for axis in axes), right=True),
        Column("axis", tuple(map(origin, axes)), folds=True),
        Column("direction", tuple(vector(axis.direction) for axis in axes), folds=True),
        Column("shadow of A", tuple(_shadow(axis.shadow_a) for axis in axes), folds=True),
        Column("shadow of B", tuple(_shadow(axis.shadow_b) for axis in axes), folds=True),
        Column("between them", tuple(map(gap_words, axes)), folds=True, graded=True),
    )
    below = [early_out(result), _winner(result)]
    if result.left_out:
        below.insert(0, f"{counted(result.left_out, 'more axis', 'more axes')}: see --top.")
    lines = fitted_each([title(result), *_notes(result), *_counts(result)], page)
    lines += table(columns, page, [_STYLES[axis.state] for axis in axes])
    return joined([*lines, *fitted_each(below, page)], page)


def origin(axis: CandidateAxis) -> str:
    """`face 3 of A`, `edge 2 of A x edge 5 of B`."""
    if axis.kind == "edge-edge":
        return f"edge {axis.index_a} of A x edge {axis.index_b} of B"
    feature, body = axis.kind.split("-")
    index = axis.index_a if body == "a" else axis.index_b
    return f"{feature} {index} of {body.upper()}"


def gap_words(axis: CandidateAxis, unit: str | None = None) -> str:
    """`gap 0.5`, `overlap 1`, `touch`; `not known, overlap 1e-09 .. gap 2e-09`."""
    if axis.state == "unknown":
        low, high = axis.gap_bounds
        return f"not known: {_signed(low, unit)} .. {_signed(high, unit)}"
    return "touch" if axis.state == "touch" else _signed(axis.gap, unit)


def _signed(gap: float, unit: str | None) -> str:
    return f"{'gap' if gap > 0 else 'overlap'} {with_unit(number(abs(gap)), unit)}"


def title(result: AxesReport) -> str:
    what = {"bodies": "", "hulls": "the convex hulls of "}[result.of]
    return f"{what}A {result.a.id} and B {result.b.id}: {result.relation}"


def _notes(result: AxesReport) -> Iterator[str]:
    others = [body.id for body in (result.a, result.b) if not body.convex]
    kind = "convex outline" if result.planar else "convex solid"
    if others:
        are = f"is no {kind}" if len(others) == 1 else f"are no {kind}s"
        yield (
            f"note: {' and '.join(others)} {are}: the axes are those of the convex hulls. A gap "
            "separates the bodies, too. An overlap is one of the hulls only; satcheck A B checks "
            "the bodies."
        )
    if result.in_band:
        what = "gap" if result.relation == "separated" else "depth"
        tolerance = with_unit(number(result.tolerance), result.units)
        yield f"note: a check says touching: the {what} is within its tolerance, {tolerance}."


def _counts(result: AxesReport) -> Iterator[str]:
    counts, a, b = result.counts, result.a, result.b
    of_a, of_b, of_edges = counts.directions
    if result.planar:
        yield (
            f"{a.edges:,} + {b.edges:,} edges: {counted(counts.candidates, 'candidate')}, "
            f"{counted(counts.distinct, 'axis', 'axes')} once parallel edges are merged."
        )
        return
    yield (
        f"A: {counted(a.faces, 'face')}, {counted(a.edges, 'edge')}. "
        f"B: {counted(b.faces, 'face')}, {counted(b.edges, 'edge')}. "
        f"{a.faces:,} + {b.faces:,} face normals + {a.edges:,} x {b.edges:,} edge pairs = "
        f"{counted(counts.candidates, 'candidate')}."
    )
    yield (
        f"By direction {of_a:,} + {of_b:,} + {of_edges:,} = {of_a + of_b + of_edges:,}. "
        f"{counts.facet_pairs:,} of {counts.edge_pairs:,} edge pairs can make a face of the "
        f"Minkowski difference. Parallel ones merged, "
        f"{counted(counts.distinct, 'axis is', 'axes are')} left to test."
    )


def _shadow(shadow: Shadow) -> str:
    return " .. ".join(map(number, shadow))


def early_out(result: AxesReport) -> str:
    early, total = result.early_out, result.counts.distinct
    steps = ""
    if result.gjk_steps is not None:
        steps = f" GJK and EPA take {counted(result.gjk_steps, 'step')} instead."
    if early.axis is None:
        return f"No axis has a gap: a test has to try all {total:,}.{steps}"
    return (
        f"A test for overlap stops at axis {early.tested:,} of {total:,}, the first one with a "
        f"gap; {early.not_needed:,} are not needed.{steps}"
    )


def _winner(result: AxesReport) -> str:
    winner, unit = result.winner, result.units
    if winner is None:
        return "INCOMPLETE: the axes do not show how the bodies relate."
    length = with_unit(number(winner.length), unit)
    if winner.kind == "touching":
        where = f"on axis {winner.axis:,} the shadows touch exactly"
        return f"Touching: no axis has a gap, and {where}."
    if winner.mtv is not None:
        where = f"along axis {winner.axis:,}, the smallest overlap, {length}"
        return f"Minimum translation: {where}: move A by {vector(winner.mtv)}."
    said = f"Separating axis: {winner.axis:,}, the largest gap, {length}."
    if result.distance is not None and result.distance > winner.length * (1 + 1e-9):
        distance = with_unit(number(result.distance), unit)
        said += f" The distance is {distance}: between corners no candidate axis is nearest."
    return said
