"""Until when parts have to be made: CoACD ends by it, and so does what is done with its parts."""

from __future__ import annotations

import math
import time

from satcheck.decompose import errors
from satcheck.decompose.errors import DecompositionError


class Deadline:
    """seconds: from here on, wall clock."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self._end = time.monotonic() + seconds

    @property
    def left(self) -> float:
        return max(0.0, self._end - time.monotonic())

    def check(self) -> None:
        """Raises DecompositionError once it is over. To be asked in every long loop."""
        if time.monotonic() > self._end:
            raise self.error()

    def error(self) -> DecompositionError:
        return DecompositionError(
            errors.TIMEOUT,
            f"no convex parts after {self.seconds:g} s; raise the limit or the threshold",
        )


NEVER = Deadline(math.inf)
