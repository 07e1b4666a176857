"""The answer about a variant, mapped back to the frame of the original pair."""

from __future__ import annotations

import math

from msgspec import Struct
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.check import check
from satcheck.audit.request.settings import Settings
from satcheck.core.conventions import Vector
from satcheck.report.report import OVERLAPS, Finding, Quality, Relation, Report, Witness
from satcheck.scene import Body, Scene
from satcheck.studies.pair import Bodies, pair_of
from satcheck.studies.stability.variant import Rows, Variant

MIRRORED: dict[Relation, Relation] = {"contains": "inside", "inside": "contains"}
NESTED = frozenset({"contains", "inside"})


class Answer(Struct, frozen=True):
    """relation: the exact one; indeterminate, with a reason, where it is not proven.

    distance: of bodies that do not overlap. depth_bounds, thickness_bounds: proven, of bodies that
    do; the thickness only of closed ones. hold: the
    relation stays while the surfaces are moved by less than this, together; but an overlap whose
    surfaces cross may become a nesting. largest: the largest coordinate of the world meshes.
    convex: both bodies are; None where it was not needed. Lengths in the units of the files.
    """

    relation: Relation
    largest: float
    convex: bool | None = None
    distance: float | None = None
    depth_bounds: tuple[float, float] | None = None
    thickness_bounds: tuple[float, float] | None = None
    mtv: Vector | None = None
    normal: Vector | None = None
    witness: Witness | None = None
    hold: float = 0.0
    quality: Quality | None = None
    reason: str | None = None

    @property
    def signed(self) -> tuple[float, float] | None:
        """Bounds of the signed distance: > 0 a gap, < 0 an overlap."""
        if self.distance is not None:
            return self.distance, self.distance
        bounds = self.depth_bounds
        return None if bounds is None else (-bounds[1], -bounds[0])


def ask(variant: Variant, settings: Settings) -> Answer:
    """The variant's answer, taken back. Never raises for what a check reports as a result."""
    bodies = (variant.b, variant.a) if variant.swapped else (variant.a, variant.b)
    largest = max(_largest_coordinate(body) for body in bodies)
    report = check(Scene("stability", None, bodies), _with_reach(settings, largest))
    return _taken_back(_answer(report, bodies, largest), variant)


def _with_reach(settings: Settings, largest: float) -> Settings:
    """Measures every gap: a clearance beyond any, a power of two, so that it scales with the pair;
    no touch band, because stability is about the exact relation."""
    reach = math.ldexp(1.0, math.frexp(largest)[1] + 2)
    return replace(settings, clearance=reach, tolerance=0.0, list_pruned=True, jobs=1)


def _largest_coordinate(body: Body) -> float:
    return max(abs(c) for corner in body.world_mesh().bounds for c in corner)


def _answer(report: Report, bodies: Bodies, largest: float) -> Answer:
    (finding,) = report.findings
    relation = finding.exact_relation
    if finding.relation == "indeterminate" or relation is None:
        return Answer("indeterminate", largest, reason=finding.reason or "not proven")
    convex = [body.convex for body in report.bodies]
    return Answer(
        relation,
        largest,
        convex=None if None in convex else all(convex),
        distance=finding.distance,
        depth_bounds=finding.depth_bounds,
        thickness_bounds=finding.thickness_bounds,
        mtv=finding.mtv,
        normal=finding.normal,
        witness=finding.witness,
        hold=_hold(relation, finding, bodies),
        quality=finding.quality,
    )


def _hold(relation: Relation, finding: Finding, bodies: Bodies) -> float:
    """Surfaces apart stay apart until they have come that far; two triangles that cross go on
    crossing until they have been drawn that far, as any two convex sets."""
    if relation == "separated":
        return finding.distance or 0.0
    if relation not in OVERLAPS:
        return 0.0
    pair = pair_of(bodies, Settings())
    a, b = pair.a.surface(), pair.b.surface()
    if relation in NESTED:
        return core.mesh_distance(a, b).distance
    crossing = core.mesh_relation(a, b)
    if crossing.triangle_a < 0 or crossing.triangle_b < 0:
        return 0.0
    return core.crossing_depth(a, b, crossing.triangle_a, crossing.triangle_b)


def _taken_back(answer: Answer, variant: Variant) -> Answer:
    """In the frame, the unit and the order of the pair as given."""
    by = 1.0 / variant.scale  # a power of two: exact
    sign = -1.0 if variant.swapped else 1.0
    relation, witness = answer.relation, answer.witness
    points = None if witness is None else [_scaled(point, by) for point in (witness.a, witness.b)]
    if variant.swapped:
        relation = MIRRORED.get(relation, relation)
        points = points and points[::-1]
    return replace(
        answer,
        relation=relation,
        largest=answer.largest * by,
        distance=None if answer.distance is None else answer.distance * by,
        depth_bounds=_interval(answer.depth_bounds, by),
        thickness_bounds=_interval(answer.thickness_bounds, by),
        mtv=_turned_back(answer.mtv, variant.turn, sign * by),
        normal=_turned_back(answer.normal, variant.turn, sign),
        witness=None if points is None else Witness(*points),
        hold=answer.hold * by,
    )


def _interval(bounds: tuple[float, float] | None, by: float) -> tuple[float, float] | None:
    return None if bounds is None else (bounds[0] * by, bounds[1] * by)


def _turned_back(vector: Vector | None, turn: Rows, by: float) -> Vector | None:
    if vector is None:
        return None
    x, y, z = (sum(turn[row][k] * vector[row] for row in range(3)) for k in range(3))
    return _scaled((x, y, z), by)


def _scaled(vector: Vector, by: float) -> Vector:
    return vector[0] * by + 0.0, vector[1] * by + 0.0, vector[2] * by + 0.0
