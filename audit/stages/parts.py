"""Convex parts of bodies, for `--accuracy parts`: the relation, and the lower bound of a depth.
`part_pairs.py` lists them for `--parts`.

Parts differ from a mesh by a measured error. An overlap deeper than that error is proven; any other
answer is an estimate. A translation that frees A also frees every convex body inside A from every
convex body inside B. So the depth of the deepest such pair is a proven lower bound of the depth.
The bodies are shrunken copies of convex parts (satcheck.decompose), each proven to lie inside its
mesh.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck import core
from satcheck.audit.body import Box, PlacedBody, box_escape, largest_coordinate
from satcheck.audit.draft import Draft
from satcheck.audit.pair import Pair
from satcheck.core.rounding import rounding_pad
from satcheck.report.report import Relation

if TYPE_CHECKING:
    from satcheck.decompose import Decomposition


class Part(Struct, frozen=True):
    """A convex body in the world frame, with its box. pose: of a curved shape; None: the shape lies
    in the world."""

    shape: core.Shape
    bounds: Box
    pose: tuple[float, ...] | None = None


class Covering(Struct, frozen=True):
    """Convex parts that replace a mesh. They stick out of the mesh by at most `outside`, and the
    mesh sticks out of them by at most `missing`. World units."""

    parts: list[Part]
    outside: float
    missing: float


def decomposition(draft: Draft, body: PlacedBody) -> Decomposition | None:
    """The convex parts of the body's file, in file coordinates; None, and a warning, on failure."""
    from satcheck.decompose import DecompositionError

    decomposed = body.shared.decomposition()
    if isinstance(decomposed, DecompositionError):
        draft.complain(decomposed.code, body.id, f"no convex parts: {decomposed.message}")
        return None
    return decomposed


def why_no_parts(pair: Pair) -> str | None:
    """Return why the bodies are not split; None: they can be."""
    for body in (pair.a, pair.b):
        if body.endless:
            return f"a half space has no end: {body.id}"
        if not body.solid:
            return f"a mesh that is not solid has no inside to fill: {body.id}"
        if body.curved is None and body.shared.has_sheets():
            return f"a sheet has no inside to fill, and parts leave it out: {body.id}"
    return None


def split_together(pair: Pair) -> None:
    """Decomposes both bodies in parallel, each in a process of its own. The bodies' files keep the
    result or the failure.
    """
    bodies = (body for body in (pair.a, pair.b) if body.curved is None)
    waiting = [body.shared for body in bodies if not body.convex]
    if len(waiting) < 2 or waiting[0] is waiting[1] or pair.settings.jobs == 1:
        return
    from satcheck.audit.parallel import in_parallel

    list(in_parallel(lambda shared: shared.decomposition(), waiting, len(waiting)))


def inner_parts(draft: Draft, body: PlacedBody) -> list[Part]:
    """Parts proven to lie inside the body's mesh, up to the rounding of the pose; may be empty."""
    if body.convex:
        return [Part(body.hull_shape(), body.bounds)]
    decomposed = decomposition(draft, body)
    return (
        []
        if decomposed is None
        else [_placed(part, body) for part in decomposed.inner if part is not None]
    )


def covering(draft: Draft, body: PlacedBody) -> Covering | None:
    if body.curved is not None:
        part = Part(body.curved.shape, body.bounds, body.curved.pose)
        return Covering([part], body.curved.slack, body.curved.slack)
    if body.convex:
        return Covering([Part(body.hull_shape(), body.bounds)], 0.0, 0.0)
    decomposed = decomposition(draft, body)
    if decomposed is None:
        return None
    stretch = body.largest_stretch
    return Covering(
        [_placed(part, body) for part in decomposed.parts],
        decomposed.outside * stretch,
        decomposed.missing * stretch,
    )


def _placed(part: core.Polytope, body: PlacedBody) -> Part:
    mesh = part.to_mesh()
    if body.body.transform is not None:
        mesh = mesh.transformed(body.body.transform)
    return Part(core.Hull(mesh.convex_hull()), mesh.bounds)


