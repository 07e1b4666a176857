"""The shortest way home for one body among others that stay where they are.

The others are taken as one mesh, and the translations of the body that free it of that are searched
as those of a pair are (`core.search_depth`): from where the scene has it, so that what is found is
the shortest translation there is, up to the width and the budget of the depth of a pair.
"""

from __future__ import annotations

import math

import numpy as np

from satcheck import core
from satcheck.audit.bodies.placed_body import PlacedBody
from satcheck.audit.figures.concave_depth import WORK_PER_SECOND
from satcheck.audit.figures.verify import FREE
from satcheck.audit.report.report import Vector
from satcheck.audit.resolve.crowd import ORIGIN, Crowd
from satcheck.core.conventions import axis_across

# More triangles than this around a body, and it is not tried.
MOST_TRIANGLES = 500_000


def way_alone(crowd: Crowd, i: int, longest: float) -> Vector | None:
    """A translation from home that leaves the body free of all others where these are, shorter than
    `longest`, world units; None: none was found, or bodies around have no inside, are curved, or
    may overlap it, or have to keep a clearance from it."""
    home, around = crowd.home[i], _around(crowd, i, longest)
    if around is None or not math.isfinite(longest):
        return None
    if not around:
        return ORIGIN
    obstacle = _as_one(around)
    if core.mesh_relation(home.surface(), obstacle).relation in FREE:
        return ORIGIN
    settings = crowd.settings
    return core.search_depth(
        home.surface(),
        obstacle,
        upper=longest,
        lower=0.0,
        width=settings.depth_width,
        work=math.ceil(settings.depth_budget * WORK_PER_SECOND),
        across=-1 if settings.planar is None else axis_across(settings.planar),
    ).way_out


def _around(crowd: Crowd, i: int, longest: float) -> list[PlacedBody] | None:
    """The bodies that it may meet within its longest way; None: not all of them are solid meshes
    that it only has to leave."""
    home = crowd.home[i]
    found = []
    for j, other in enumerate(crowd.placed):
        if j == i or not crowd.is_asked((i, j)):
            continue
        if core.box_gap(home.bounds, other.bounds) - crowd.clearance((i, j)) > longest:
            continue
        if crowd.clearance((i, j)) or crowd.is_limited((i, j)):
            return None
        found.append(other)
    solid = all(body.solid and body.curved is None for body in (home, *found))
    few = sum(body.mesh.triangle_count for body in found) <= MOST_TRIANGLES
    return found if solid and few else None


def _as_one(bodies: list[PlacedBody]) -> core.Surface:
    if len(bodies) == 1:
        return bodies[0].surface()
    meshes = [body.mesh for body in bodies]
    firsts = np.cumsum([0, *(mesh.vertex_count for mesh in meshes)])
    triangles = [mesh.triangles + first for mesh, first in zip(meshes, firsts, strict=False)]
    mesh = core.Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate(triangles).astype(np.uint32),
    )
    return core.Surface(mesh, True)
