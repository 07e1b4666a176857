"""CPU time of this process and of the children it has waited for."""

from __future__ import annotations

import sys
import time


class CpuClock:
    """Runs from where it is made, on all threads; what a child takes counts when it has ended."""

    def __init__(self) -> None:
        self._own, self._children = time.process_time(), _children()

    def seconds(self, *, children: bool) -> float | None:
        """children: some have been at work. None: the system does not say what they took."""
        own, theirs = time.process_time() - self._own, _children()
        if not children:
            return own
        if theirs is None or self._children is None:
            return None
        return own + theirs - self._children


def _children() -> float | None:
    if sys.platform == "win32":
        return None
    from resource import RUSAGE_CHILDREN, getrusage

    used = getrusage(RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
