"""Two placed bodies for the tests of a sweep, made of small meshes."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from satcheck.audit.body import Box, PlacedBody, SharedMesh
from satcheck.audit.motion.impact import first_impact as scanned
from satcheck.audit.motion.moving_pair import MovingPair, OpenStretches
from satcheck.audit.motion.open_stretches import open_stretches
from satcheck.audit.motion.sweep import sweep as swept
from satcheck.audit.motion.track import TrackTravel
from satcheck.audit.pair import Pair
from satcheck.audit.planner import request_for
from satcheck.audit.settings import Settings
from satcheck.core import Mesh
from satcheck.report.sweep import Sweep
from satcheck.scene.motion import Motion
from satcheck.scene.motion import Path as MotionPath
from tests.audit.shapes import Mesh as Lists
from tests.audit.shapes import scene_of


def pair_of(a: Lists, b: Lists, **settings: object) -> Pair:
    """Called "a" and "b"."""
    asked = Settings(**settings)  # type: ignore[arg-type]
    with tempfile.TemporaryDirectory() as folder:
        scene = scene_of(Path(folder), a=a, b=b)
    placed = [PlacedBody(body, SharedMesh(body.file, asked)) for body in scene.bodies]
    return Pair(placed[0], placed[1], asked, request_for(asked))


def moving(
    a: Lists,
    path_a: MotionPath | None,
    b: Lists,
    path_b: MotionPath | None = None,
    **settings: object,
) -> MovingPair:
    pair = pair_of(a, b, **settings)
    travel = travel_of(pair, path_a, path_b)
    whole = OpenStretches(tuple(pairwise(travel.times.tolist())))
    return MovingPair(pair, travel, whole)


def travel_of(pair: Pair, path_a: MotionPath | None, path_b: MotionPath | None) -> TrackTravel:
    """None: the body is at rest."""
    paths = ((pair.a, path_a), (pair.b, path_b))
    motions = [Motion((body.id,), path) for body, path in paths if path is not None]
    return TrackTravel(motions, [pair.a, pair.b])


def sweep(pair: Pair, path_a: MotionPath | None, path_b: MotionPath | None) -> Sweep:
    """None: the body is at rest."""
    travel = travel_of(pair, path_a, path_b)
    (found,) = open_stretches(travel, [pair])
    return swept(pair, travel, found)


class Boxed(NamedTuple):
    """As much of a placed body as its travel needs."""

    id: str
    bounds: Box
    curved: None = None
    body: Any = SimpleNamespace(transform=None)


def boxes_on(*moving: tuple[Box, MotionPath | None]) -> TrackTravel:
    """Bodies "0", "1" ... with these boxes as placed, on these paths. None: the body is at rest."""
    bodies: Any = [Boxed(str(k), bounds) for k, (bounds, _) in enumerate(moving)]
    paths = [path for _, path in moving]
    motions = [Motion((str(k),), path) for k, path in enumerate(paths) if path is not None]
    return TrackTravel(motions, bodies)


class Impact(NamedTuple):
    """What the scan for the first impact says."""

    lower: float
    upper: float | None
    reached: float
    contact: float | None
    reason: str | None

    @property
    def free(self) -> bool:
        return self.upper is None and self.reason is None


def first_impact(pair: MovingPair) -> Impact:
    found = scanned(pair)
    lower, upper = found.time_of_impact or (found.reached, None)
    return Impact(lower, upper, found.reached, found.contact, found.reason)


def hull_of(points: Sequence[Sequence[float]]) -> Lists:
    """The convex hull of the points as a mesh, its faces outward."""
    cloud = np.ascontiguousarray(points, dtype=np.float64)
    mesh = Mesh(cloud, np.array([[0, 1, 2]], dtype=np.uint32)).convex_hull().to_mesh()
    return mesh.vertices.tolist(), [tuple(t) for t in mesh.triangles.tolist()]
