"""Estimates the distance between a curved surface and its flat facets, from the facets alone.

Let a strip have width w, and let its neighbours be turned by theta. A surface through its sides
then has the sagitta (w / 2) tan(theta / 4), as for a circle of radius w / (2 sin(theta / 2)). The
same is done in two directions. The corners of the mesh are assumed to lie on the surface, and the
normal at a corner is a mean of the normals of the facets around it. At the middle of an edge e the
surface rises by e . (change of the normal) / (8 cos^2(turn / 4)). Over a triangle it rises like the
quadratic with these values. The result is exact for cylinders, and off by a few per cent for
spheres, cones and varying curvature.
"""

from __future__ import annotations

import math

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.facets import (
    LEAST_TURN,
    Facets,
    Flags,
    Floats,
    Indices,
    Ridges,
    components,
    facets_and_ridges,
    sums_of,
    unit,
)

# Tessellators turn by at most 30 degrees or 0.5 rad (28.6 degrees) from facet to facet. A circle
# therefore has at least nine facets. Octagons (45 degrees) and hexagons (60 degrees) are shapes of
# their own, such as columns and nuts. Nobody draws a circle with fewer than six facets.
LEAST_AROUND = 9
LEAST_PRISM = 6
# A factor on limits that allows for rounding.
_SLACK = 1.01
# Neighbouring facets of one curve have about the same width. At its end a curve may run into a flat
# side. If that side is up to twice as wide as the facets and turns half as much, its sagitta is no
# larger than theirs.
MOST_UNLIKE = 2.0
# A chain with fewer facets is a roof or a chamfer. Three are enough if the faces beside them
# continue the curve: it then turns there half as much as between facets, to this fraction.
LEAST_FACETS = 4
HALF_WITHIN = 0.1
# The last facet of a chain turns on one side only, so its sagitta is half of the others (1 / 2.05
# at 40 degrees).
AGREEING = 2.1
# A facet of a saddle counts as concave if its concave sagitta is at least this share of its convex
# one. Less is noise.
LEAST_CONCAVE = 0.25


class Curve(Struct, frozen=True):
    """A chain or a patch of facets that approximates one smooth surface.

    concave: the facets lie outside of the material of the curved body, so the mesh has more
    material, by up to the sagitta; else inside. facets: their number. sagitta: the largest one. For
    the facet with the largest sagitta: turn: the angle by which the surface turns over it, radians;
    radius: of curvature; triangle: one of its triangles.
    """

    concave: bool
    facets: int
    turn: float
    radius: float
    sagitta: float
    triangle: int


class Curves(Struct, frozen=True):
    """curves: concave ones first, then by falling sagitta; lengths in the unit of the points.
    left_out: chains that turn more from facet to facet, and may be prisms."""

    curves: tuple[Curve, ...]
    left_out: tuple[Curve, ...]


class _OverTriangles(Struct, frozen=True):
    """rises: (c, 2), the largest distance of the curved surface outside and inside of the mesh.
    radii, turns: (c,), over an edge across the triangle.
    """

    rises: Floats
    radii: Floats
    turns: Floats


def find_curves(points: Floats, triangles: Indices, resolution: float, solid: bool) -> Curves:
    """points: (v, 3), triangles: (t, 3), of a welded mesh. resolution: the precision of the
    coordinates, in their unit. solid: the triangles are wound outward; else no side has material,
    and all curves count as concave."""
    facets, ridges = facets_and_ridges(points, triangles.astype(np.intp), resolution)
    nothing = np.zeros(facets.count, dtype=bool)
    curves, taken = _curves(facets, ridges, 2 * math.pi / LEAST_AROUND, nothing, solid)
    left_out, _ = _curves(facets, ridges, 2 * math.pi / LEAST_PRISM, taken, solid)
    return Curves(curves, left_out)


