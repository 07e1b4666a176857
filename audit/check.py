"""Bodies in, a report out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from satcheck.audit.report import Report
from satcheck.audit.settings import Settings

if TYPE_CHECKING:
    from satcheck.scene import Scene

DEFAULT_SETTINGS = Settings()
Progress = Callable[[int, int], None]


def check(
    scene: Scene | Sequence[str | Path],
    settings: Settings = DEFAULT_SETTINGS,
    progress: Progress | None = None,
) -> Report:
    """Check every pair of bodies. progress(done, total) is called as pairs are settled."""
    raise NotImplementedError(scene, settings, progress)
