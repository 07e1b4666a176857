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

# Tessellators turn by at most 30 degrees or 0.5 rad (28.6 degrees) from facet to facet. Beyond nine
# facets around a circle, octagons (45 degrees) and hexagons (60 degrees) are shapes of their own:
# columns, nuts. Nobody draws a circle with less than six.
LEAST_AROUND = 9
LEAST_PRISM = 6
# What rounding may add to a limit.
_SLACK = 1.01
# Neighbouring facets of one curve are about equally wide. A flat side that a curve runs into, up to
# twice as wide as its facets and turning half as much, reads no larger sagitta than they.
MOST_UNLIKE = 2.0
# Fewer facets in a row are those of a roof or of a chamfer. Three count where the faces beside them
# continue the curve: there it turns half as much as between facets, to this fraction.
LEAST_FACETS = 4
HALF_WITHIN = 0.1
# The last facet of a chain turns on one side only, so that it reads half the sagitta (1 / 2.05 at
# 40 degrees).
AGREEING = 2.1
# A facet of a saddle counts as concave from this share of its convex sagitta on; less is noise.
LEAST_CONCAVE = 0.25


class Curve(Struct, frozen=True):
    """A chain or a patch of facets that stands for one smooth surface.

    concave: the facets lie outside of the material of the curved body, which the mesh exceeds by
    the sagitta; else inside. facets: how many. sagitta: the largest one. Of that facet, turn: the
    angle by which the surface turns over it, radians; radius: of curvature; triangle: one of the
    mesh.
    """

    concave: bool
    facets: int
    turn: float
    radius: float
    sagitta: float
    triangle: int


class Curves(Struct, frozen=True):
    """Concave ones first, then the largest sagitta; lengths in the unit of the points. left_out:
    chains that turn more from facet to facet, and may be prisms."""

    curves: tuple[Curve, ...]
    left_out: tuple[Curve, ...]


class _OverTriangles(Struct, frozen=True):
    """rises: (c, 2), how far the curved surface gets outside and inside of the mesh. radii, turns:
    (c,), over an edge across the triangle.
    """

    rises: Floats
    radii: Floats
    turns: Floats


def find_curves(points: Floats, triangles: Indices, precision: float, solid: bool) -> Curves:
    """points: (v, 3), triangles: (t, 3), of a welded mesh. precision: how finely the coordinates
    are known, in their unit. solid: the triangles are wound outward; else no side of them has
    material, and all curves are concave."""
    facets, ridges = facets_and_ridges(points, triangles.astype(np.intp), precision)
    nothing = np.zeros(facets.count, dtype=bool)
    curves, taken = _curves(facets, ridges, 2 * math.pi / LEAST_AROUND, nothing, solid)
    left_out, _ = _curves(facets, ridges, 2 * math.pi / LEAST_PRISM, taken, solid)
    return Curves(curves, left_out)


def _curves(
    facets: Facets, ridges: Ridges, most_turn: float, apart_from: Flags, solid: bool
) -> tuple[tuple[Curve, ...], Flags]:
    """The curves whose neighbouring facets turn by no more than that, and the facets of which they
    consist, (f,). Those with a facet of `apart_from` are left out."""
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
    highest = order[np.cumsum(np.bincount(facet, minlength=facets.count)) - 1]  # of each facet
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

    Between two ridges a facet turns by the angle between them too: the sides of a low pyramid
    hardly bend, but there are only a few of them around."""
    alike = ridges.widths.max(axis=1) <= MOST_UNLIKE * ridges.widths.min(axis=1)
    gentle = alike & (ridges.angles <= most_turn)
    number = np.bincount(ridges.facets[gentle].ravel(), minlength=facets.count)
    # The sum for two unit vectors at an angle phi has the largest eigenvalue 1 + |cos phi|.
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
    """(p,): how many faces each patch of facets runs into: at them it turns half as much."""
    inside = np.zeros(len(patch))
    np.maximum.at(inside, ridges.facets[smooth], ridges.angles[smooth][:, None])
    share = ridges.angles[:, None] / np.maximum(inside[ridges.facets], LEAST_TURN)
    beside = ~smooth[:, None] & (np.abs(share - 0.5) <= HALF_WITHIN)
    return np.bincount(patch[ridges.facets[beside]], minlength=int(patch.max()) + 1)


def _agreeing(sagittas: Floats, curve: Indices, pairs: Indices) -> Flags:
    """(f,): whether a neighbour on the same curve has about the same sagitta: one facet alone is a
    flaw."""
    low, high = np.sort(sagittas[pairs], axis=1).T
    same = curve[pairs[:, 0]] == curve[pairs[:, 1]]
    agreeing = np.zeros(len(sagittas), dtype=bool)
    agreeing[pairs[same & (low > 0) & (high <= AGREEING * low)]] = True
    return agreeing


def _of_triangles(
    facets: Facets, ridges: Ridges, smooth: Flags, chosen: Indices, most_turn: float
) -> _OverTriangles:
    """No rises where the surface turns too far, even for the diagonal of a quadrilateral."""
    facet = facets.of_triangle[chosen]
    corners = facets.points[facets.triangles[chosen]]
    normals = _corner_normals(facets, ridges, smooth, chosen)
    edges = np.roll(corners, -1, axis=1) - corners
    change = np.roll(normals, -1, axis=1) - normals
    # A strip is curved across its ridges alone, whatever it runs into at its ends.
    values, vectors = np.linalg.eigh(_squares(facets, ridges, smooth))
    is_strip = values[:, 1] <= math.tan(math.pi / LEAST_AROUND) ** 2 * values[:, 2]
    along = np.where(is_strip[:, None], vectors[:, :, 2], 0.0)[facet, None]
    change -= (change * along).sum(axis=2, keepdims=True) * along
    edges -= (edges * along).sum(axis=2, keepdims=True) * along
    turns = 2 * np.arcsin(np.minimum(np.linalg.norm(change, axis=2) / 2, 1.0))
    at_edges = (edges * change).sum(axis=2) / (8 * np.cos(turns / 4) ** 2)
    sizes = np.abs(at_edges)
    squares = (edges**2).sum(axis=2)
    # Of the edges over which it rises, by half of the most, the one that turns least: no diagonal.
    rising = sizes >= sizes.max(axis=1, keepdims=True) / 2
    across = np.arange(len(sizes)), np.where(rising, turns, np.inf).argmin(axis=1)
    rise, turn = sizes[across], turns[across]
    radius = np.divide(squares[across], 8 * rise, out=np.full_like(rise, np.inf), where=rise > 0)
    even = turns.max(axis=1) <= math.sqrt(2) * most_turn
    rises = np.where(even[:, None], _highest(at_edges), 0.0)
    return _OverTriangles(rises, radius + rise / 2, turn)


def _highest(at_edges: Floats) -> Floats:
    """(t, 2): how far above and below 0 the quadratic over a triangle gets that is 0 at its
    corners. at_edges: (t, 3), its values at the middles of the edges.

    These are squared lengths of the edges in the metric of the quadratic, over 8. In an acute
    triangle the centre of the circle through the corners is inside, and highest."""
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
