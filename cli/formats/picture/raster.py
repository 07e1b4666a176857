"""Triangles to pixels without a GPU: every surface at every pixel, sorted, and then seen through.

After L. Carpenter, The A-buffer, an antialiased hidden surface method, 1984. A fragment is where
the ray through the centre of a pixel meets a triangle. It is one integer, so that sorting brings
the fragments of a ray together, the nearest first. Bodies may pass through each other, and counting
how often a ray enters and leaves A and B tells where it is in both. Several rays a pixel take the
place of Carpenter's masks.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Reals = npt.NDArray[np.floating]
    Integers = npt.NDArray[np.int64]

Colour = tuple[float, float, float]  # red, green, blue, from 0 to 1
RAYS = 2  # along each side of a pixel
BAND = 64  # rows of rays at a time, which bounds the memory
# Parts of a fragment, from its lowest bits: shade, kind, whether its body is entered, depth, ray.
# Leaving comes before entering at the same depth: faces in contact are no overlap.
_SHADE_BITS, _KIND_BITS, _DEPTH_BITS = 8, 4, 20
_ENTERS_AT = _SHADE_BITS + _KIND_BITS
_DEPTH_AT = _ENTERS_AT + 1
_RAY_AT = _DEPTH_AT + _DEPTH_BITS
_DARKEST = 0.55  # of a face seen from its edge
_BESIDE_OVERLAP = 0.25  # share of the alpha of what else a ray meets: an overlap is to be seen
_THROUGH_OPAQUE = 1e-4  # light, so that its logarithm is finite


LAYERS = 3
MARKS, INNER, BODIES = range(LAYERS)


class Kind(NamedTuple):
    """layer: each lies before those that follow it."""

    colour: Colour
    alpha: float
    layer: int = BODIES


class Triangles(NamedTuple):
    """corners: (n, 3, 3): right and down in pixels, and away from the eye. kinds: (n,) numbers."""

    corners: Floats
    kinds: Integers


def drawn(
    triangles: Triangles,
    kinds: Sequence[Kind],
    overlap: Kind | None,
    size: tuple[int, int],
    ground: Colour,
) -> npt.NDArray[np.uint8]:
    """(height, width, 3). kinds: the first two are A and B. overlap: of where a ray is in both;
    None: they have nothing in common.
    size: width and height in pixels."""
    width, height = size[0] * RAYS, size[1] * RAYS
    rays = _for_rays(triangles, kinds)
    normals = np.cross(rays[:, 1] - rays[:, 0], rays[:, 2] - rays[:, 0])
    facts = _facts(triangles, normals)
    image = np.empty((height * width, 3), dtype=np.float32)
    for first in range(0, height, BAND):
        last = min(first + BAND, height)
        fragments = np.sort(_fragments(rays, normals, facts, range(first, last), width))
        image[first * width : last * width] = ground
        _see(image, fragments, kinds, overlap)
    whole = image.reshape(size[1], RAYS, size[0], RAYS, 3).mean(axis=(1, 3))
    pixels: npt.NDArray[np.uint8] = (np.clip(whole, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
    return pixels


def _for_rays(triangles: Triangles, kinds: Sequence[Kind]) -> Floats:
    """Corners in steps of rays and of depth."""
    corners = triangles.corners * [RAYS, RAYS, 1.0]
    depth = corners[:, :, 2]
    low, high = depth.min(initial=0.0), depth.max(initial=0.0)
    layer = np.array([kind.layer for kind in kinds])[triangles.kinds]
    share = (depth - low) / (high - low or 1.0)
    corners[:, :, 2] = (share + layer[:, None]) * (((1 << _DEPTH_BITS) - 1) // LAYERS)
    return corners


def _facts(triangles: Triangles, normals: Floats) -> Integers:
    """The lower bits of the fragments of each triangle. The shade is that of the page: of a light
    at the eye."""
    a, b, c = (triangles.corners[:, k] for k in range(3))
    true = np.cross(b - a, c - a)
    length = np.linalg.norm(true, axis=1)
    facing = np.abs(true[:, 2]) / np.where(length > 0.0, length, 1.0)
    shade = ((_DARKEST + (1.0 - _DARKEST) * facing) * ((1 << _SHADE_BITS) - 1)).astype(np.int64)
    enters = normals[:, 2] < 0.0  # towards the eye
    return shade | triangles.kinds << _SHADE_BITS | enters.astype(np.int64) << _ENTERS_AT


def _fragments(
    corners: Floats, normals: Floats, facts: Integers, rows: range, width: int
) -> Integers:
    """Of the rays in these rows. A ray on the edge of two triangles meets one of them."""
    first = np.maximum(np.ceil(corners[:, :, 1].min(axis=1) - 0.5), rows.start)
    last = np.minimum(np.ceil(corners[:, :, 1].max(axis=1) - 0.5), rows.stop)
    counts = np.where(normals[:, 2] != 0.0, np.maximum(last - first, 0.0), 0.0).astype(np.int64)
    of = np.repeat(np.arange(len(corners)), counts)
    row = _runs(first.astype(np.int64), counts)
    left, right = _span(corners[of], row + 0.5)
    start = np.clip(np.ceil(left - 0.5), 0, width).astype(np.int64)
    stop = np.clip(np.ceil(right - 0.5), 0, width).astype(np.int64)
    counts = np.maximum(stop - start, 0)
    of, row, column = np.repeat(of, counts), np.repeat(row, counts), _runs(start, counts)
    depth = _depth(corners[of, 0], normals[of], column + 0.5, row + 0.5)
    return (row * width + column) << _RAY_AT | depth << _DEPTH_AT | facts[of]


def _runs(firsts: Integers, counts: Integers) -> Integers:
    """firsts[0], firsts[0] + 1, ..., counts[0] numbers in all, then those from firsts[1] on."""
    ends = np.cumsum(counts)
    steps = np.arange(ends[-1] if len(ends) else 0)
    return steps - np.repeat(ends - counts - firsts, counts)


def _span(corners: Floats, y: Reals) -> tuple[Floats, Floats]:
    """From where to where triangles reach at this height. An edge is cut in the same way for both
    of its triangles."""
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    for k in range(3):
        p, q = corners[:, k, :2], corners[:, (k + 1) % 3, :2]
        down = (p[:, 1] < q[:, 1])[:, None]
        upper, lower = np.where(down, p, q), np.where(down, q, p)
        meets = (upper[:, 1] <= y) & (y < lower[:, 1])
        height = np.where(meets, lower[:, 1] - upper[:, 1], 1.0)
        x = upper[:, 0] + (y - upper[:, 1]) / height * (lower[:, 0] - upper[:, 0])
        left = np.where(meets, np.minimum(left, x), left)
        right = np.where(meets, np.maximum(right, x), right)
    return np.where(left <= right, left, 0.0), np.where(left <= right, right, 0.0)


def _depth(corner: Floats, normal: Floats, x: Reals, y: Reals) -> Integers:
    ahead = normal[:, 0] * (x - corner[:, 0]) + normal[:, 1] * (y - corner[:, 1])
    depth = corner[:, 2] - ahead / normal[:, 2]
    return np.clip(np.rint(depth), 0, (1 << _DEPTH_BITS) - 1).astype(np.int64)


def _see(
    image: npt.NDArray[np.float32], fragments: Integers, kinds: Sequence[Kind], overlap: Kind | None
) -> None:
    """Lays sorted fragments over the ground, the nearest first."""
    if not len(fragments):
        return
    ray = fragments >> _RAY_AT
    kind = fragments >> _SHADE_BITS & ((1 << _KIND_BITS) - 1)
    shade = (fragments & ((1 << _SHADE_BITS) - 1)) / ((1 << _SHADE_BITS) - 1)
    starts = np.flatnonzero(np.diff(ray, prepend=-1))
    group = np.repeat(np.arange(len(starts)), np.diff(starts, append=len(ray)))
    colours = np.array([k.colour for k in kinds])[kind] * shade[:, None]
    alpha = np.array([k.alpha for k in kinds])[kind]
    if overlap is not None:
        entered = _enters_overlap(fragments, kind, starts, group)
        colours[entered] = np.array(overlap.colour) * shade[entered, None]
        met = np.add.reduceat(entered.astype(np.int64), starts) > 0  # of each ray
        faint = np.array([k.layer == BODIES for k in kinds])[kind] & met[group]
        alpha = np.where(entered, overlap.alpha, np.where(faint, _BESIDE_OVERLAP * alpha, alpha))
    passing = np.log(np.maximum(1.0 - alpha, _THROUGH_OPAQUE))
    after = _running(passing, starts, group)
    weight = np.exp(after - passing) * alpha
    seen = ray[starts]
    through = np.exp(np.add.reduceat(passing, starts))
    through = np.where(through < 2.0 * _THROUGH_OPAQUE, 0.0, through)
    image[seen] *= through[:, None]
    for k in range(3):
        image[seen, k] += np.bincount(group, weight * colours[:, k])


def _enters_overlap(
    fragments: Integers, kind: Integers, starts: Integers, group: Integers
) -> npt.NDArray[np.bool_]:
    """Fragments behind which a ray is in both A and B, and not in front of them. A ray that leaves
    a body as often as it enters it tells nothing wrong; others are those of open bodies."""
    sign = np.where(fragments >> _ENTERS_AT & 1, 1, -1)
    within, was_within = np.ones(len(kind), dtype=bool), np.ones(len(kind), dtype=bool)
    whole = np.ones(len(starts), dtype=bool)
    for body in (0, 1):
        steps = np.where(kind == body, sign, 0)
        after = _running(steps, starts, group)
        within &= after != 0
        was_within &= after - steps != 0
        whole &= np.add.reduceat(steps, starts) == 0
    entered: npt.NDArray[np.bool_] = within & ~was_within & whole[group]
    return entered


def _running(values: Floats | Integers, starts: Integers, group: Integers) -> Floats:
    """Sums from the first fragment of each ray."""
    total = np.cumsum(values, dtype=np.float64)
    before = total[starts] - values[starts]
    sums: Floats = total - before[group]
    return sums
