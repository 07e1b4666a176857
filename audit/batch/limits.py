"""Limits of the check of one world, and the number of worlds in a chunk of work."""

from __future__ import annotations

from msgspec import Struct

# A measured time is at least this long, as clocks are coarse.
_SHORTEST_SECONDS = 1e-3


class Limits(Struct, frozen=True):
    """For one world. seconds: wall-clock time. megabytes: address space of its process, in MiB."""

    seconds: float = 600.0
    megabytes: int = 4096


class Pace:
    """size: worlds of the next chunk. It begins at 1, as the first world may take long, and at most
    doubles with each chunk that is measured."""

    def __init__(self, largest: int) -> None:
        self._largest = largest
        self.size = 1

    def measure(self, worlds: int, took: float, wanted: float) -> None:
        """took, wanted: seconds, for these worlds and for the next chunk."""
        fitting = round(worlds * wanted / max(took, _SHORTEST_SECONDS))
        self.size = max(1, min(2 * self.size, fitting, self._largest))
