"""The resolution of a file: how far the rounding of its coordinates may move a vertex, a length.

It follows from the number format in which the file stores coordinates. The default tolerance is the
sum of the resolutions of both bodies, so that rounding alone is no overlap of bodies that fit.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from satcheck.core import Mesh
    from satcheck.scene.document import NumberFormat, RawMesh

FLOAT16_STEP = 2.0**-10  # spacing of float16 numbers relative to their power of two
FLOAT32_STEP = 2.0**-23  # the same of float32
# Coordinates in float64 are rounded where they are stored and where they were computed, at least by
# a rotation R and a shift t: by u = 2^-53 of each of the products, of both sums of products, and of
# the sum with t. Let c be the largest coordinate. A vertex p of a body that has the origin of its
# own frame within its box is at most r = 2 sqrt(3) c from it. The products move the vertex by
# at most u sqrt(3) r, as the squares of all entries of R sum up to 3, the sums by u (r + r), and
# the last sum by u sqrt(3) c: by less than 16 u c in all.
FLOAT64_STEP = 2.0**-49
VERTEX = math.sqrt(3)  # a vertex moves this much if each coordinate moves by 1
# A vertex is far if its largest coordinate is more than this many times the median of all vertices.
# It costs most of them four bits of precision.
FAR = 16
STEPS: dict[NumberFormat, float] = {
    "float16": FLOAT16_STEP,
    "float32": FLOAT32_STEP,
    "float64": FLOAT64_STEP,
}


def placement_step(raw: RawMesh, *, by_file: bool) -> float:
    """The relative precision of a placement, as a share of the placed coordinates.

    by_file: the file itself places its mesh. A program that stores coordinates as float32 is
    assumed to store placements no finer. All other placements are taken as written.
    """
    return FLOAT32_STEP if by_file and raw.number_format == "float32" else FLOAT64_STEP


def file_resolution(raw: RawMesh, max_coordinate: float) -> float:
    """The precision of the coordinates, in file units.

    max_coordinate: largest |coordinate| of the mesh. float16, float32: the spacing of these numbers
    at max_coordinate, which is more than half of the diagonal of a cube of that size. float64: what
    a placement rounds. Written digits: that, and half the diagonal of a cube of one unit of the
    last digit of the most precise number, but no more than for float32. The digits of a number with
    an exponent are relative to its own size, so they are counted down from the largest coordinate:
    many files write -4.4e-08 for 0, which does not promise eight decimals. Integers and packed
    data: half the diagonal of a cube of their step, if that is more.
    """
    return max(_of_the_format(raw, max_coordinate), VERTEX * raw.rounding)


def far_vertex(raw: RawMesh, mesh: Mesh) -> str | None:
    """Names the vertex that sets the precision of a mesh, if most of the others would be known far
    more finely; None: no vertex does. A step of digits, integers or packed data, which is the same
    everywhere, has no such vertex. That of float64 is too fine to matter."""
    low, high = mesh.bounds
    largest = max(map(abs, (*low, *high)))
    resolution = _of_the_format(raw, largest)
    if raw.number_format == "float64" or resolution < largest * FLOAT32_STEP:
        return None
    if resolution <= VERTEX * raw.rounding:
        return None
    (x, y, z), median = mesh.far_vertex()
    if largest <= FAR * median:
        return None
    return (
        f"the vertex ({x:.6g}, {y:.6g}, {z:.6g}) makes the precision {resolution:.3g}: half of the "
        f"vertices have no coordinate beyond {median:.6g}"
    )


def _of_the_format(raw: RawMesh, max_coordinate: float) -> float:
    if raw.number_format in STEPS:
        return max_coordinate * STEPS[raw.number_format]
    float32 = max_coordinate * FLOAT32_STEP
    float64 = max_coordinate * FLOAT64_STEP
    decimals = raw.decimals
    if raw.significant > 0 and max_coordinate > 0.0:
        leading = math.floor(math.log10(max_coordinate))
        decimals = max(decimals, raw.significant - 1 - leading)
    return min(float32, float64 + VERTEX * 0.5 * 10.0**-decimals)
