"""Makes a fit out of a seed and a number, and asks whether it touches."""

from __future__ import annotations

import json
import math
from pathlib import Path
from random import Random
from typing import NamedTuple

from tests.cli.process import satcheck
from tests.fits.files import FORMATS, placed, placing, scaled
from tests.fits.solids import KINDS, Solid, solid_of

# The precision by format, as a share of the largest coordinate: `docs/formats.md`. A tolerance that
# is stated for decimals is at most two units of 1e-6.
STEPS = {"obj": 2.0**-49, "obj-rounded": 1e-6}
FLOAT32_STEP = 2.0**-23


class Result(NamedTuple):
    """answer: the relation and the severity, or how the check ended otherwise."""

    kind: str
    file_format: str
    answer: str
    detail: str
    passes: bool


def check_fit(
    folder: Path, seed: int, number: int, interferes: bool, only: str | None = None
) -> Result:
    rng = Random(f"{seed} {number} {interferes}")
    file_format = rng.choice([*FORMATS])
    file_format = only or file_format
    make, state = rng.choice(KINDS), rng.getrandbits(64)
    factor = rng.choice([0.01, 1.0, 1.0, 25.4, 1000.0])
    flush = make(Random(state), 0.0)
    # Rounded decimals may be coarser than the precision of the file, which no crack exceeds.
    has_junctions = number % 2 == 1 and file_format != "obj-rounded"
    junctions = Random(state) if has_junctions else None
    outer = solid_of(flush.outer, rng, junctions)
    by = placing(rng, factor * _size(outer))
    more = 0.0
    if interferes:
        far = max(max(map(abs, p)) for p in placed(scaled(outer, factor), by).vertices)
        far += 2 * factor * _size(outer)  # where the inner one may reach
        more = rng.uniform(3.5, 12.0) * 2 * far * STEPS.get(file_format, FLOAT32_STEP) / factor
    inner = solid_of(make(Random(state), more).inner, rng, junctions)
    solids = scaled(outer, factor), scaled(inner, factor)
    arguments = FORMATS[file_format](folder, solids, by, rng)
    ran = satcheck(*arguments, "--format", "json", "--no-depth", "-j", "1", cwd=folder)
    if ran.code < 0 or ran.code > 3 or ran.code == 2:
        return Result(flush.kind, file_format, f"exit {ran.code}", ran.err[-200:], False)
    findings = json.loads(ran.out)["findings"]
    if len(findings) != 1:
        return Result(flush.kind, file_format, f"{len(findings)} findings", ran.err[-200:], False)
    finding = findings[0]
    answer = f"{finding['relation']}, {finding['severity']}"
    steps = [s for s in finding["plan"] if s["stage"] == "touch-band"]
    why = "; ".join(f"{s['result']}: {s['detail']}" for s in steps)
    if interferes:
        passes = finding["severity"] == "error"
    else:
        passes = finding["relation"] == "touching" and finding["severity"] == "note"
    return Result(flush.kind, file_format, answer, f"{finding['reason']} | {why}", passes)


def _size(solid: Solid) -> float:
    return max(math.dist(p, q) for p in solid.vertices[:8] for q in solid.vertices)
