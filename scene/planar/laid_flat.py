"""A scene seen in a plane: each body becomes the prism over its outline."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from satcheck.core import Mesh
from satcheck.core.conventions import Plane, axes_of, axis_across
from satcheck.core.errors import SatcheckError
from satcheck.scene.bodies import Body, MeshFile, Scene, Unreadable
from satcheck.scene.drawing import DRAWINGS
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import examine
from satcheck.scene.issue import issue
from satcheck.scene.planar.prism import prism
from satcheck.scene.planar.region import (
    Region,
    convex_corners,
    drawn_region,
    fan_of,
    region_of,
)
from satcheck.scene.planar.turns import Floats

# How many times the widest body the prisms are high: nothing that separates two bodies in the
# plane is longer than both are wide together.
_HEIGHT = 4.0


def laid_flat(scene: Scene, plane: Plane) -> Scene:
    """The bodies as they are placed, as prisms across the plane; answers lie in the plane.

    A body without an outline (all its triangles are seen edge on) is unreadable from then on.
    Raises SatcheckError (`planar-motion`): bodies that move leave the plane.
    """
    if scene.motions:
        raise SatcheckError("planar-motion", "a scene with motions is not checked in a plane")
    regions = {body.id: _region(body, plane) for body in scene.bodies}
    height = _height([region.points for region in regions.values()])
    bodies, lost = [], []
    for body in scene.bodies:
        try:
            bodies.append(_flat(body, regions[body.id], plane, height))
        except MeshFileError as error:
            found = issue(error.code, error.message, body=body.id, file=body.file.path)
            lost.append(Unreadable(body.id, body.file.path, found, body.groups))
    return replace(
        scene,
        bodies=tuple(bodies),
        unreadable=(*scene.unreadable, *lost),
        issues=(*scene.issues, *(one.issue for one in lost)),
        order=scene.order or tuple(body.id for body in scene.in_order()),
    )


def _region(body: Body, plane: Plane) -> Region:
    if body.file.format in DRAWINGS.values():
        return drawn_region(body.world_mesh())
    return region_of(body.world_mesh(), body.file.health.solid, plane)


def _height(outlines: Sequence[Floats]) -> float:
    """A power of two, so that no coordinate of a wall is rounded."""
    widest = max((float(np.ptp(points, axis=0).max()) for points in outlines), default=1.0)
    return 2.0 ** math.ceil(math.log2(_HEIGHT * widest)) if widest > 0 else 1.0


def _flat(body: Body, region: Region, plane: Plane, height: float) -> Body:
    if not len(region.triangles):
        raise MeshFileError("no-outline", f"no outline in the plane {plane}: it is seen edge on")
    corners = convex_corners(region)
    if corners is None:
        mesh = prism(region.points, region.triangles, height)
    else:
        mesh = prism(corners, fan_of(len(corners)), height)
    examined = examine(_stood_up(mesh, plane), orient=False)
    file: MeshFile = replace(
        body.file,
        part=f"outline {plane} of {body.id}",
        resolution=body.resolution_world,
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
        outline=None if corners is None else tuple(map(tuple, corners.tolist())),
    )
    return replace(body, file=file, transform=None, shape=None)


def _stood_up(mesh: Mesh, plane: Plane) -> Mesh:
    """From (u, v, height) to world axes, mirrored where these are not in cyclic order."""
    first, second = axes_of(plane)
    vertices = np.empty((mesh.vertex_count, 3))
    vertices[:, [first, second, axis_across(plane)]] = mesh.vertices
    triangles = np.asarray(mesh.triangles)
    mirrored = (second - first) % 3 != 1
    return Mesh(vertices, np.ascontiguousarray(triangles[:, ::-1]) if mirrored else triangles)
