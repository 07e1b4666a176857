"""Whether bodies lie in the regions that rules name: a box, or any closed mesh.

In a convex region a body lies if no point of it is farther beyond a face than the tolerance. Into
another region a body that touches its walls is first shifted, by at most the tolerance. What is
proposed here is proven in exact arithmetic (`verify/answers.py`) before it is an answer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from itertools import chain
from time import perf_counter_ns
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.bodies import PlacedBodies
from satcheck.audit.body import PlacedBody
from satcheck.audit.settings import Settings
from satcheck.audit.statics.answers import rule_report
from satcheck.audit.statics.subjects import contact_tolerance
from satcheck.core.conventions import Vector
from satcheck.core.errors import SatcheckError
from satcheck.core.steps import not_for_lack_of_memory
from satcheck.report.certificate import OnBody
from satcheck.report.regions import InsideFinding, Regions
from satcheck.report.verdict import severity_of_answer
from satcheck.scene.statics import terms_of
from satcheck.verify.answers import check_answer
from satcheck.verify.exact import NotCertified, Rejected

if TYPE_CHECKING:
    from satcheck.scene import Scene

Floats = NDArray[np.float64]

# Points of the surface of a body that are looked at, to find one outside of a concave region.
MOST_POINTS = 20_000
# A shift is a little shorter than the tolerance, because it is rounded.
SHIFT = 0.999
NO_SHIFT: Vector = (0.0, 0.0, 0.0)
SAME_WALL = 6  # decimals of the unit normals of one wall that agree
SPARE = 1e-9  # relative, of a length that is measured in float64


def regions_of(scene: Scene, bodies: PlacedBodies, settings: Settings) -> Regions:
    """The answers to all rules `inside`. Raises SatcheckError: `planar-only`; `units-unknown` if
    bodies have no common unit."""
    if settings.planar is not None:
        raise SatcheckError("planar-only", "rules of regions need bodies in space: no --planar")
    scene.require_one_unit()
    started = perf_counter_ns()
    terms = dict(zip(bodies.ids, terms_of(scene.in_order(), scene.body_rules), strict=True))
    tolerance = contact_tolerance(scene, list(bodies.placed.values()))
    places = {id_: k for k, id_ in enumerate(bodies.ids)}
    findings = []
    for id_, own in terms.items():
        region = own.region_for(id_)
        if region is None:
            continue
        rule = own.rules["inside"].name
        asked = InsideFinding(body=id_, region=region, rule=rule, severity="none", answer="open")
        found = _answer(asked, bodies, places, tolerance)
        severity = severity_of_answer(found.answer, own.value("severity"))
        findings.append(replace(found, severity=severity))
    return Regions(
        tolerance=tolerance,
        rules=tuple(map(rule_report, scene.body_rules)),
        findings=tuple(findings),
        microseconds=(perf_counter_ns() - started) / 1000.0,
    )


def _answer(
    asked: InsideFinding, bodies: PlacedBodies, places: Mapping[str, int], tolerance: float
) -> InsideFinding:
    """Return the finding with an answer that is proven, or open for a reason."""
    if asked.region not in places:
        return replace(asked, reason=f"no body has the id {asked.region!r}")
    k, region = places[asked.body], places[asked.region]
    for number in (k, region):
        if number in bodies.unusable:
            return replace(asked, reason=bodies.unusable[number].reason)
    body, space = bodies.placed[k], bodies.placed[region]
    try:
        finding = _proposed(asked, body, space, tolerance)
        if finding.answer != "open":
            check_answer(finding, body.checked(), space.checked(), tolerance)
        return finding
    except (Rejected, NotCertified) as why:
        return replace(asked, reason=f"not decided: {why}")
    except Exception as error:  # noqa: BLE001  the other bodies are still decided
        not_for_lack_of_memory(error)
        return replace(asked, reason=f"internal error: {type(error).__name__}: {error}")


def _proposed(
    asked: InsideFinding, body: PlacedBody, space: PlacedBody, tolerance: float
) -> InsideFinding:
    """Return an answer that is to be proven."""
    if space.curved is not None or not space.checked().world or not space.solid:
        return replace(asked, reason=f"{asked.region} is not a closed mesh or a box")
    if space.checked().convex:
        beyond = float(_beyond(body, _planes(_corners(space))).max())
        return replace(asked, answer="yes") if beyond <= tolerance else _outside(asked, beyond)
    if body.curved is not None:
        return replace(asked, reason="a curved shape in a region that is not convex")
    for shift in (NO_SHIFT, _shift(body, space, tolerance)):
        moved = core.Surface(body.mesh.translated(shift), body.solid)
        if core.mesh_relation(moved, space.surface()).relation in ("inside", "coincident"):
            return replace(asked, answer="yes", shift=shift)
    distance, point = _farthest_outside(body, space)
    if point is not None and distance > tolerance:
        return _outside(asked, distance, point)
    reason = "it does not lie in the region, or by no more than the tolerance"
    return replace(asked, reason=reason)


def _outside(asked: InsideFinding, by: float, point: OnBody | None = None) -> InsideFinding:
    """Return that the body sticks out, by a little less than measured: that is proven in spite of
    rounding."""
    reason = f"it sticks out by {by:.6g}"
    return replace(asked, answer="no", sticks_out=by * (1 - SPARE), reason=reason, point=point)


def _beyond(body: PlacedBody, planes: Floats) -> Floats:
    """Return how far the body reaches beyond each plane."""
    curved, points = body.checked().curved, np.asarray(body.mesh.vertices)
    reaches = []
    for normal in planes[:, :3]:
        if curved is None:
            reaches.append(float((points @ normal).max()))
        else:
            x, y, z = map(Fraction, normal.tolist())
            reach = curved.reach((x, y, z))
            reaches.append(float(reach.q) + math.sqrt(reach.p))
    return np.array(reaches) - planes[:, 3]


def _corners(body: PlacedBody) -> Floats:
    """(t, 3, 3)"""
    return np.asarray(body.mesh.vertices)[np.asarray(body.mesh.triangles)]


def _planes(corners: Floats) -> Floats:
    """(n, 4): the outward unit normals of the triangles that have an area, and the heights of their
    planes."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    normals = across[size > 0] / size[size > 0, None]
    heights = np.einsum("ti,ti->t", normals, corners[size > 0, 0])
    return np.unique(np.column_stack([normals, heights]), axis=0)


