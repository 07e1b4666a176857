"""The rungs of a study, from the cheapest to the most expensive."""

from __future__ import annotations

from collections.abc import Collection

from msgspec import Struct

from satcheck.audit.request.settings import Accuracy


class Rung(Struct, frozen=True):
    """accuracy: where the ladder ends; None: the Boolean, which is no rung of it.

    threshold: of the convex parts, see satcheck.decompose; None for the other rungs.
    """

    name: str
    accuracy: Accuracy | None
    threshold: float | None = None

    @property
    def label(self) -> str:
        """`hull`, `parts 0.05`."""
        return self.name if self.threshold is None else f"{self.name} {self.threshold:g}"


EXACT = Rung("exact", "exact")
BOOLEAN = Rung("boolean", None)
THRESHOLDS = (0.5, 0.2, 0.1, 0.05, 0.02, 0.01)
# In the order in which they are shown, ...
RUNGS = (
    Rung("aabb", "aabb"),
    Rung("obb", "obb"),
    Rung("hull", "hull"),
    *(Rung("parts", "parts", threshold) for threshold in THRESHOLDS),
    EXACT,
    BOOLEAN,
)
# ... and in which they take turns: the proof and what is cheap, and then convex parts, the dearest,
# so that it is these that a budget cuts.
GROUPS: tuple[tuple[Rung, ...], ...] = (
    (EXACT, *(rung for rung in RUNGS if rung.name not in ("parts", "exact"))),
    tuple(rung for rung in RUNGS if rung.name == "parts"),
)


def labels_of(rungs: Collection[Rung]) -> str:
    """`obb, parts 0.5 .. 0.1, exact`: in the order of RUNGS, neighbouring thresholds as one."""
    runs: list[list[Rung]] = []
    for before, rung in zip((None, *RUNGS), RUNGS, strict=False):
        if rung not in rungs:
            continue
        if runs and runs[-1][-1] == before and runs[-1][-1].name == rung.name:
            runs[-1].append(rung)
        else:
            runs.append([rung])
    return ", ".join(
        run[0].label if len(run) == 1 else f"{run[0].label} .. {run[-1].threshold:g}"
        for run in runs
    )
