"""Scenes of boxes and balls whose equilibrium is known in closed form."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from satcheck.audit import Settings, check
from satcheck.report.report import Report
from satcheck.report.statics import Statics
from satcheck.scene import Scene, load_scene

Body = dict[str, Any]
TOLERANCE = 1e-3


def box(id_: str, size: list[float], at: list[float], **more: Any) -> Body:
    return {"id": id_, "shape": {"type": "box", "size": size}, "position": at, **more}


def ball(id_: str, radius: float, at: list[float], **more: Any) -> Body:
    return {"id": id_, "shape": {"type": "sphere", "radius": radius}, "position": at, **more}


def floor(**more: Any) -> Body:
    return box("floor", [6, 6, 0.2], [0, 0, -0.1], **{"static": True, **more})


def about_y(degrees: float) -> list[float]:
    half = math.radians(degrees) / 2
    return [math.cos(half), 0.0, math.sin(half), 0.0]


def on_slope(degrees: float, size: float = 0.3) -> list[Body]:
    """A cube at rest on a plate that is turned about y through the origin."""
    turn = about_y(degrees)
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))

    def up(height: float) -> list[float]:
        return [s * height, 0.0, c * height]

    return [
        box("plate", [3, 3, 0.2], up(-0.1), quaternion=turn, static=True),
        box("cube", [size] * 3, up(size / 2), quaternion=turn),
    ]


def tower(overhang: float) -> list[Body]:
    """Two bricks of length 1; the upper one lies over the edge of the lower one by its overhang."""
    return [
        floor(),
        box("base", [1, 1, 0.5], [0, 0, 0.25]),
        box("top", [1, 1, 0.5], [overhang, 0, 0.75]),
    ]


def loaded(
    folder: Path, bodies: list[Body], rules: list[dict[str, Any]] | None = None, **statics: Any
) -> Scene:
    """rules: by default, every body is asked whether it is supported and stable."""
    terms = {"gravity": [0, 0, -1], "friction": 0.5, "tolerance": TOLERANCE, **statics}
    document = {
        "schema": "satcheck.scene/1",
        "units": "m",
        "statics": {key: value for key, value in terms.items() if value is not None},
        "rules": [{"bodies": "*", "supported": True, "stable": True}] if rules is None else rules,
        "bodies": bodies,
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    return load_scene([path])


def report_of(folder: Path, bodies: list[Body], *rest: Any, **statics: Any) -> Report:
    scene = loaded(folder, bodies, *rest, **statics)
    return check(scene, Settings(tolerance=TOLERANCE, jobs=1))


def support(folder: Path, bodies: list[Body], *rest: Any, **statics: Any) -> Statics:
    found = report_of(folder, bodies, *rest, **statics).support
    assert found is not None
    return found


def answers(statics: Statics, question: str = "stable") -> dict[str, str]:
    return {f.body: f.answer for f in statics.findings if f.question == question}