def _curves(
    facets: Facets, ridges: Ridges, most_turn: float, apart_from: Flags, solid: bool
) -> tuple[tuple[Curve, ...], Flags]:
    """(the curves whose neighbouring facets turn by at most `most_turn`, whether each facet is on
    one of them, (f,)). Curves with a facet in `apart_from` are left out."""
    most_turn *= _SLACK
    smooth = _smooth(facets, ridges, most_turn)
    patch = components(facets.count, ridges.facets[smooth])
    sizes = np.bincount(patch)
    long = (sizes >= LEAST_FACETS) | (sizes + _faces_beside(ridges, smooth, patch) > LEAST_FACETS)
    taken = (long & (np.bincount(patch, apart_from) == 0))[patch]
    smooth &= taken[ridges.facets[:, 0]]
    if not smooth.any():
        return (), taken
    chosen = np.flatnonzero(taken[facets.of_triangle])
    over = _of_triangles(facets, ridges, smooth, chosen, most_turn)
    if not solid:
        over = replace(over, rises=np.stack([0 * over.radii, over.rises.max(axis=1)], axis=1))
    facet = facets.of_triangle[chosen]
    rises = np.zeros((facets.count, 2))
    np.maximum.at(rises, facet, over.rises)
    concave = rises[:, 1] >= LEAST_CONCAVE * rises[:, 0]
    sagittas = np.where(concave, rises[:, 1], rises[:, 0])
    order = np.lexsort((over.rises[np.arange(len(facet)), concave[facet].astype(int)], facet))
    highest = order[np.cumsum(np.bincount(facet, minlength=facets.count)) - 1]  # per facet
    curve = 2 * patch + concave
    members = np.flatnonzero(taken & _agreeing(sagittas, curve, ridges.facets[smooth]))
    members = members[np.lexsort((-sagittas[members], curve[members]))]
    sizes = np.bincount(curve[taken])
    first = members[np.unique(curve[members], return_index=True)[1]]
    curves = [
        Curve(
            concave=bool(concave[top]),
            facets=int(sizes[curve[top]]),
            turn=float(over.turns[highest[top]]),
            radius=float(over.radii[highest[top]]),
            sagitta=float(sagittas[top]),
            triangle=int(chosen[highest[top]]),
        )
        for top in first
    ]
    return tuple(sorted(curves, key=lambda one: (not one.concave, -one.sagitta))), taken


def _smooth(facets: Facets, ridges: Ridges, most_turn: float) -> Flags:
    """(r,): whether a curve may run across the ridge.

    The angle between two ridges of a facet counts too. The ridges of a low pyramid have small
    angles, but the pyramid has only a few sides."""
    alike = ridges.widths.max(axis=1) <= MOST_UNLIKE * ridges.widths.min(axis=1)
    gentle = alike & (ridges.angles <= most_turn)
    number = np.bincount(ridges.facets[gentle].ravel(), minlength=facets.count)
    # For two unit vectors at an angle phi, the largest eigenvalue of the sum is 1 + |cos phi|.
    largest = np.linalg.eigvalsh(_squares(facets, ridges, gentle)[number == 2])[:, 2]
    between = np.zeros(facets.count)
    between[number == 2] = np.arccos(np.clip(largest - 1, 0.0, 1.0))
    turns = np.hypot(between[ridges.facets].max(axis=1), ridges.angles)
    smooth: Flags = gentle & (turns <= most_turn)
    return smooth


def _squares(facets: Facets, ridges: Ridges, chosen: Flags) -> Floats:
    """(f, 3, 3): the sum of d d^T for the directions d of the chosen ridges of each facet."""
    squares = np.zeros((facets.count, 3, 3))
    along = ridges.directions[chosen]
    for k in (0, 1):
        np.add.at(squares, ridges.facets[chosen, k], along[:, :, None] * along[:, None])
    return squares


def _faces_beside(ridges: Ridges, smooth: Flags, patch: Indices) -> Indices:
    """(p,): the number of faces that each patch runs into. At these faces it turns half as much."""
    inside = np.zeros(len(patch))
    np.maximum.at(inside, ridges.facets[smooth], ridges.angles[smooth][:, None])
    share = ridges.angles[:, None] / np.maximum(inside[ridges.facets], LEAST_TURN)
    beside = ~smooth[:, None] & (np.abs(share - 0.5) <= HALF_WITHIN)
    return np.bincount(patch[ridges.facets[beside]], minlength=int(patch.max()) + 1)


def _agreeing(sagittas: Floats, curve: Indices, pairs: Indices) -> Flags:
    """(f,): whether a neighbour on the same curve has about the same sagitta. A single facet is a
    flaw."""
    low, high = np.sort(sagittas[pairs], axis=1).T
    same = curve[pairs[:, 0]] == curve[pairs[:, 1]]
    agreeing = np.zeros(len(sagittas), dtype=bool)
    agreeing[pairs[same & (low > 0) & (high <= AGREEING * low)]] = True
    return agreeing