def depth_of_parts(draft: Draft) -> float:
    """A proven lower bound of the depth, world units, by the inner parts of the bodies."""
    pair = draft.pair
    split_together(pair)
    bodies = [inner_parts(draft, body) for body in (pair.a, pair.b)]
    counts = f"{len(bodies[0])} and {len(bodies[1])} inner parts"
    if not (bodies[0] and bodies[1]):
        draft.record("parts", "failed", counts)
        return 0.0
    deepest = deepest_pair(bodies[0], bodies[1])
    draft.record("parts", "lower bound", f"at least {deepest:.6g} by {counts}")
    return deepest


def deepest_pair(parts_a: list[Part], parts_b: list[Part]) -> float:
    """A lower bound of the depth of the deepest pair, rounded down; 0.0: a body has no inner part,
    or no inner parts overlap.

    Pairs are tried in the order of the overlap of their boxes, which is an upper bound of the
    depth. The search ends when that bound is below the deepest pair so far.
    """
    bounds = [
        (box_escape(part_a.bounds, part_b.bounds)[0], i, j)
        for i, part_a in enumerate(parts_a)
        for j, part_b in enumerate(parts_b)
    ]
    bounds.sort(key=lambda bound: (-bound[0], bound[1], bound[2]))
    deepest = 0.0
    for most, i, j in bounds:
        if most <= deepest:
            break
        result = core.check_pair(parts_a[i].shape, parts_b[j].shape, query="depth")
        if result.outcome == "penetrating" and result.upper is not None:
            deepest = max(deepest, -result.upper)
    if deepest == 0.0:
        return 0.0
    boxes = [part.bounds for part in (*parts_a, *parts_b)]
    return max(deepest - rounding_pad(largest_coordinate(*boxes)), 0.0)


def settle_by_parts(draft: Draft) -> None:
    """Find how the bodies relate by their parts. It is proven if the measured error of the parts
    allows it; else it is an estimate."""
    draft.found("penetrating", False)
    pair = draft.pair
    if why_not := why_no_parts(pair):
        draft.record("parts", "not asked", why_not)
        return
    split_together(pair)
    covers = [covering(draft, body) for body in (pair.a, pair.b)]
    if covers[0] is None or covers[1] is None:
        draft.record("parts", "failed", "see the issues")
        return
    gap = _gap(covers[0], covers[1])
    proven_gap = gap - covers[0].missing - covers[1].missing
    count = f"{len(covers[0].parts)} and {len(covers[1].parts)} parts"
    if proven_gap > 0:
        draft.record("parts", "separated", f"{count}, apart by more than their error")
        draft.found("separated", True, proven_gap)
        return
    if deepest_pair(inner_parts(draft, pair.a), inner_parts(draft, pair.b)) > 0:
        draft.record("parts", "penetrating", f"{count}, of which two inside the meshes overlap")
        draft.found("penetrating", True)
        return
    relation: Relation = "separated" if gap > 0 else "penetrating"
    draft.record("parts", relation, f"{count}, within their error")
    draft.found(relation, False)


def _gap(a: Covering, b: Covering) -> float:
    """A lower bound of the distance of the nearest two parts, rounded down."""
    bounds = sorted(
        (core.box_gap(part_a.bounds, part_b.bounds), i, j)
        for i, part_a in enumerate(a.parts)
        for j, part_b in enumerate(b.parts)
    )
    nearest = math.inf
    for least, i, j in bounds:
        if least >= nearest:
            break
        result = core.check_pair(a.parts[i].shape, b.parts[j].shape, query="distance")
        if result.outcome != "separated" or result.lower is None:
            return 0.0
        nearest = min(nearest, result.lower)
    boxes = [part.bounds for part in (*a.parts, *b.parts)]
    return max(nearest - rounding_pad(largest_coordinate(*boxes)), 0.0)