def _shift(body: PlacedBody, space: PlacedBody, tolerance: float) -> Vector:
    """Away from all walls whose plane the body reaches up to the tolerance."""
    low, high = (np.array(end) for end in body.bounds)
    corners = _corners(space)
    near = (corners.min(axis=1) <= high + tolerance) & (corners.max(axis=1) >= low - tolerance)
    planes = _planes(corners[near.all(axis=1)])
    walls = planes[np.abs(_beyond(body, planes)) <= tolerance, :3]
    inwards = -np.unique(walls.round(SAME_WALL), axis=0).sum(axis=0)
    length = float(np.linalg.norm(inwards))
    if length == 0:
        return NO_SHIFT
    x, y, z = (SHIFT * tolerance / length * inwards).tolist()
    return x, y, z


def _farthest_outside(body: PlacedBody, space: PlacedBody) -> tuple[float, OnBody | None]:
    """The point of the surface of the body that is farthest outside, among its vertices and the
    middles of its edges and triangles, and its distance."""
    surface, points = space.surface(), np.asarray(body.mesh.vertices)
    triangles = np.asarray(body.mesh.triangles)
    edges = (triangles[:, [i, i - 1]] for i in range(3))
    groups = (np.unique(triangles)[:, None], triangles, *edges)
    step = max(1, sum(map(len, groups)) // MOST_POINTS)
    best: tuple[float, OnBody | None] = -math.inf, None
    for vertices in chain.from_iterable(group[::step].tolist() for group in groups):
        x, y, z = points[vertices].mean(axis=0).tolist()
        at = (x, y, z)
        if surface.winding_number(at) == 0 and (distance := surface.nearest(at)[0]) > best[0]:
            weights = (f"1/{len(vertices)}",) * len(vertices)
            best = distance, OnBody(vertices=tuple(vertices), weights=weights)
    return best
