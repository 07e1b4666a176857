"""Computes parts, inner parts and errors, holds stored ones against their mesh, and fits them to
limits."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Final

import numpy as np
from msgspec.structs import replace

from satcheck.core import Mesh, Polytope, Surface
from satcheck.core.transform import Transform
from satcheck.core.worker import (
    WorkerError,
    WorkerFailed,
    WorkerOutOfMemory,
    WorkerTimeout,
    run_isolated,
)
from satcheck.decompose import errors
from satcheck.decompose.coacd_server import decode_reply, encode_request
from satcheck.decompose.components import diagonal, independent_pieces, oriented
from satcheck.decompose.enclosing import enclosing_parts
from satcheck.decompose.error_bounds import missing_error, outside_error
from satcheck.decompose.errors import Deadline, DecompositionError
from satcheck.decompose.fitting import merged_parts, simplified
from satcheck.decompose.inner_parts import inner_parts, is_inside
from satcheck.decompose.result import (
    FLAT_PARTS_DROPPED,
    NOT_SOLID,
    REMESHED,
    Decomposition,
    Note,
    Stored,
)
from satcheck.decompose.settings import DecompositionSettings, Limits

_SERVER: Final = "satcheck.decompose.coacd_server"
# A piece this close to its hull, in diagonals of its bounding box, is one part. CoACD at the same
# threshold leaves an error of about 0.3 * threshold, and moves its cuts by up to 1e-4 to avoid
# vertices.
_CONVEX_ENOUGH_PER_THRESHOLD: Final = 0.05
_CONVEX_ENOUGH: Final = 1e-4


def compute(
    mesh: Mesh, settings: DecompositionSettings, seconds: float, megabytes: int
) -> Decomposition:
    """Computes the parts of a welded mesh. Raises DecompositionError."""
    started, deadline = time.monotonic(), Deadline(seconds)
    solid = mesh.topology().solid
    convex, concave = _sorted_pieces(mesh, settings.threshold) if solid else ([], [mesh])
    coacd_parts = _run_coacd(concave, settings, deadline, megabytes) if concave else []
    parts = convex + [hull for hull in coacd_parts if hull.dimension == 3]
    if not parts:
        raise DecompositionError(errors.BAD_OUTPUT, "CoACD returned no solid convex part")
    surface = Surface(mesh, solid)
    return Decomposition(
        parts=tuple(parts),
        inner=inner_parts(parts, surface, deadline) if solid else (None,) * len(parts),
        outside=outside_error(parts, surface, settings.threshold),
        missing=missing_error(mesh, parts, deadline),
        seconds=time.monotonic() - started,
        from_cache=False,
        settings=settings,
        notes=tuple(_notes(solid, concave, dropped=len(convex) + len(coacd_parts) - len(parts))),
    )


def held_against(
    mesh: Mesh, stored: Stored, settings: DecompositionSettings, seconds: float
) -> Decomposition | None:
    """Measure the stored parts of a welded mesh again; None: they are not those of this mesh.

    What is measured costs about a twentieth of what made the parts. Raises DecompositionError.
    """
    solid = mesh.topology().solid
    surface = Surface(mesh, solid)
    inner = (part for part in stored.inner if part is not None)
    if not all(solid and is_inside(part, surface) for part in inner):
        return None
    outside = outside_error(stored.parts, surface, settings.threshold)
    missing = missing_error(mesh, stored.parts, Deadline(seconds))
    if solid and max(outside, missing) > settings.threshold * diagonal(mesh):
        return None  # CoACD leaves about a third of this
    return Decomposition(
        stored.parts, stored.inner, outside, missing, stored.seconds, True, settings, stored.notes
    )


def placed(
    mesh: Mesh, result: Decomposition, transform: Transform | None, limits: Limits, seconds: float
) -> Decomposition:
    """Place the parts of a mesh with it, and fit them to limits. What is new is not cached.

    mesh: as placed. transform: affine, of the mesh that was split; None: it stands where it was.
    The errors are measured again, of the mesh as placed. seconds: the limit for all this. Raises
    DecompositionError, and ValueError on overflow.
    """
    if transform is None and limits == Limits():
        return result
    mesh, deadline, parts = oriented(mesh), Deadline(seconds), result.parts
    if transform is not None:
        moved = (part.to_mesh().transformed(transform) for part in parts)
        parts = tuple(part.convex_hull() for part in moved)
    if limits.parts is not None:
        parts = merged_parts(parts, limits.parts, deadline)
    if limits.enclose:
        parts = enclosing_parts(mesh, parts, limits.vertices, deadline)
    elif limits.vertices is not None:
        parts = tuple(
            simplified(np.asarray(part.vertices), limits.vertices, deadline) for part in parts
        )
    surface = Surface(mesh, mesh.topology().solid)
    return replace(
        result,
        parts=parts,
        inner=(None,) * len(parts),
        outside=outside_error(parts, surface, result.settings.threshold),
        missing=0.0 if limits.enclose else missing_error(mesh, parts, deadline),
    )


def _notes(solid: bool, concave: list[Mesh], *, dropped: int) -> Iterator[Note]:
    if not solid:
        yield Note(
            NOT_SOLID,
            "the mesh has no inside: the error of its parts is measured against its surface, and "
            "there are no inner parts",
        )
    if not all(piece.topology().manifold for piece in concave):
        yield Note(
            REMESHED,
            "the mesh is not a closed manifold: it was rebuilt from voxels first, which takes long "
            "and thickens it",
        )
    if dropped:
        yield Note(FLAT_PARTS_DROPPED, f"{dropped} flat parts of CoACD were dropped")


def _sorted_pieces(mesh: Mesh, threshold: float) -> tuple[list[Polytope], list[Mesh]]:
    """(the pieces that are nearly convex, as hulls; the other pieces)."""
    enough = max(_CONVEX_ENOUGH, _CONVEX_ENOUGH_PER_THRESHOLD * threshold)
    convex, concave = [], []
    for piece in independent_pieces(mesh):
        limit = enough * diagonal(piece)
        if piece.convexity_defect(limit) <= limit:
            convex.append(piece.convex_hull())
        else:
            concave.append(piece)
    return convex, concave


def _run_coacd(
    meshes: list[Mesh],
    settings: DecompositionSettings,
    deadline: Deadline,
    megabytes: int,
) -> list[Polytope]:
    """The parts of all meshes, flat ones included."""
    request = encode_request(settings, meshes)
    try:
        reply = run_isolated(_SERVER, request, seconds=deadline.left, megabytes=megabytes)
    except WorkerTimeout as error:
        raise deadline.error() from error
    except WorkerError as error:
        raise _explained(error) from error
    try:
        return [Mesh.from_bytes(*part).convex_hull() for part in decode_reply(reply)]
    except ValueError as error:
        raise DecompositionError(
            errors.BAD_OUTPUT, f"CoACD returned parts that are not meshes: {error}"
        ) from error


def _explained(error: WorkerError) -> DecompositionError:
    """The error of the child as a DecompositionError."""
    if isinstance(error, WorkerOutOfMemory):
        return DecompositionError(
            errors.OUT_OF_MEMORY,
            f"the convex parts need more than {error.megabytes} MiB; raise the "
            "threshold (`satcheck decompose --threshold`)",
        )
    code = errors.FAILED if isinstance(error, WorkerFailed) else errors.CRASHED
    return DecompositionError(code, f"CoACD gave no convex parts: {error.message}")
