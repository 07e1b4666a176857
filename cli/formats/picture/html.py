"""A report as one HTML page with a 3-D view, which works offline in any browser with WebGL 2.

`page.html` is the page and `style.css` its look. `camera.js` looks, `meshes.js` reads bodies and
makes arrows and balls, `renderer.js` draws, `picture.js` decides what is drawn of a finding,
`list.js` has the list of findings, `viewer.js` what the mouse and the keys do. All of them go into
the one file.
"""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from satcheck.audit.messages import measured
from satcheck.audit.words import counted
from satcheck.cli.formats.details import facts
from satcheck.cli.formats.picture import can_be_drawn, headline, listed, shows_answers, up_of
from satcheck.cli.formats.picture.body_answers import arrows_of, states_of, without_regions
from satcheck.cli.formats.picture.geometry import geometry
from satcheck.cli.formats.picture.moments import Moments, moments_of
from satcheck.cli.formats.picture.packing import packed_points, packed_text
from satcheck.cli.formats.picture.shown import Shows
from satcheck.cli.formats.picture.viewpoint import of_all
from satcheck.cli.formats.summary import summary_line
from satcheck.cli.output import issue_line
from satcheck.report.report import OVERLAPS
from satcheck.report.verdict import severity
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from satcheck.cli.formats.picture.geometry import Parts
    from satcheck.cli.formats.picture.shown import Shown
    from satcheck.cli.formats.picture.viewpoint import Viewpoint
    from satcheck.report.contacts import Component
    from satcheck.report.report import Finding, Issue, Report
    from satcheck.scene import Scene

    Floats = npt.NDArray[np.float64]

MOST_FINDINGS = 1000  # the worst; the page counts those after them
CLOSELY = 50  # findings, the worst first, for which rays choose the viewpoint
ROOM = 1_800_000  # characters for meshes, of a page that should be no larger than 2 MB
MOST_COMPONENTS = 100  # of a finding; JSON has them all
HERE = Path(__file__).parent
SOURCES = (
    "style.css",
    *("camera.js", "meshes.js", "renderer.js", "picture.js", "list.js", "viewer.js"),
)


def render(
    report: Report, scene: Scene, parts: Parts | None = None, moments: Moments | None = None
) -> str:
    """The whole page. scene: that the report is about. parts: convex parts to show. moments: None:
    those of the motions."""
    page = _part("page.html")
    for name in SOURCES:
        page = page.replace(f"/* {name} */", _part(name), 1)
    content = picture_data(report, scene, parts, moments)
    data = _json({**content, "findings": packed_text(_json(content["findings"]))})
    # Text from files must not end the element that holds it.
    return page.replace("/* data */", data.replace("<", "\\u003c"), 1)


