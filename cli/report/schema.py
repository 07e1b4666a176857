"""The JSON Schemas (2020-12) of the documents, as published in the package.

What several of them describe stands in that of the report. One that refers to it comes with it
inside, as an embedded resource, so that each is whole.
"""

from __future__ import annotations

import json
from pathlib import Path

HERE = Path(__file__).parent
# Read where it lies, without the import of the room that it belongs to.
SCENE = HERE.parents[1] / "scene" / "format"


def text(name: str = "report") -> str:
    """The schema of one kind of document: `report` of a check, `resolution`, `samples`,
    `stability`, `suggestions`, `tradeoff`, `verification`; `scene`."""
    if name == "scene":
        return (SCENE / "scene.schema.json").read_text(encoding="utf-8")
    found = (HERE / f"{name}.schema.json").read_text(encoding="utf-8")
    report = json.loads((HERE / "report.schema.json").read_text(encoding="utf-8"))
    if name == "report" or f'"{report["$id"]}#' not in found:
        return found
    document = json.loads(found)
    document["$defs"] = {**document.get("$defs", {}), "report": report}
    return json.dumps(document, indent=2) + "\n"
