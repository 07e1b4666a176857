"""Reports as pictures, a module each (`../registry.py`), and which finding and scene they show."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, cast

import numpy as np

from satcheck.audit.messages import wrong_pairs
from satcheck.audit.words import is_listed, worst_first
from satcheck.cli.formats.registry import function_of
from satcheck.core.errors import SatcheckError
from satcheck.report.samples import SamplesReport
from satcheck.report.verdict import is_failure
from satcheck.scene.statics import up_axes

if TYPE_CHECKING:
    from satcheck.cli.formats.picture.moments import Moments
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Scene

LARGEST = 1e18  # a coordinate whose square the renderer can hold: it has float32


def render(
    form: str,
    report: Report | SamplesReport,
    scene: Scene,
    *,
    split: bool = False,
    pose: int | None = None,
) -> str | bytes:
    """Return the picture of a report.

    scene: that the report is about. split: a page shows convex parts, too; a model has them if the
    report does. pose: of several that one; None: a page shows all of them, another picture the
    worst.
    """
    from satcheck.cli.formats.picture.slabs import with_slabs

    more: dict[str, object] = {}
    if isinstance(report, SamplesReport):
        report, scene, moments = _of_poses(form, report, scene, pose)
        more = {"moments": moments} if form in ("html", "png") else {}
    scene = with_slabs(scene)
    if (form == "html" and split) or (form == "glb" and report.settings.parts):
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


def headline(report: Report, moments: Moments) -> str:
    """Return `6 of 21 pairs overlap, 1 is undecided, at pose 3`."""
    return ", ".join(filter(None, [wrong_pairs(report), moments.note]))


def listed(report: Report) -> list[Finding]:
    """Findings with something to see, the worst first."""
    return worst_first(filter(is_listed, report.findings))


def drawn_finding(report: Report, scene: Scene) -> Finding | None:
    """What an image shows: the worst finding whose bodies are there; None: all bodies."""
    if shows_answers(report):
        return None
    ids = {body.id for body in scene.bodies}
    return next((f for f in listed(report) if f.a in ids and f.b in ids), None)


def shows_answers(report: Report) -> bool:
    """Whether rules ask about single bodies, and no pair fails: then a picture shows all bodies."""
    failing = any(is_failure(finding, report.settings.fail_on) for finding in report.findings)
    return bool(report.answers) and not failing


def can_be_drawn(scene: Scene) -> bool:
    try:
        bounds = [body.world_mesh().bounds for body in scene.bodies]
    except OverflowError:
        return False
    return bool(np.abs(np.array(bounds)).max(initial=0.0) < LARGEST)


def up_of(scene: Scene) -> Literal["y", "z"]:
    """The axis that points up: y in glTF (2.0, section 3.4), z in most other files."""
    return "y" if up_axes(scene) == {"y"} else "z"


def require_drawable(scene: Scene) -> None:
    """Raises SatcheckError (`not-drawable`) if coordinates are too large for a picture."""
    if not can_be_drawn(scene):
        raise SatcheckError("not-drawable", "there is no picture: coordinates are too large for it")