def _json(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"))


def _part(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")


def picture_data(
    report: Report, scene: Scene, parts: Parts | None = None, moments: Moments | None = None
) -> dict[str, Any]:
    """Lengths in units of the scene, relative to the middle of all bodies. A body that cannot be
    drawn has no number. parts: convex parts to show. moments: None: those of the motions."""
    scene = without_regions(scene)
    bodies = list(scene.bodies) if can_be_drawn(scene) else []
    moments = (moments or moments_of(report, scene)) if bodies else Moments()
    every = listed(report)
    findings = every[:MOST_FINDINGS]
    met = frozenset(id_ for finding in findings for id_ in (finding.a, finding.b))
    drawn = geometry(bodies, met, parts or {}, ROOM, moments.placed)
    numbers = {body.id: k for k, body in enumerate(bodies)}
    others = counted(len(bodies) - len(met & numbers.keys()), "body", "bodies")
    simpler = f"Simplified: {others} without findings, to {drawn.simplified}"
    up = up_of(scene)
    shows = Shows(report, scene, moments, up)
    shown = []
    for rank, finding in enumerate(findings):
        stated = _stated(finding, report, drawn.middle)
        if {finding.a, finding.b} <= numbers.keys():
            seen = shows.of(finding, closely=rank < CLOSELY)
            stated |= _drawn(seen, numbers, drawn.middle)
            if moments.note:  # several poses
                stated["measured"] += f", {moments.names[seen.moment]}" if moments.names else ""
        else:
            stated |= {"a": numbers.get(finding.a), "b": numbers.get(finding.b)}
        shown.append(stated)
    return {
        "title": headline(report, moments),
        "summary": report.message if moments.note else summary_line(report),
        "verdict": report.summary.verdict,
        "unit": unit_of(report.units) or "",
        "up": up,
        "view": _view(of_all(bodies, up), drawn.middle) if bodies else None,
        "simplified": simpler if drawn.simplified else "",
        "findings": shown,
        "unlisted": len(every) - len(findings),
        "states": {
            numbers[id_]: state for id_, state in states_of(report).items() if id_ in numbers
        },
        "all": shows_answers(report),
        "arrows": [
            {"from": _relative(start, drawn.middle), "way": _relative(way, 0.0), "kind": kind}
            for start, way, kind in (arrows_of(report, scene) if bodies else ())
        ],
        "moments": moments.names,
        "issues": [issue_line(issue) for issue in report.issues],
        "counted": _counted(report.issues),
        "drawn": len(bodies) == len(scene.bodies),
        **drawn.values,
    }


def _counted(issues: Sequence[Issue]) -> str:
    """`1 error, 3 warnings`."""
    counts = Counter(issue.severity for issue in issues)
    return ", ".join(
        counted(counts[one], one) for one in ("error", "warning", "note") if counts[one]
    )


def _stated(finding: Finding, report: Report, middle: Floats) -> dict[str, Any]:
    """What the report says."""
    witness, ball = finding.witness, finding.ball
    items = finding.components.items if finding.components else ()
    return {
        "names": [finding.a, finding.b],
        "relation": finding.at_rest,
        "overlaps": finding.at_rest in OVERLAPS,
        "measured": measured(finding, unit_of(report.units)),
        "severity": severity(finding),
        "text": finding.message,
        "mtv": finding.mtv,
        "ends": bool(finding.mtv_verified),
        "axis": finding.normal,
        "witness": witness and [_relative(witness.a, middle), _relative(witness.b, middle)],
        "ball": ball and {"centre": _relative(ball.centre, middle), "radius": ball.radius},
        "components": [_component(item, finding, middle) for item in items[:MOST_COMPONENTS]],
        "parts": finding.part_pairs.overlapping_parts() if finding.part_pairs else ([], []),
        "more": max(len(items) - MOST_COMPONENTS, 0),
    }


def _drawn(shown: Shown, numbers: dict[str, int], middle: Floats) -> dict[str, Any]:
    """What the picture adds. labels: the text, where it stands, and what it is about; the name of a
    body stands at a point in the box of its mesh, whose sides are 1. points: of all lines, within
    `box`. lines: how many points each has. rims: how many of the lines, the last ones, are those of
    a hole."""
    finding, marks = shown.finding, shown.marks
    rims = marks.rim.lines if marks.rim else []
    lines = [*marks.lines, *rims]
    points = np.concatenate([np.empty((0, 3)), *lines])
    box = np.array([points.min(axis=0), points.max(axis=0)]) if lines else np.zeros((2, 3))
    return {
        "a": numbers[finding.a],
        "b": numbers[finding.b],
        "moment": shown.moment,
        "place": _relative(shown.place, middle),
        "from": marks.way and _relative(marks.way[0], middle),
        "gap": marks.gap and [_relative(point, middle) for point in marks.gap],
        "hit": None if marks.hit is None else _relative(marks.hit, middle),
        "labels": [
            [text, _relative(at, middle) if kind not in "ab" else _in_box(shown, at, kind), kind]
            for text, at, kind in shown.labels
        ],
        "view": _view(shown.view, middle),
        "points": packed_points(points, box),
        "box": [_relative(corner, middle) for corner in box],
        "lines": [*map(len, lines)],
        "rims": len(rims),
    }


def _in_box(shown: Shown, at: Floats, kind: str) -> list[float]:
    low, high = np.array(shown.pair["ab".index(kind)].file.mesh.bounds)
    size = np.where(high > low, high - low, 1.0)
    return _relative(at / size, low / size)


def _view(view: Viewpoint, middle: Floats) -> dict[str, Any]:
    return {
        "target": _relative(view.target, middle),
        "radius": view.radius,
        "towards": _relative(view.towards, 0.0),
        "clear": view.clear,
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
