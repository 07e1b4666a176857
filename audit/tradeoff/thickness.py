"""The thickness of an overlap, by what a rung puts in the place of the bodies.

The exact rung bounds that of the bodies. Hulls hold the bodies, so that no ball in both bodies is
larger than the largest one in both hulls. Convex parts hold most of a body, and a ball may reach
into several of them: the largest ball in a part of A and a part of B is a figure without a bound.
"""

from __future__ import annotations

import math
from time import perf_counter

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.figures.thickness import STAGE
from satcheck.audit.tradeoff.result import Figure
from satcheck.core.errors import SatcheckError
from satcheck.report.report import OVERLAPS, Finding


class ThicknessRun(Struct, frozen=True):
    """seconds: of the search, with the shapes that it runs on."""

    figure: Figure
    seconds: float


def thickness_by(rung: str, pair: Pair, finding: Finding) -> ThicknessRun | None:
    """rung: the name of that at which the climb ended. None: there is no overlap by this rung, or
    it has no thickness."""
    if finding.thickness_bounds is not None:
        low, high = finding.thickness_bounds
        searched = (stage.microseconds for stage in finding.plan if stage.stage == STAGE)
        return ThicknessRun(Figure(high, low, high), 1e-6 * sum(searched))
    if finding.relation not in OVERLAPS or pair.curved or not pair.both_solid:
        return None
    start = perf_counter()
    if rung == "hull":
        a, b = (_surface(body.hull().to_mesh()) for body in (pair.a, pair.b))
        most = _thickness(a, b, pair)
        figure = Figure(most, None, most)
    elif rung == "parts":
        of_a, of_b = (_parts(body) for body in (pair.a, pair.b))
        figure = Figure(_thickest(of_a, of_b, pair), None, None)
    else:
        return None
    return ThicknessRun(figure, perf_counter() - start)


def _surface(mesh: core.Mesh) -> core.Surface:
    return core.Surface(mesh, solid=True)


def _thickness(a: core.Surface, b: core.Surface, pair: Pair) -> float:
    settings = pair.settings
    width, work = settings.thickness_width, settings.thickness_work
    return max(core.search_thickness(a, b, width=width, work=work).upper, 0.0)


def _parts(body: PlacedBody) -> list[core.Mesh]:
    known = body.shared.decomposition.known
    if known is None or isinstance(known, SatcheckError):
        return [body.hull().to_mesh()]
    meshes = [part.to_mesh() for part in known.parts]
    transform = body.body.transform
    return meshes if transform is None else [mesh.transformed(transform) for mesh in meshes]


def _thickest(of_a: list[core.Mesh], of_b: list[core.Mesh], pair: Pair) -> float:
    """Pairs of parts whose boxes have no more in common than the thickest one are left out."""
    room = sorted(
        ((_room(a, b), i, j) for i, a in enumerate(of_a) for j, b in enumerate(of_b)), reverse=True
    )
    most = 0.0
    for space, i, j in room:
        if space <= most:
            break
        most = max(most, _thickness(_surface(of_a[i]), _surface(of_b[j]), pair))
    return most


def _room(a: core.Mesh, b: core.Mesh) -> float:
    """No ball in both boxes has a larger diameter."""
    (low, high), (least, most) = a.bounds, b.bounds
    return min(map(_common, low, high, least, most), default=math.inf)


def _common(low: float, high: float, least: float, most: float) -> float:
    return min(high, most) - max(low, least)
