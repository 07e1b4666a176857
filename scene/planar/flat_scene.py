"""A scene in a plane: each body becomes the prism over its outline."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from msgspec.structs import replace

from satcheck.core import Mesh, Surface, largest_stretch
from satcheck.core.conventions import Plane, axes_of, axis_across
from satcheck.core.errors import SatcheckError
from satcheck.core.shape_mesh import mesh_of, sag_of
from satcheck.core.shapes import Primitive, is_curved
from satcheck.scene.bodies import Body, MeshFile, Scene, Unreadable
from satcheck.scene.drawing import DRAWINGS
from satcheck.scene.errors import MeshFileError
from satcheck.scene.health import examine
from satcheck.scene.issue import issue
from satcheck.scene.planar.fills import covers
from satcheck.scene.planar.prism import prism
from satcheck.scene.planar.region import (
    Region,
    convex_corners,
    convex_region,
    drawn_region,
    fan_of,
    region_of,
)

# How many times the width of the widest body the prisms reach up and down at least: nothing that
# separates two bodies in the plane is longer than both are wide together.
_REACH = 2.0
# Wider than this, the prisms would be higher than what is decided exactly.
_WIDEST = 1e44
# Of the polygon of a ball: it is off the disc by about 1/13000 of its width.
_SEGMENTS = 256
# What rounding adds to how far a polygon is off its curve: by its own computation, relatively, and
# by that of its corners, relative to the coordinates (sine, cosine, a sum, a placement: fewer than
# 8 roundings).
_ROUNDED = 2.0**-30
_STEPS_OFF = 2.0**-50


def flat_scene(scene: Scene, plane: Plane, *, allow_open: bool = False) -> Scene:
    """The bodies as they are placed, as prisms across the plane; answers lie in the plane.

    A body without an outline (all its triangles are seen edge on) is unreadable from then on, and
    so is one that cannot be placed, and one whose outline hangs on what fills its holes, unless
    they are meant to be open (allow_open). A curved shape becomes a polygon, its corners on the
    outline.
    Raises SatcheckError (`planar-motion`, `planar-volume`): bodies that move leave the plane, and
    a volume is none there.
    """
    if scene.motions:
        raise SatcheckError("planar-motion", "a scene with motions is not checked in a plane")
    limited = next((rule for rule in scene.rules if rule.max_volume is not None), None)
    if limited is not None:
        message = f"{limited.name}: max_volume means nothing in a plane"
        raise SatcheckError("planar-volume", message)
    placed, lost = [], []
    for body in scene.bodies:
        try:
            placed.append((body, _region(body, plane, allow_open=allow_open)))
        except MeshFileError as error:
            lost.append(_lost(body, error))
    heights = _heights([region for _, region in placed])
    bodies = [
        _flat(body, region, plane, height)
        for (body, region), height in zip(placed, heights, strict=True)
    ]
    return replace(
        scene,
        bodies=tuple(bodies),
        unreadable=(*scene.unreadable, *lost),
        issues=(*scene.issues, *(body.issue for body in lost)),
        order=scene.order or tuple(body.id for body in scene.in_order()),
    )


def _region(body: Body, plane: Plane, *, allow_open: bool) -> Region:
    """Raises MeshFileError for a body without an outline, one whose outline is open, or beyond what
    is decided exactly."""
    try:
        region = _outline(body, plane)
    except OverflowError as error:
        raise MeshFileError("out-of-range", str(error)) from None
    except ValueError as error:
        raise MeshFileError("singular-transform", str(error)) from None
    if not len(region.triangles):
        raise MeshFileError("no-outline", f"no outline in the plane {plane}: it is seen edge on")
    if np.ptp(region.points, axis=0).max() > _WIDEST:
        raise MeshFileError("out-of-range", f"wider than {_WIDEST:g} in the plane {plane}")
    if body.file.health.holes and not allow_open and not _covers_fills(body, region, plane):
        message = f"what fills its holes decides its outline in the plane {plane}"
        raise MeshFileError("open-outline", message)
    return region


def _covers_fills(body: Body, region: Region, plane: Plane) -> bool:
    _, hulls = Surface(body.file.mesh, solid=False).closed()
    placed = [
        hull.mesh if body.transform is None else hull.mesh.transformed(body.transform)
        for hull in hulls
        if hull.mesh.triangle_count
    ]
    outlines = [convex_region(mesh, plane) for mesh in placed]
    return all(covers(region, outline.points) for outline in outlines if len(outline.triangles))


def _outline(body: Body, plane: Plane) -> Region:
    if body.shape is not None and is_curved(body.shape):
        fine = replace(body.file, mesh=_fine_mesh(body.shape))
        return convex_region(replace(body, file=fine).world_mesh(), plane)
    if body.file.format in DRAWINGS.values():
        return drawn_region(body.world_mesh())
    return region_of(body.world_mesh(), body.file.health.solid, plane)


@lru_cache(maxsize=64)
def _fine_mesh(shape: Primitive) -> Mesh:
    return mesh_of(shape, _SEGMENTS)


def _deviation(body: Body, region: Region) -> float:
    """How far the body may be off its outline's polygon, world units; 0.0: not at all."""
    stretch = 1.0 if body.transform is None else largest_stretch(body.transform)
    if body.shape is None:
        exact = body.file.deviation * stretch
    else:
        exact = sag_of(body.shape, _SEGMENTS) * stretch
    if exact == 0:
        return 0.0
    return exact * (1 + _ROUNDED) + float(np.abs(region.points).max()) * _STEPS_OFF


