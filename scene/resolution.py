"""The resolution of a file: the precision of its coordinates, a length.

It follows from the number format in which the file stores coordinates. The default tolerance
follows from the resolutions of both bodies.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from satcheck.core import Mesh
    from satcheck.scene.loading.raw_mesh import NumberFormat, RawMesh

FLOAT16_STEP = 2.0**-10  # spacing of float16 numbers relative to their power of two
FLOAT32_STEP = 2.0**-23  # the same of float32
FLOAT64_ROUNDING = 2.0**-53  # largest relative error of rounding to float64
# A vertex is far if its largest coordinate is more than this many times the median of all vertices.
# It costs most of them four bits of precision.
FAR = 16
STEPS: dict[NumberFormat, float] = {
    "float16": FLOAT16_STEP,
    "float32": FLOAT32_STEP,
    "float64": FLOAT64_ROUNDING,
}


def placement_step(raw: RawMesh, *, by_file: bool) -> float:
    """The relative precision of a placement, as a share of the placed coordinates.

    by_file: the file itself places its mesh. A program that stores coordinates as float32 is
    assumed to store placements no finer. All other placements are taken as written.
    """
    return FLOAT32_STEP if by_file and raw.number_format == "float32" else FLOAT64_ROUNDING


def file_resolution(raw: RawMesh, max_coordinate: float) -> float:
    """The precision of the coordinates, in file units.

    max_coordinate: largest |coordinate| of the mesh. float16, float32: the spacing of these numbers
    at max_coordinate. float64: half the spacing of float64 there. Written digits: half a unit of
    the last digit of the most precise number, but no less than for float64 and no more than for
    float32. The digits of a number with an exponent are relative to its own size, so they are
    counted down from the largest coordinate: many files write -4.4e-08 for 0, which does not
    promise eight decimals. Integers and packed data: half their step, if that is more.
    """
    return max(_of_the_format(raw, max_coordinate), raw.rounding)


def far_vertex(raw: RawMesh, mesh: Mesh) -> str | None:
    """Names the vertex that sets the precision of a mesh, if most of the others would be known far
    more finely; None: no vertex does. Half a step of digits, integers or packed data, which is the
    same everywhere, has no such vertex. That of float64 is too fine to matter."""
    low, high = mesh.bounds
    largest = max(map(abs, (*low, *high)))
    resolution = file_resolution(raw, largest)
    if raw.number_format == "float64" or resolution < largest * FLOAT32_STEP:
        return None
    if resolution == raw.rounding:
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
    float64 = max_coordinate * FLOAT64_ROUNDING
    decimals = raw.decimals
    if raw.significant > 0 and max_coordinate > 0.0:
        leading = math.floor(math.log10(max_coordinate))
        decimals = max(decimals, raw.significant - 1 - leading)
    return max(float64, min(float32, 0.5 * 10.0**-decimals))
