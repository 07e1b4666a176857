"""How finely a file's coordinates were written: the default width of "touching"."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from satcheck.scene.loading.raw_mesh import Precision, RawMesh

FLOAT16_STEP = 2.0**-10  # spacing of float16 numbers relative to their power of two
FLOAT32_STEP = 2.0**-23  # the same of float32
FLOAT64_ROUNDING = 2.0**-53  # largest relative error of rounding to float64
STEPS: dict[Precision, float] = {
    "float16": FLOAT16_STEP,
    "float32": FLOAT32_STEP,
    "float64": FLOAT64_ROUNDING,
}


def placement_step(raw: RawMesh, *, by_file: bool) -> float:
    """How finely the numbers of a placement are known, relative to the coordinates they make.

    by_file: the file itself places its mesh. One that stores coordinates as float32 comes from a
    program that keeps placements no finer; all others are taken as they are written.
    """
    return FLOAT32_STEP if by_file and raw.precision == "float32" else FLOAT64_ROUNDING


def file_resolution(raw: RawMesh, max_coordinate: float) -> float:
    """The input's own precision, in file units.

    max_coordinate: largest |coordinate| of the mesh. float16, float32: the spacing of these there.
    float64: half the spacing of float64 there. Written digits: half a unit of the last
    digit of the most precise number, between these two. A number with an exponent shows digits
    relative to its own size, so its digits are counted down from the largest coordinate: the
    -4.4e-08 that stands for 0 in many files does not promise eight decimals.
    """
    if raw.precision in STEPS:
        return max_coordinate * STEPS[raw.precision]
    float32 = max_coordinate * FLOAT32_STEP
    float64 = max_coordinate * FLOAT64_ROUNDING
    decimals = raw.decimals
    if raw.significant > 0 and max_coordinate > 0.0:
        leading = math.floor(math.log10(max_coordinate))
        decimals = max(decimals, raw.significant - 1 - leading)
    return max(float64, min(float32, 0.5 * 10.0**-decimals))