def _of_triangles(
    facets: Facets, ridges: Ridges, smooth: Flags, chosen: Indices, most_turn: float
) -> _OverTriangles:
    """Rises over triangles; none where the surface turns too far even for the diagonal of a
    quadrilateral."""
    facet = facets.of_triangle[chosen]
    corners = facets.points[facets.triangles[chosen]]
    normals = _corner_normals(facets, ridges, smooth, chosen)
    edges = np.roll(corners, -1, axis=1) - corners
    change = np.roll(normals, -1, axis=1) - normals
    # A strip is curved only across its ridges. Its ends do not matter.
    values, vectors = np.linalg.eigh(_squares(facets, ridges, smooth))
    is_strip = values[:, 1] <= math.tan(math.pi / LEAST_AROUND) ** 2 * values[:, 2]
    along = np.where(is_strip[:, None], vectors[:, :, 2], 0.0)[facet, None]
    change -= (change * along).sum(axis=2, keepdims=True) * along
    edges -= (edges * along).sum(axis=2, keepdims=True) * along
    turns = 2 * np.arcsin(np.minimum(np.linalg.norm(change, axis=2) / 2, 1.0))
    at_edges = (edges * change).sum(axis=2) / (8 * np.cos(turns / 4) ** 2)
    sizes = np.abs(at_edges)
    squares = (edges**2).sum(axis=2)
    # Among the edges with at least half of the largest rise, take the one that turns least. It is
    # no diagonal.
    rising = sizes >= sizes.max(axis=1, keepdims=True) / 2
    across = np.arange(len(sizes)), np.where(rising, turns, np.inf).argmin(axis=1)
    rise, turn = sizes[across], turns[across]
    radius = np.divide(squares[across], 8 * rise, out=np.full_like(rise, np.inf), where=rise > 0)
    even = turns.max(axis=1) <= math.sqrt(2) * most_turn
    rises = np.where(even[:, None], _highest(at_edges), 0.0)
    return _OverTriangles(rises, radius + rise / 2, turn)


def _highest(at_edges: Floats) -> Floats:
    """(t, 2): the largest values above and below 0 of the quadratic over a triangle that is 0 at
    its corners. at_edges: (t, 3), its values at the middles of the edges.

    These values are squared lengths of the edges in the metric of the quadratic, divided by 8. In
    an acute triangle the centre of the circumscribed circle is inside and is the highest point."""
    x, y, z = np.sort(np.abs(at_edges), axis=1).T
    below = x * (2 * (y + z) - x) - (z - y) ** 2
    acute = (z < x + y) & (below > 0)
    inside = np.divide(4 * x * y * z, below, out=np.zeros_like(z), where=acute)
    highest = np.empty((len(z), 2))
    for k, values in enumerate((at_edges, -at_edges)):
        one_sided = (values >= 0).all(axis=1)
        highest[:, k] = np.maximum(values.max(axis=1), np.where(one_sided, inside, 0.0)).clip(0.0)
    return highest


def _corner_normals(facets: Facets, ridges: Ridges, smooth: Flags, chosen: Indices) -> Floats:
    """(c, 3, 3): the normal of the curved surface at each corner of these triangles. chosen: all
    triangles of facets on curves."""
    # A node is a facet at one of its corners. Nodes joined by ridges of a curve form a fan.
    triangles = facets.triangles[chosen]
    key = triangles * facets.count + facets.of_triangle[chosen, None]
    nodes, node = np.unique(key, return_inverse=True)
    facet = nodes % facets.count
    edges = np.flatnonzero(smooth[ridges.of_edge])
    sides = ridges.facets[ridges.of_edge[edges]]
    links = np.searchsorted(nodes, ridges.edges[edges, :, None] * facets.count + sides[:, None])
    fan = components(len(nodes), links.reshape(-1, 2))
    # The narrower of two chords of one circle is closer to the tangent at the corner.
    width = np.full(facets.count, np.inf)
    np.minimum.at(width, ridges.facets[smooth], ridges.widths[smooth])
    angles = _corner_angles(facets.points[triangles])
    weight = np.bincount(node.ravel(), angles.ravel()) / width[facet]
    weighted = weight[:, None] * facets.normals[facet]
    mean = unit(sums_of(fan, weighted))
    met = np.unique(np.stack([links.ravel(), np.repeat(ridges.of_edge[edges], 4)]), axis=1)[0]
    here = np.bincount(met, minlength=len(nodes))
    everywhere = np.bincount(ridges.facets[smooth].ravel(), minlength=facets.count)
    # If all ridges around a corner run into it, the surface has a tip there, and no normal.
    is_smooth = (np.bincount(fan, here < everywhere[facet]) > 0)[fan]
    normals: Floats = np.where(is_smooth[:, None], mean[fan], facets.normals[facet])
    of_corners: Floats = normals[node.reshape(-1, 3)]
    return of_corners


def _corner_angles(corners: Floats) -> Floats:
    """(t, 3), radians. corners: (t, 3, 3)."""
    after = np.roll(corners, -1, axis=1) - corners
    before = np.roll(corners, 1, axis=1) - corners
    sines = np.linalg.norm(np.cross(after, before), axis=2)
    angles: Floats = np.arctan2(sines, (after * before).sum(axis=2))
    return angles
