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
FORMATS: dict[str, tuple[str, ...]] = {
    "html": (".html", ".htm"),
    "png": (".png",),
    "glb": (".glb",),
    "bcf": (".bcf",),
}


def render(
    form: str, report: Report, scene: Scene, *, split: bool = False, cache: bool = True
) -> str | bytes:
    """scene: that the report is about. split: a page shows convex parts, too. cache: of these."""
    from satcheck.cli.formats.picture.slabs import with_slabs

    package = "satcheck.plugins.ifc" if form == "bcf" else __name__
    module = import_module(f"{package}.{form}")
    scene = with_slabs(scene)
    if split and form == "html":
        from satcheck.cli.formats.picture.parts import parts_of

        return cast("str", module.render(report, scene, parts_of(report, scene, cache=cache)))
    return cast("Callable[[Report, Scene], str | bytes]", module.render)(report, scene)
