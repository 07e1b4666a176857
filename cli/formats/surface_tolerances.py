"""Proposed surface tolerances as text: what to type, and the evidence of each body."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.cli.formats.numbers import vector
from satcheck.cli.formats.words import counted, with_unit
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from satcheck.report.surface_tolerances import (
        BodyTolerance,
        FacetedCurves,
        SurfaceTolerancesReport,
    )

NOTHING = "no curved surface is seen"
INSIDE = "its facets are inside the curves, and explain no overlap"
# Kinds of curves of a body that are told of, the largest sagitta first.
_SHOWN = 3


def render(report: SurfaceTolerancesReport) -> str:
    """The whole text, final newline included."""
    unit = unit_of(report.units)
    lines = [
        line
        for bodies in _alike(report.bodies)
        for line in (_proposal(bodies), *_evidence(bodies[0], unit))
    ]
    return "\n".join((*lines, _whole(report))) + "\n"


def remark(report: SurfaceTolerancesReport) -> str:
    """For standard error."""
    limit = (
        f"Facets at angles of up to {report.most_degrees:g} degrees count as a curve, in chains of "
        f"{report.least_facets} or more: a shape with eight sides or fewer may be a prism."
    )
    if not any(body.curves for body in report.bodies):
        return limit
    return f"Measured, not known: confirm that the facets stand for curves. {limit}"


def _alike(bodies: tuple[BodyTolerance, ...]) -> list[list[BodyTolerance]]:
    """Bodies with the same evidence, as placed copies of one mesh have."""
    groups: dict[object, list[BodyTolerance]] = {}
    for body in bodies:
        said = [(*_figures(curve),) for curve in (*body.curves, *body.left_out)]
        key = (body.surface_tolerance, body.stated, tuple(said))
        groups.setdefault(key, []).append(body)
    return list(groups.values())


def _figures(curve: FacetedCurves) -> tuple[object, ...]:
    return curve.concave, curve.chains, curve.facets, f"{curve.radius:.3g}", f"{curve.sagitta:.3g}"


def _proposal(bodies: list[BodyTolerance]) -> str:
    more = f" and {counted(len(bodies) - 1, 'more body', 'more bodies')}" if bodies[1:] else ""
    said = NOTHING
    if bodies[0].stated:
        said = "stated by its sizes, without facets"
    elif bodies[0].surface_tolerance is not None:
        said = _typed(bodies[0].surface_tolerance)
    elif bodies[0].curves:
        said = INSIDE
    return f"{bodies[0].body}{more}: {said}"


def _typed(tolerance: float) -> str:
    return f"--surface-tolerance {tolerance:g}"


def _evidence(body: BodyTolerance, unit: str | None) -> Iterator[str]:
    for curve in body.curves[:_SHOWN]:
        yield f"  {_chains(curve)}: {_measured(curve, unit)}, as at {vector(curve.place)}"
    if rest := body.curves[_SHOWN:]:
        yield f"  {counted(sum(curve.chains for curve in rest), 'more curve')} with less"
    if body.left_out:
        first = body.left_out[0]
        chains = sum(curve.chains for curve in body.left_out)
        facets = sum(curve.facets for curve in body.left_out)
        both = replace(first, chains=chains, facets=facets)
        yield f"  left out, perhaps a prism: {_chains(both)}; if a curve, {_measured(first, unit)}"


def _chains(curve: FacetedCurves) -> str:
    several = f" in {counted(curve.chains, 'chain')}" if curve.chains > 1 else ""
    shape = "concave" if curve.concave else "convex"
    return f"{counted(curve.facets, shape + ' facet')}{several}"


def _measured(curve: FacetedCurves, unit: str | None) -> str:
    return (
        f"radius {with_unit(f'{curve.radius:.3g}', unit)}, "
        f"turning by {curve.degrees:.3g} degrees over a facet, "
        f"sagitta {with_unit(f'{curve.sagitta:.3g}', unit)}"
    )


def _whole(report: SurfaceTolerancesReport) -> str:
    if report.surface_tolerance is not None:
        return f"whole input: {_typed(report.surface_tolerance)}"
    nothing = "whole input: no tolerance is proposed"
    if any(body.surface_tolerance is not None for body in report.bodies):
        return f"{nothing}, the bodies have different units of length"
    if any(body.curves for body in report.bodies):
        return f"{nothing}, all facets are inside the curves"
    return f"{nothing}, {NOTHING}"
