"""Why a mesh has no convex parts: the codes of decomposition failures, in one place."""

from __future__ import annotations

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

CODES: Final = frozenset(
    {BAD_SETTING, EMPTY, FLAT, TIMEOUT, OUT_OF_MEMORY, CRASHED, FAILED, BAD_OUTPUT}
)


class DecompositionError(SatcheckError):
    """The mesh could not be split into convex parts; `code` is one of CODES."""
