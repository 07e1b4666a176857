"""Reports as pictures, a module each (`../registry.py`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from satcheck.cli.formats.registry import function_of

if TYPE_CHECKING:
    from satcheck.report.report import Report
    from satcheck.scene import Scene


def render(form: str, report: Report, scene: Scene, *, split: bool = False) -> str | bytes:
    """Return the picture of a report.

    scene: that the report is about. split: a page shows convex parts, too.
    """
    from satcheck.cli.formats.picture.slabs import with_slabs

    scene = with_slabs(scene)
    draw = function_of(form)
    if split and form == "html":
        from satcheck.cli.formats.picture.parts import parts_of

        return cast("str", draw(report, scene, parts_of(report, scene)))
    return cast("str | bytes", draw(report, scene))