def _is_inscribed(body: Body) -> bool:
    """Whether the polygon lies within the outline: the mesh of a curved shape lies within it."""
    return body.file.inscribed if body.shape is None else is_curved(body.shape)


def _lost(body: Body, error: MeshFileError) -> Unreadable:
    reason = issue(error.code, error.message, body=body.id, file=body.file.path)
    return Unreadable(body.id, body.file.path, reason, body.groups, body.path, body.static)


def _heights(regions: Sequence[Region]) -> list[float]:
    """How far each prism reaches from the plane: all different, none twice as far as another.

    They go by the outlines, so that the same bodies in another order have the same prisms.
    """
    widest = max((float(np.ptp(region.points, axis=0).max()) for region in regions), default=1.0)
    least = 2.0 ** math.ceil(math.log2(_REACH * widest)) if widest > 0 else 1.0
    step = least / 2.0 ** len(regions).bit_length()  # a power of two: every sum is exact
    ranks = sorted(range(len(regions)), key=lambda k: _coordinates(regions[k]))
    heights = [0.0] * len(regions)
    for rank, k in enumerate(ranks):
        heights[k] = least + step * rank
    return heights


def _coordinates(region: Region) -> tuple[list[list[float]], list[list[int]]]:
    return region.points.tolist(), region.triangles.tolist()


def _flat(body: Body, region: Region, plane: Plane, height: float) -> Body:
    corners = convex_corners(region)
    if corners is None:
        mesh = prism(region.points, region.triangles, height)
    else:
        mesh = prism(corners, fan_of(len(corners)), height)
    examined = examine(_stood_up(mesh, plane), orient=False)
    deviation = _deviation(body, region)
    file: MeshFile = replace(
        body.file,
        part=f"outline {plane} of {body.id}",
        resolution=max(body.resolution_world + (deviation if body.shape else 0.0), deviation),
        deviation=deviation,
        inscribed=_is_inscribed(body),
        mesh=examined.mesh,
        topology=examined.topology,
        health=examined.health,
        outline=None if corners is None else tuple(map(tuple, corners.tolist())),
    )
    return replace(body, file=file, transform=None, shape=None, as_given=body)


def _stood_up(mesh: Mesh, plane: Plane) -> Mesh:
    """From (u, v, height) to world axes, mirrored where these are not in cyclic order."""
    first, second = axes_of(plane)
    vertices = np.empty((mesh.vertex_count, 3))
    vertices[:, [first, second, axis_across(plane)]] = mesh.vertices
    triangles = np.asarray(mesh.triangles)
    mirrored = (second - first) % 3 != 1
    return Mesh(vertices, np.ascontiguousarray(triangles[:, ::-1]) if mirrored else triangles)
