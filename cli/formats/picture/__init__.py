"""Reports as pictures, a module each (`../registry.py`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from satcheck.cli.formats.registry import function_of
from satcheck.report.samples import SamplesReport

if TYPE_CHECKING:
    from satcheck.cli.formats.picture.moments import Moments
    from satcheck.report.report import Report
    from satcheck.scene import Scene


def render(
    form: str,
    report: Report | SamplesReport,
    scene: Scene,
    *,
    split: bool = False,
    pose: int | None = None,
) -> str | bytes:
    """Return the picture of a report.

    scene: that the report is about. split: a page shows convex parts, too. pose: of several that
    one; None: a page shows all of them, another picture the worst.
    """
    from satcheck.cli.formats.picture.slabs import with_slabs

    more: dict[str, object] = {}
    if isinstance(report, SamplesReport):
        report, scene, moments = _of_poses(form, report, scene, pose)
        more = {"moments": moments} if form in ("html", "png") else {}
    scene = with_slabs(scene)
    if split and form == "html":
        from satcheck.cli.formats.picture.parts import parts_of

        more["parts"] = parts_of(report, scene)
    return cast("str | bytes", function_of(form)(report, scene, **more))


def _of_poses(
    form: str, report: SamplesReport, scene: Scene, pose: int | None
) -> tuple[Report, Scene, Moments]:
    from satcheck.cli.formats.picture.poses import all_poses, one_pose, worst_pose

    if pose is None and form != "html":
        worst = worst_pose(report)
        pose = None if worst is None else worst.number
    if pose is not None:
        return one_pose(report, scene, pose)
    return all_poses(report, scene)
