"""A report as one HTML page with a 3-D view, which works offline in any browser with WebGL 2.

`page.html` is the page, `style.css` its look, `viewer.js` the list of findings and what a click
does, `renderer.js` draws. All of them go into the one file, with the report and the geometry.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from satcheck.cli.report.picture.data import picture_data

if TYPE_CHECKING:
    from satcheck.report.report import Report
    from satcheck.scene import Scene

HERE = Path(__file__).parent


def render(report: Report, scene: Scene) -> str:
    """The whole page. scene: that the report is about."""
    page = _part("page.html")
    for name in ("style.css", "renderer.js", "viewer.js"):
        page = page.replace(f"/* {name} */", _part(name), 1)
    # Text from files must not end the element that holds it.
    data = json.dumps(picture_data(report, scene), separators=(",", ":")).replace("<", "\\u003c")
    return page.replace("/* data */", data, 1)


def _part(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")
