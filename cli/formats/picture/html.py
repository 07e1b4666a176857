"""A report as one HTML page with a 3-D view, which works offline in any browser with WebGL 2.

`page.html` is the page and `style.css` its look. `camera.js` looks, `meshes.js` reads bodies and
makes arrows and balls, `renderer.js` draws, `picture.js` decides what is drawn of a finding,
`list.js` has the list of findings, `viewer.js` what the mouse and the keys do. All of them go into
the one file.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satcheck.cli.formats.picture.data import picture_data
from satcheck.cli.formats.picture.packing import packed_text

if TYPE_CHECKING:
    from satcheck.cli.formats.picture.geometry import Parts
    from satcheck.cli.formats.picture.moments import Moments
    from satcheck.report.report import Report
    from satcheck.scene import Scene

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
