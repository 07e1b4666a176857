"""How far a curved surface is off the flat facets that stand for it, estimated from the facets.

Across a strip of width w whose neighbours are turned by theta, a surface through its sides has the
sagitta (w / 2) tan(theta / 4): that of a circle of radius w / (2 sin(theta / 2)). Here in two
directions: the corners of the mesh are taken to lie on the surface, whose normal there is a mean of
those of the facets around. Over an edge e the surface then rises to
e . (change of the normal) / (8 cos^2(turn / 4)) at the middle, and over a triangle like the
quadratic with these values. That is exact for cylinders, and off by a few per cent on spheres,
cones, and where the curvature varies.
"""

from __future__ import annotations

import math

import numpy as np
from msgspec import Struct

from satcheck.core.facets import (
    Facets,
    Flags,
    Floats,
    Indices,
    Ridges,
    angles_between,
    components,
    facets_and_ridges,
    sums_of,
    unit,
)

# Tessellators turn by at most 30 degrees or 0.5 rad (28.6 degrees) from facet to facet. Beyond nine
# facets around a circle, octagons (45 degrees) and hexagons (60 degrees) are shapes of their own:
# columns, nuts. Nobody draws a circle with less than six.
LEAST_AROUND = 9
LEAST_PRISM = 6
# What rounded coordinates may add to an angle.
_SLACK = 1.01
# Neighbouring facets of one curve are about equally wide. A flat side that a curve runs into, up to
# twice as wide as its facets and turning half as much, reads no larger sagitta than they.
MOST_UNLIKE = 2.0
# Fewer facets in a row are those of a roof or of a chamfer.
LEAST_FACETS = 4


class Curve(Struct, frozen=True):
    """A chain or a patch of facets that stands for one smooth surface.

    facets: how many. turn: the largest angle between two of them, radians. radius: the smaller one
    of curvature, the median over the facets. sagitta: the largest of the facets. triangle: of the
    mesh, in the facet that has it.
    """

    facets: int
    turn: float
    radius: float
    sagitta: float
    triangle: int


class Curves(Struct, frozen=True):
    """Largest sagitta first, lengths in the unit of the points. left_out: chains that turn more
    from facet to facet, and may be prisms."""

    curves: tuple[Curve, ...]
    left_out: tuple[Curve, ...]


def find_curves(points: Floats, triangles: Indices, precision: float) -> Curves:
    """points: (v, 3), triangles: (t, 3), of a welded mesh with consistent winding. precision: how
    finely the coordinates are known, in their unit."""
    facets, ridges = facets_and_ridges(points, triangles.astype(np.intp), precision)
    smooth = _smooth(facets, ridges, 2 * math.pi / LEAST_AROUND)
    curves, taken = _curves(facets, ridges, smooth)
    steep = _smooth(facets, ridges, 2 * math.pi / LEAST_PRISM)
    left_out, _ = _curves(facets, ridges, steep & ~taken[ridges.facets].any(axis=1))
    return Curves(curves, left_out)


def _smooth(facets: Facets, ridges: Ridges, most_turn: float) -> Flags:
    """(r,): whether a curve may run across the ridge.

    Between two ridges a facet turns by the angle between them too: the sides of a low pyramid
    hardly bend, but there are only a few of them around."""
    most_turn *= _SLACK
    alike = ridges.widths.max(axis=1) <= MOST_UNLIKE * ridges.widths.min(axis=1)
    gentle = alike & (ridges.angles <= most_turn)
    sides, along = ridges.facets[gentle], ridges.directions[gentle]
    squares = np.zeros((facets.count, 3, 3))
    for k in (0, 1):
        np.add.at(squares, sides[:, k], along[:, :, None] * along[:, None])
    two = np.flatnonzero(np.bincount(sides.ravel(), minlength=facets.count) == 2)
    # The sum for two unit vectors at an angle phi has the largest eigenvalue 1 + |cos phi|.
    cosine = np.clip(np.linalg.eigvalsh(squares[two])[:, 2] - 1, 0.0, 1.0)
    between = np.zeros(facets.count)
    between[two] = np.arccos(cosine)
    turn = np.hypot(between[ridges.facets].max(axis=1), ridges.angles)
    smooth: Flags = gentle & (turn <= most_turn)
    return smooth


