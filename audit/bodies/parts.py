"""Convex parts of a body in the world frame."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck import core
from satcheck.audit.bodies.boxes import Box
from satcheck.audit.bodies.pair import Pair
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.request.trace import Trace

if TYPE_CHECKING:
    from satcheck.decompose import Decomposition


class Part(Struct, frozen=True):
    """A convex body in the world frame, with its box."""

    shape: core.Shape
    bounds: Box


class Covering(Struct, frozen=True):
    """Convex parts that replace a mesh. They stick out of the mesh by at most `outside`, and the
    mesh sticks out of them by at most `missing`. World units."""

    parts: list[Part]
    outside: float
    missing: float


def decomposition(body: PlacedBody, trace: Trace) -> Decomposition | None:
    """The convex parts of the body's file, in file coordinates; None, and a warning, on failure."""
    from satcheck.decompose import DecompositionError

    decomposed = body.shared.decomposition()
    if isinstance(decomposed, DecompositionError):
        trace.complain(decomposed.code, body.id, f"no convex parts: {decomposed.message}")
        return None
    return decomposed


def split_together(pair: Pair) -> None:
    """Decomposes both bodies in parallel, each in a process of its own. The bodies' files keep the
    result or the failure.
    """
    waiting = [body.shared for body in (pair.a, pair.b) if not body.convex]
    if len(waiting) < 2 or waiting[0] is waiting[1] or pair.settings.jobs == 1:
        return
    from satcheck.audit.parallel import in_parallel

    list(in_parallel(lambda shared: shared.decomposition(), waiting, len(waiting)))


def inner_parts(body: PlacedBody, trace: Trace) -> list[Part]:
    """Parts proven to lie inside the body's mesh, up to the rounding of the pose; may be empty."""
    if body.convex:
        return [Part(body.hull_shape(), body.bounds)]
    decomposed = decomposition(body, trace)
    return (
        []
        if decomposed is None
        else [_placed(part, body) for part in decomposed.inner if part is not None]
    )


def covering(body: PlacedBody, trace: Trace) -> Covering | None:
    if body.convex:
        return Covering([Part(body.hull_shape(), body.bounds)], 0.0, 0.0)
    decomposed = decomposition(body, trace)
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
