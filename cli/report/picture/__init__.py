"""Reports as pictures. Each module has one function `render(report, scene)`; `FORMATS` is the
registry: a format is imported when a picture is made in it.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from collections.abc import Callable

    from satcheck.report.report import Report
    from satcheck.scene import Scene

# Format -> the endings of the files that are in it.
FORMATS: dict[str, tuple[str, ...]] = {"html": (".html", ".htm")}


def render(form: str, report: Report, scene: Scene) -> str | bytes:
    """scene: that the report is about."""
    module = import_module(f"{__name__}.{form}")
    return cast("Callable[[Report, Scene], str | bytes]", module.render)(report, scene)
