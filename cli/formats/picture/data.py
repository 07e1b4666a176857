"""What the page shows, as JSON values: findings, the worst first, and the geometry of bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from msgspec import to_builtins

from satcheck.audit.messages import measured
from satcheck.audit.words import counted, interval, is_listed, severity, with_unit, worst_first
from satcheck.cli.formats.details import facts
from satcheck.cli.formats.picture.body_answers import arrows_of, states_of, without_regions
from satcheck.cli.formats.picture.geometry import geometry
from satcheck.cli.formats.picture.packing import packed_points
from satcheck.cli.formats.summary import summary_line
from satcheck.cli.output import issue_line
from satcheck.core.errors import SatcheckError
from satcheck.report.verdict import is_failure
from satcheck.scene.statics import up_axes
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    import numpy.typing as npt

    from satcheck.cli.formats.picture.geometry import Parts
    from satcheck.report.components import Component
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Scene

    Floats = npt.NDArray[np.float64]

ROOM = 1_800_000  # characters for meshes, of a page that should be no larger than 2 MB
MOST_COMPONENTS = 100  # of a finding; JSON has them all
LARGEST = 1e18  # a coordinate whose square the renderer can hold: it has float32


def picture_data(report: Report, scene: Scene, parts: Parts | None = None) -> dict[str, Any]:
    """Lengths in units of the scene, relative to the middle of all bodies. A body that cannot be
    drawn has no number. parts: convex parts to show."""
    scene = without_regions(scene)
    bodies = list(scene.bodies) if can_be_drawn(scene) else []
    findings = listed(report)
    met = frozenset(id_ for finding in findings for id_ in (finding.a, finding.b))
    drawn = geometry(bodies, met, parts or {}, ROOM)
    numbers = {body.id: k for k, body in enumerate(bodies)}
    unit = unit_of(report.units)
    others = counted(len(bodies) - len(met & numbers.keys()), "body", "bodies")
    simpler = f"Simplified: {others} without findings, to {drawn.simplified}"
    return {
        "title": summary_line(report),
        "verdict": report.summary.verdict,
        "unit": unit or "",
        "up": up_of(scene),
        "simplified": simpler if drawn.simplified else "",
        "findings": [_shown(finding, report, numbers, drawn.middle) for finding in findings],
        "points": _packed_points(findings),
        "states": {
            numbers[id_]: state for id_, state in states_of(report).items() if id_ in numbers
        },
        "all": shows_answers(report),
        "arrows": [
            {"from": _relative(start, drawn.middle), "way": _relative(way, 0.0), "kind": kind}
            for start, way, kind in (arrows_of(report, scene) if bodies else ())
        ],
        "issues": [issue_line(issue) for issue in report.issues],
        "drawn": len(bodies) == len(scene.bodies),
        **drawn.values,
    }


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


def lines_of(finding: Finding) -> list[list[tuple[float, float, float]]]:
    """Where the surfaces cross, and the outlines of patches in which both lie; a closed line
    repeats its start."""
    if finding.contacts is None:
        return []
    curves = [[*c.points, *c.points[: c.closed]] for c in finding.contacts.curves]
    outlines = (outline for patch in finding.contacts.patches for outline in patch.outlines)
    return [*curves, *([*outline, outline[0]] for outline in outlines)]


def _points(finding: Finding) -> Floats:
    return np.array([point for line in lines_of(finding) for point in line]).reshape(-1, 3)


def _packed_points(findings: list[Finding]) -> str:
    """Of the lines of all findings, within the box of each."""
    points = [np.empty((0, 3)), *map(_points, findings)]
    boxes = [np.broadcast_to(_box(each), (len(each), 2, 3)) for each in points]
    return packed_points(np.concatenate(points), np.concatenate(boxes))


def _box(points: Floats) -> Floats:
    """(2, 3): least and greatest corner."""
    return np.array([points.min(axis=0), points.max(axis=0)]) if len(points) else np.zeros((2, 3))


def _shown(
    finding: Finding, report: Report, numbers: dict[str, int], middle: Floats
) -> dict[str, Any]:
    """lines: how many of `points` each has, which stand in the order of the findings. box: of all
    these points."""
    unit = unit_of(report.units)
    witness = None if finding.witness is None else to_builtins(finding.witness)
    ball, items = finding.ball, finding.components.items if finding.components else ()
    thickness = with_unit(interval(finding.thickness_bounds), unit)
    return {
        "names": [finding.a, finding.b],
        "a": numbers.get(finding.a),
        "b": numbers.get(finding.b),
        "relation": finding.relation,
        "measured": measured(finding, unit),
        "severity": severity(finding),
        "text": finding.message,
        "mtv": finding.mtv,
        "ends": bool(finding.mtv_verified),
        "axis": finding.normal,
        "witness": witness and [_relative(witness[body], middle) for body in ("a", "b")],
        "ball": ball
        and {
            "centre": _relative(ball.centre, middle),
            "radius": ball.radius,
            "text": f"thickness {thickness}",
        },
        "components": [_component(item, finding, middle) for item in items[:MOST_COMPONENTS]],
        "more": max(len(items) - MOST_COMPONENTS, 0),
        "lines": list(map(len, lines_of(finding))),
        "box": [_relative(corner, middle) for corner in _box(_points(finding))],
    }


def _component(item: Component, finding: Finding, middle: Floats) -> dict[str, Any]:
    return {
        "text": ", ".join(facts(item, finding)),
        "low": _relative(item.bounds[0], middle),
        "high": _relative(item.bounds[1], middle),
        "point": _relative(item.point, middle),
    }


def _relative(point: Any, middle: Floats | float) -> list[float]:
    """As many digits as a float32 of the renderer holds."""
    return [float(f"{value:.8g}") for value in np.array(point) - middle]
