"""Whether bodies lie in the regions that rules name: a box, or any closed mesh.

In a convex region a body lies if no point of it is farther beyond a face than the tolerance. Into
another region a body that touches its walls is first shifted, by at most the tolerance. What is
proposed here is proven in exact arithmetic (`verify/inside.py`) before it is an answer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from time import perf_counter_ns
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from satcheck import core
from satcheck.audit.bodies.placed_bodies import PlacedBodies
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.request.settings import Settings
from satcheck.audit.severity import severity_of_answer
from satcheck.audit.statics.answers import rule_report
from satcheck.audit.statics.terms import contact_tolerance
from satcheck.core.conventions import Vector
from satcheck.core.curved.placed import rows_of
from satcheck.core.errors import SatcheckError
from satcheck.core.risky_steps import not_for_lack_of_memory
from satcheck.core.shapes import support
from satcheck.report.certificate import OnBody
from satcheck.report.regions import InsideFinding, Regions
from satcheck.report.report import OUTSIDE_REGION, REGION_OPEN, Issue
from satcheck.scene.statics import BodyTerms, terms_of
from satcheck.verify.exact import NotCertified, Rejected
from satcheck.verify.inside import check_answer

if TYPE_CHECKING:
    from satcheck.scene import Scene

Floats = NDArray[np.float64]

# Points of the surface of a body that are looked at, to find one outside of a concave region.
MOST_POINTS = 20_000
# A shift is a little shorter than the tolerance, because it is rounded.
SHIFT = 0.999
NO_SHIFT: Vector = (0.0, 0.0, 0.0)
SAME_WALL = 0.999  # the cosine between normals of one wall
SPARE = 1e-9  # relative, of a length that is measured in float64


def regions_of(scene: Scene, bodies: PlacedBodies, settings: Settings) -> Regions:
    """The answers to all rules `inside`. Raises SatcheckError: `planar-only`; `units-unknown` if
    bodies have no common unit."""
    if settings.planar is not None:
        raise SatcheckError("planar-only", "rules of regions need bodies in space: no --planar")
    scene.require_one_unit()
    started = perf_counter_ns()
    members = scene.in_order()
    terms = terms_of(members, scene.body_rules)
    tolerance = contact_tolerance(scene, list(bodies.placed.values()))
    question = _Question(bodies, tolerance, settings)
    findings = tuple(
        question.answer(k, own) for k, own in enumerate(terms) if _is_asked(bodies.ids[k], own)
    )
    return Regions(
        tolerance=tolerance,
        rules=tuple(map(rule_report, scene.body_rules)),
        findings=findings,
        microseconds=(perf_counter_ns() - started) / 1000.0,
    )


def _is_asked(id_: str, terms: BodyTerms) -> bool:
    """A region lies in no other one, and no body in itself."""
    return terms.value("inside") not in (None, id_) and not terms.value("region")


class _Question:
    def __init__(self, bodies: PlacedBodies, tolerance: float, settings: Settings) -> None:
        self.bodies, self.tolerance, self.settings = bodies, tolerance, settings
        self.index = {id_: k for k, id_ in enumerate(bodies.ids)}

    def answer(self, k: int, terms: BodyTerms) -> InsideFinding:
        rule = terms.rules["inside"]
        name = str(rule.inside)
        proposal = InsideFinding(
            body=self.bodies.ids[k], region=name, rule=rule.name, severity="none", answer="open"
        )
        try:
            finding = self._decided(proposal, k, self.index.get(name))
        except Exception as error:  # noqa: BLE001  the other bodies are still decided
            not_for_lack_of_memory(error)
            finding = _open(proposal, f"internal error: {type(error).__name__}: {error}")
        severity = severity_of_answer(finding.answer, terms.value("severity"))
        return replace(finding, severity=severity)

    def _decided(self, asked: InsideFinding, k: int, region: int | None) -> InsideFinding:
        if region is None:
            return _open(asked, f"no body has the id {asked.region!r}")
        for number in (k, region):
            if number in self.bodies.unusable:
                return _open(asked, self.bodies.unusable[number].reason)
        body, space = self.bodies.placed[k], self.bodies.placed[region]
        if space.curved is not None or not space.checked().world or not space.solid:
            return _open(asked, f"{asked.region} is not a closed mesh or a box")
        decide = self._in_convex if space.checked().convex else self._in_concave
        finding = decide(asked, body, space)
        return finding if finding.answer == "open" else self._proven(finding, body, space)

    def _proven(self, finding: InsideFinding, body: PlacedBody, space: PlacedBody) -> InsideFinding:
        try:
            check_answer(finding, body.checked(), space.checked(), self.tolerance)
        except (Rejected, NotCertified) as why:
            return _open(finding, f"not decided: {why}")
        return finding

    def _in_convex(
        self, asked: InsideFinding, body: PlacedBody, space: PlacedBody
    ) -> InsideFinding:
        beyond = max(_reach(body, normal) - height for normal, height in _faces(space))
        if beyond <= self.tolerance:
            return replace(asked, answer="yes")
        return _outside(asked, beyond)

    def _in_concave(
        self, asked: InsideFinding, body: PlacedBody, space: PlacedBody
    ) -> InsideFinding:
        if body.curved is not None:
            return _open(asked, "a curved shape in a region that is not convex")
        for shift in (NO_SHIFT, *_shifts(body, space, self.tolerance)):
            moved = body.mesh.translated(shift)
            relation = core.mesh_relation(core.Surface(moved, body.solid), space.surface())
            if relation.relation in ("inside", "coincident"):
                return replace(asked, answer="yes", shift=shift)
        distance, point = _farthest_outside(body, space)
        if point is None or distance <= self.tolerance:
            return _open(asked, "it does not lie in the region, or by no more than the tolerance")
        return replace(_outside(asked, distance), point=point)


def _reach(body: PlacedBody, normal: Floats) -> float:
    """How far the body reaches along a unit vector, from the origin."""
    if body.curved is None:
        return float((_points(body) @ normal).max())
    rows = np.array(rows_of(body.curved.turn))
    x, y, z = (normal @ rows).tolist()
    return float(normal @ np.array(body.curved.centre)) + support(body.curved.primitive, (x, y, z))


def _points(body: PlacedBody) -> Floats:
    return np.array(body.mesh.vertices)


def _corners(body: PlacedBody) -> Floats:
    """(t, 3, 3)"""
    return _points(body)[np.array(body.mesh.triangles, dtype=np.int64)]


def _faces(space: PlacedBody) -> list[tuple[Floats, float]]:
    """(outward unit normal, height of the plane) of the triangles that have an area."""
    corners = _corners(space)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(across, axis=1)
    normals = across[size > 0] / size[size > 0, None]
    heights = np.einsum("ti,ti->t", normals, corners[size > 0, 0])
    planes = np.unique(np.column_stack([normals, heights]), axis=0)
    return [(plane[:3], float(plane[3])) for plane in planes]


def _shifts(body: PlacedBody, space: PlacedBody, tolerance: float) -> Iterator[Vector]:
    """Away from all walls whose plane the body reaches up to the tolerance; none if there are no
    such walls."""
    low, high = (np.array(end) for end in body.bounds)
    corners, points = _corners(space), _points(body)
    near = (corners.min(axis=1) <= high + tolerance) & (corners.max(axis=1) >= low - tolerance)
    walls: list[Floats] = []
    for a, b, c in corners[near.all(axis=1)]:
        across = np.cross(b - a, c - a)
        size = float(np.linalg.norm(across))
        if size > 0:
            normal = across / size
            reaches = abs(float(((points - a) @ normal).max())) <= tolerance
            if reaches and all(normal @ wall < SAME_WALL for wall in walls):
                walls.append(normal)
    total = -np.sum(walls, axis=0) if walls else np.zeros(3)
    length = float(np.linalg.norm(total))
    if length > 0:
        x, y, z = (SHIFT * tolerance / length * total).tolist()
        yield x, y, z


def _farthest_outside(body: PlacedBody, space: PlacedBody) -> tuple[float, OnBody | None]:
    """The point of the surface of the body that is farthest outside, among its vertices and the
    middles of its edges and triangles, and its distance."""
    surface = space.surface()
    best: tuple[float, OnBody | None] = -math.inf, None
    for vertices, at in _looked_at(body):
        if surface.winding_number(at) == 0 and (distance := surface.nearest(at)[0]) > best[0]:
            share = f"1/{len(vertices)}"
            best = distance, OnBody(vertices=vertices, weights=(share,) * len(vertices))
    return best


def _looked_at(body: PlacedBody) -> Iterator[tuple[tuple[int, ...], Vector]]:
    """Points of the surface: the vertices whose middle they are, and their coordinates."""
    points, triangles = _points(body), np.array(body.mesh.triangles, dtype=np.int64)
    groups = [
        np.unique(triangles)[:, None],
        triangles,
        *(triangles[:, [i, i - 1]] for i in range(3)),
    ]
    step = max(1, sum(map(len, groups)) // MOST_POINTS)
    for group in groups:
        for vertices in group[::step]:
            x, y, z = points[vertices].mean(axis=0).tolist()
            yield tuple(vertices.tolist()), (x, y, z)


def region_issues(regions: Regions) -> Iterator[Issue]:
    """Bodies that fail or are open, for formats that only list pairs and issues."""
    for finding in regions.findings:
        if finding.answer != "yes":
            code = OUTSIDE_REGION if finding.answer == "no" else REGION_OPEN
            said = "not" if finding.answer == "no" else "perhaps not"
            message = f"{finding.body} is {said} {finding.question}: {finding.reason}"
            yield Issue(code, "warning", finding.body, None, message)


def _open(asked: InsideFinding, reason: str) -> InsideFinding:
    return replace(asked, answer="open", reason=reason, sticks_out=None, shift=None, point=None)


def _outside(asked: InsideFinding, by: float) -> InsideFinding:
    """By a little less than measured, so that it is proven in spite of rounding."""
    return replace(
        asked, answer="no", sticks_out=by * (1 - SPARE), reason=f"it sticks out by {by:.6g}"
    )
