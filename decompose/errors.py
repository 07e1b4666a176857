"""The codes of failures of a decomposition, and its deadline."""

from __future__ import annotations

import math
import time
from typing import Final

from satcheck.core.errors import SatcheckError

BAD_SETTING: Final = "decomposition-bad-setting"
EMPTY: Final = "decomposition-empty-mesh"
FLAT: Final = "decomposition-flat-mesh"
TIMEOUT: Final = "decomposition-timeout"
OUT_OF_MEMORY: Final = "decomposition-out-of-memory"
CRASHED: Final = "decomposition-crashed"
FAILED: Final = "decomposition-failed"
BAD_OUTPUT: Final = "decomposition-bad-output"
NOT_ENCLOSED: Final = "decomposition-not-enclosed"


class DecompositionError(SatcheckError):
    """The mesh could not be split into convex parts; `code` is one of those above."""


class Deadline:
    """The time limit for CoACD and for the work on its parts. seconds: from now, wall clock."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self._end = time.monotonic() + seconds

    @property
    def left(self) -> float:
        return max(0.0, self._end - time.monotonic())

    def check(self) -> None:
        """Raises DecompositionError after the deadline. Call it in every long loop."""
        if time.monotonic() > self._end:
            raise self.error()

    def error(self) -> DecompositionError:
        return DecompositionError(
            TIMEOUT,
            f"no convex parts after {self.seconds:g} s; raise the limit (`--limit body-seconds=N`)"
            " or the threshold (`satcheck decompose --threshold`)",
        )


NEVER = Deadline(math.inf)
