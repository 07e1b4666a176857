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
from satcheck.core.half_space import plane_of
from satcheck.core.shape_mesh import mesh_of, sag_of
from satcheck.core.shapes import Curved, is_curved
from satcheck.scene.bodies import Body, MeshFile, Scene, Unreadable, is_half_space
from satcheck.scene.errors import Refused
from satcheck.scene.inspect import examine
from satcheck.scene.issue import issue
from satcheck.scene.planar.region import (
    Region,
    convex_corners,
    convex_region,
    covers,
    fan_of,
    prism,
    region_of,
)

# The prisms reach at least this many times the width of the widest body up and down. A
# translation that separates two bodies in the plane is no longer than the sum of their widths.
_REACH = 2.0
# For wider bodies the heights of the prisms would exceed the range of exact arithmetic.
_WIDEST = 1e44
# Segments of the polygon of a ball. Its error is about 1/13000 of the width of the disc.
_SEGMENTS = 256
# Rounding adds to the deviation of a polygon from its curve: a relative error of the deviation
# itself, and an error of the corners relative to the coordinates (sine, cosine, a sum, a placement:
# fewer than 8 roundings).
_ROUNDED = 2.0**-30
_STEPS_OFF = 2.0**-50


def flat_scene(scene: Scene, plane: Plane, *, allow_open: bool = False) -> Scene:
    """Replaces each placed body by the prism over its outline, so that all answers lie in the
    plane.

    A body becomes unreadable if it has no outline (all its triangles are seen edge on), if it
    cannot be placed, or if its outline depends on the fill of its holes and allow_open is not set.
    A curved shape becomes a polygon with its corners on the outline.
    Raises SatcheckError for a scene with motions (`planar-motion`), because moving bodies may leave
    the plane, and for a limit on volume (`planar-volume`), because a plane has no volumes.
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
            placed.append((body, _region(body, plane, allow_open=allow_open or body.open)))
        except Refused as error:
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
    """Raises Refused for a body without an outline, with an open outline, or beyond the range
    of exact arithmetic."""
    try:
        region = _outline(body, plane)
    except OverflowError as error:
        raise Refused("out-of-range", str(error)) from None
    except ValueError as error:
        raise Refused("singular-transform", str(error)) from None
    if not len(region.triangles):
        raise Refused("no-outline", f"no outline in the plane {plane}: it is seen edge on")
    if np.ptp(region.points, axis=0).max() > _WIDEST:
        raise Refused("out-of-range", f"wider than {_WIDEST:g} in the plane {plane}")
    if body.file.health.holes and not allow_open and not _covers_fills(body, region, plane):
        message = f"what fills its holes decides its outline in the plane {plane}"
        raise Refused("open-outline", message)
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
    if is_half_space(body) and not _stands_on(body, plane):
        raise Refused("no-outline", f"a half space that is no half plane in {plane}")
    if is_curved(body.shape):
        fine = replace(body.file, mesh=_fine_mesh(body.shape))
        return convex_region(replace(body, file=fine).world_mesh(), plane)
    return region_of(body.world_mesh(), body.file.health.solid, plane)


def _stands_on(floor: Body, plane: Plane) -> bool:
    """Return whether the boundary of a half space is upright over the plane."""
    normal = plane_of(floor.transform).normal
    return normal[axis_across(plane)] == 0


@lru_cache(maxsize=64)
def _fine_mesh(shape: Curved) -> Mesh:
    return mesh_of(shape, _SEGMENTS)


def _deviation(body: Body, region: Region) -> float:
    """The largest distance between the outline of the body and its polygon, world units; 0.0: the
    polygon is exact."""
    if not is_curved(body.shape):
        return 0.0
    stretch = 1.0 if body.transform is None else largest_stretch(body.transform)
    return (
        sag_of(body.shape, _SEGMENTS) * stretch * (1 + _ROUNDED)
        + float(np.abs(region.points).max()) * _STEPS_OFF
    )


def _lost(body: Body, error: Refused) -> Unreadable:
    reason = issue(error.code, error.message, body=body.id, file=body.file.path)
    return Unreadable(body.id, body.file.path, reason, body.groups, body.path, body.static)


def _heights(regions: Sequence[Region]) -> list[float]:
    """The height of each prism above the plane.

    All differ, and each is less than twice any other. They are assigned by the outlines, so that
    the order of the bodies does not matter.
    """
    widest = max((float(np.ptp(region.points, axis=0).max()) for region in regions), default=1.0)
    least = 2.0 ** math.ceil(math.log2(_REACH * widest)) if widest > 0 else 1.0
    step = least / 2.0 ** len(regions).bit_length()  # a power of two: every sum is exact
    coordinates = [(each.points.tolist(), each.triangles.tolist()) for each in regions]
    ranks = sorted(range(len(regions)), key=coordinates.__getitem__)
    heights = [0.0] * len(regions)
    for rank, k in enumerate(ranks):
        heights[k] = least + step * rank
    return heights


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
        prepared=None,
        part=f"outline {plane} of {body.id}",
        resolution=body.resolution_world + deviation,
        deviation=deviation,
        mesh=examined.mesh,
        health=examined.health,
        outline=None if corners is None else tuple(map(tuple, corners.tolist())),
    )
    return replace(body, file=file, transform=None, shape=None, as_given=body)


def _stood_up(mesh: Mesh, plane: Plane) -> Mesh:
    """From (u, v, height) to world axes; mirrored if these are not in cyclic order."""
    first, second = axes_of(plane)
    vertices = np.empty((mesh.vertex_count, 3))
    vertices[:, [first, second, axis_across(plane)]] = mesh.vertices
    triangles = np.asarray(mesh.triangles)
    mirrored = (second - first) % 3 != 1
    return Mesh(vertices, np.ascontiguousarray(triangles[:, ::-1]) if mirrored else triangles)
