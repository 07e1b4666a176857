"""What a check said about a pair, in the frame in which the question was first asked."""

from __future__ import annotations

import math

from msgspec import Struct
from msgspec.structs import replace

from satcheck import core
from satcheck.audit.asked.planner import asked_by
from satcheck.audit.asked.settings import Settings
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody, SharedMesh
from satcheck.audit.bodies.triangles import crossing_depth
from satcheck.audit.check import check
from satcheck.audit.report.report import (
    OVERLAPS,
    Finding,
    Quality,
    Relation,
    Report,
    Vector,
    Witness,
)
from satcheck.scene import Body, Scene
from satcheck.studies.stability.variant import Rows, Variant

MIRRORED: dict[Relation, Relation] = {"contains": "inside", "inside": "contains"}
NESTED = frozenset({"contains", "inside"})


class Answer(Struct, frozen=True):
    """relation: the exact one; indeterminate, with a reason, where it is not proven.

    gap: of bodies that do not overlap. depth: proven bounds, of overlapping ones. hold: however the
    surfaces are moved, by less than this together, the relation stays, except that an overlap whose
    surfaces cross may become nested. largest: the largest coordinate of the world meshes. convex:
    both bodies are; None where it was not needed. Lengths in the units of the files.
    """

    relation: Relation
    largest: float
    convex: bool | None = None
    gap: float | None = None
    depth: tuple[float, float] | None = None
    mtv: Vector | None = None
    normal: Vector | None = None
    witness: Witness | None = None
    hold: float = 0.0
    quality: Quality | None = None
    reason: str | None = None

    @property
    def signed(self) -> tuple[float, float] | None:
        """Bounds of the signed distance: > 0 a gap, < 0 an overlap."""
        if self.gap is not None:
            return self.gap, self.gap
        return None if self.depth is None else (-self.depth[1], -self.depth[0])


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


def _answer(report: Report, bodies: tuple[Body, Body], largest: float) -> Answer:
    (finding,) = report.findings
    relation = finding.exact_relation
    if finding.relation == "indeterminate" or relation is None:
        return Answer("indeterminate", largest, reason=finding.reason or "not proven")
    known = [one.convex for one in report.bodies]
    return Answer(
        relation,
        largest,
        convex=None if None in known else all(known),
        gap=finding.distance,
        depth=finding.depth_bounds,
        mtv=finding.mtv,
        normal=finding.normal,
        witness=finding.witness,
        hold=_hold(relation, finding, bodies),
        quality=finding.quality,
    )


def _hold(relation: Relation, finding: Finding, bodies: tuple[Body, Body]) -> float:
    """Surfaces apart stay apart until they have come that far; two triangles that cross go on
    crossing until they have been drawn that far, as any two convex sets."""
    if relation == "separated":
        return finding.distance or 0.0
    if relation not in OVERLAPS:
        return 0.0
    pair = _pair(bodies)
    if relation in NESTED:
        return core.mesh_distance(pair.a.surface(), pair.b.surface()).distance
    found = core.mesh_relation(pair.a.surface(), pair.b.surface())
    if found.triangle_a < 0 or found.triangle_b < 0:
        return 0.0
    return crossing_depth(pair, (found.triangle_a, found.triangle_b))


def touch_band(bodies: tuple[Body, Body]) -> float:
    """Of a plain check of the two."""
    return _pair(bodies).tolerance


def _pair(bodies: tuple[Body, Body]) -> Pair:
    settings = Settings()
    a, b = (PlacedBody(one, SharedMesh(one.file, settings)) for one in bodies)
    return Pair(a, b, settings, asked_by(settings))


def _taken_back(answer: Answer, variant: Variant) -> Answer:
    by = 1.0 / variant.scale  # a power of two: exact
    sign = -1.0 if variant.swapped else 1.0
    depth, witness = answer.depth, answer.witness
    if witness is not None:
        a, b = _scaled(witness.a, by), _scaled(witness.b, by)
        witness = Witness(b, a) if variant.swapped else Witness(a, b)
    return Answer(
        MIRRORED.get(answer.relation, answer.relation) if variant.swapped else answer.relation,
        answer.largest * by,
        convex=answer.convex,
        gap=None if answer.gap is None else answer.gap * by,
        depth=None if depth is None else (depth[0] * by, depth[1] * by),
        mtv=_turned_back(answer.mtv, variant.turn, sign * by),
        normal=_turned_back(answer.normal, variant.turn, sign),
        witness=witness,
        hold=answer.hold * by,
        quality=answer.quality,
        reason=answer.reason,
    )


def _turned_back(vector: Vector | None, turn: Rows, by: float) -> Vector | None:
    if vector is None:
        return None
    x, y, z = (sum(turn[row][k] * vector[row] for row in range(3)) for k in range(3))
    return _scaled((x, y, z), by)


def _scaled(vector: Vector, by: float) -> Vector:
    return vector[0] * by + 0.0, vector[1] * by + 0.0, vector[2] * by + 0.0