def _curves(facets: Facets, ridges: Ridges, smooth: Flags) -> tuple[tuple[Curve, ...], Flags]:
    """Those of facets that these ridges join, and which facets they consist of, (f,)."""
    patch = components(facets.count, ridges.facets[smooth])
    taken = (np.bincount(patch) >= LEAST_FACETS)[patch]
    smooth = smooth & taken[ridges.facets[:, 0]]
    if not smooth.any():
        return (), taken
    pairs = ridges.facets[smooth]
    chosen = np.flatnonzero(taken[facets.of_triangle])
    sagittas, radii = _of_triangles(facets, ridges, smooth, chosen)
    order = np.lexsort((sagittas, facets.of_triangle[chosen]))
    counts = np.bincount(facets.of_triangle[chosen], minlength=facets.count)
    highest = order[np.cumsum(counts) - 1]  # of each facet, among those chosen
    of_facet = np.where(taken, sagittas[highest], 0.0)
    turns = np.zeros(facets.count)
    np.maximum.at(turns, pairs, ridges.angles[smooth][:, None])
    members = np.flatnonzero(taken & _agreeing(of_facet, pairs))
    members = members[np.lexsort((-of_facet[members], patch[members]))]
    sizes = np.bincount(patch)
    curves = [
        Curve(
            facets=int(sizes[patch[group[0]]]),
            turn=float(turns[group].max()),
            radius=float(np.median(radii[highest[group]])),
            sagitta=float(of_facet[group[0]]),
            triangle=int(chosen[highest[group[0]]]),
        )
        for group in np.split(members, np.flatnonzero(np.diff(patch[members])) + 1)
        if len(group)
    ]
    return tuple(sorted(curves, key=lambda curve: -curve.sagitta)), taken


def _agreeing(sagittas: Floats, pairs: Indices) -> Flags:
    """(f,): whether a neighbour has about the same sagitta: one facet alone is a flaw."""
    low, high = np.sort(sagittas[pairs], axis=1).T
    agreeing = np.zeros(len(sagittas), dtype=bool)
    agreeing[pairs[(low > 0) & (high <= MOST_UNLIKE * low)]] = True
    return agreeing


def _of_triangles(
    facets: Facets, ridges: Ridges, smooth: Flags, chosen: Indices
) -> tuple[Floats, Floats]:
    """(c,): the sagittas of these triangles, and the least radius of curvature along an edge."""
    corners = facets.points[facets.triangles[chosen]]
    normals = _corner_normals(facets, ridges, smooth, chosen)
    edges = np.roll(corners, -1, axis=1) - corners
    after = np.roll(normals, -1, axis=1)
    cosine = np.cos(angles_between(normals, after) / 4)
    at_edges = (edges * (after - normals)).sum(axis=2) / (8 * cosine**2)
    rises = np.abs(at_edges)
    squares = (edges**2).sum(axis=2)
    radii = np.divide(squares, 8 * rises, out=np.full_like(rises, np.inf), where=rises > 0)
    return _highest(at_edges), (radii + rises / 2).min(axis=1)


def _highest(at_edges: Floats) -> Floats:
    """(t,): the greatest |value| in a triangle of the quadratic that is 0 at its corners. at_edges:
    (t, 3), its values at the middles of the edges.

    These are squared lengths of the edges in the metric of the quadratic, over 8. In an acute
    triangle the centre of the circle through the corners is inside, and highest."""
    x, y, z = np.sort(np.abs(at_edges), axis=1).T
    one_sided = (at_edges >= 0).all(axis=1) | (at_edges <= 0).all(axis=1)
    below = x * (2 * (y + z) - x) - (z - y) ** 2
    acute = one_sided & (z < x + y) & (below > 0)
    highest: Floats = z.copy()
    np.divide(4 * x * y * z, below, out=highest, where=acute)
    return highest


def _corner_normals(facets: Facets, ridges: Ridges, smooth: Flags, chosen: Indices) -> Floats:
    """(c, 3, 3): the normal of the curved surface at each corner of these triangles, which are all
    those of the facets of curves."""
    # A node is a facet at one of its corners. Those that ridges of a curve join are a fan.
    triangles = facets.triangles[chosen]
    key = triangles * facets.count + facets.of_triangle[chosen, None]
    nodes, node = np.unique(key, return_inverse=True)
    facet = nodes % facets.count
    edges = np.flatnonzero(smooth[ridges.of_edge])
    sides = ridges.facets[ridges.of_edge[edges]]
    links = np.searchsorted(nodes, ridges.edges[edges, :, None] * facets.count + sides[:, None])
    fan = components(len(nodes), links.reshape(-1, 2))
    # Of two chords of one circle the narrower one has the direction nearer to that of the corner.
    width = np.full(facets.count, np.inf)
    np.minimum.at(width, ridges.facets[smooth], ridges.widths[smooth])
    angles = _corner_angles(facets.points[triangles])
    weight = np.bincount(node.ravel(), angles.ravel()) / width[facet]
    weighted = weight[:, None] * facets.normals[facet]
    mean = unit(sums_of(fan, weighted))
    met = np.unique(np.stack([links.ravel(), np.repeat(ridges.of_edge[edges], 4)]), axis=1)[0]
    here = np.bincount(met, minlength=len(nodes))
    everywhere = np.bincount(ridges.facets[smooth].ravel(), minlength=facets.count)
    # Where all ridges around run into one corner the surface has a tip, and no normal.
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
