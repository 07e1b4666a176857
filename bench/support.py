"""Scenes of boxes and balls, asked by rules and simulated by MuJoCo (pip install mujoco).

    python -m bench.support [seconds]

MuJoCo moves each scene for some seconds; a body that moved by more than 1 % of its size, or turned
by more than 2 degrees, fell. Prints a line for each scene, and those on which the two disagree.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import mujoco
import numpy as np

from satcheck.audit import Settings, check
from satcheck.scene import load_scene

Body = dict[str, Any]
FRICTION = 0.5
TIME_STEP = 0.001
STIFF = "0.002 1"
MOVED, TURNED = 0.01, math.radians(2.0)


def box(id_: str, size: list[float], at: list[float], **more: Any) -> Body:
    return {"id": id_, "shape": {"type": "box", "size": size}, "position": at, **more}


def ball(id_: str, radius: float, at: list[float]) -> Body:
    return {"id": id_, "shape": {"type": "sphere", "radius": radius}, "position": at}


def floor() -> Body:
    return box("floor", [8, 8, 0.2], [0, 0, -0.1], static=True)


def about_y(degrees: float) -> list[float]:
    return [math.cos(math.radians(degrees) / 2), 0.0, math.sin(math.radians(degrees) / 2), 0.0]


def slope(degrees: float, height: float) -> list[Body]:
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    turn = about_y(degrees)
    plate = box("plate", [4, 4, 0.2], [-0.1 * s, 0, -0.1 * c], quaternion=turn, static=True)
    at = [s * height / 2, 0, c * height / 2]
    return [plate, box("block", [0.3, 0.3, height], at, quaternion=turn)]


def tower(offsets: list[float], size: float = 0.4, height: float = 0.2) -> list[Body]:
    bodies, x = [floor()], 0.0
    for k, step in enumerate(offsets):
        x += step
        bodies.append(box(f"brick {k}", [size, size, height], [x, 0, height * (k + 0.5)]))
    return bodies


def lintel(gap: float, overlap: float) -> list[Body]:
    reach = gap / 2 + 0.1
    posts = [box(f"post {x}", [0.2, 0.2, 0.8], [x, 0, 0.4]) for x in (-reach, reach)]
    beam = box("beam", [gap + 2 * overlap, 0.2, 0.1], [0, 0, 0.85])
    return [floor(), *posts, beam]


def cantilever(weight: float) -> list[Body]:
    table = box("table", [1, 1, 0.5], [-0.5, 0, 0.25], static=True)
    plank = box("plank", [1.0, 0.2, 0.05], [0.1, 0, 0.525])
    cube = box("weight", [weight, 0.2, 0.2], [-0.4 + weight / 2, 0, 0.65])
    return [table, plank, cube]


def leaning(degrees: float) -> list[Body]:
    """A plank against a wall."""
    angle, length, thick = math.radians(degrees), 1.0, 0.05
    s, c = math.sin(angle), math.cos(angle)
    wall = box("wall", [0.2, 2, 2], [-0.1, 0, 1], static=True)
    centre = [length / 2 * c + thick / 2 * s, 0, length / 2 * s + thick / 2 * c]
    plank = box("plank", [length, 0.3, thick], centre, quaternion=about_y(degrees))
    return [floor(), wall, plank]


def scenes() -> dict[str, list[Body]]:
    made: dict[str, list[Body]] = {}
    rng = np.random.default_rng(7)
    for k in range(8):
        offsets = [0.0, *rng.uniform(-0.15, 0.15, 4).tolist()]
        made[f"random tower {k}"] = tower(offsets)
    for degrees in (20.0, 25.5, 27.5):
        made[f"slope {degrees}"] = slope(degrees, 0.3)
    for degrees in (15.0, 24.0):
        made[f"tall block on {degrees}"] = slope(degrees, 0.9)
    for gap, overlap in ((0.6, 0.1), (0.6, 0.01)):
        made[f"lintel {gap} {overlap}"] = lintel(gap, overlap)
    for weight in (0.05, 0.2):
        made[f"cantilever {weight}"] = cantilever(weight)
    for degrees in (40.0, 50.0, 60.0, 75.0):
        made[f"plank at {degrees}"] = leaning(degrees)
    stops = [box(f"stop {x}", [0.1, 1, 0.4], [x, 0, 0.2], static=True) for x in (-0.45, 0.45)]
    low = [ball("left", 0.2, [-0.2, 0, 0.2]), ball("right", 0.2, [0.2, 0, 0.2])]
    made["lid on a ball"] = [floor(), low[0], box("lid", [0.2, 0.2, 0.05], [-0.2, 0, 0.425])]
    made["board on two balls between stops"] = [
        floor(),
        *stops,
        *low,
        box("board", [0.7, 0.3, 0.05], [0, 0, 0.425]),
    ]
    return made


def by_rules(folder: Path, bodies: list[Body]) -> tuple[str, str]:
    """The worst answer of the free bodies, and doubts."""
    document = {
        "schema": "satcheck.scene/1",
        "units": "m",
        "statics": {"gravity": [0, 0, -1], "friction": FRICTION, "tolerance": 1e-3},
        "rules": [{"bodies": "*", "stable": True}],
        "bodies": bodies,
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    statics = check(load_scene([path]), Settings(tolerance=1e-3)).support
    assert statics is not None
    answers = {finding.answer for finding in statics.findings}
    worst = next(answer for answer in ("no", "open", "yes") if answer in answers)
    margins = [island.margin for island in statics.islands if island.margin]
    doubts = ["squeezed" for island in statics.islands if island.squeezed]
    doubts += [f"tilt {min(high for _, high in margins):.3g}"] if margins else []
    return worst, " ".join(doubts)


def by_simulation(bodies: list[Body], seconds: float) -> bool:
    """Whether a body fell."""
    rows = []
    for body in bodies:
        shape = body["shape"]
        sizes = [shape["radius"]] if shape["type"] == "sphere" else [s / 2 for s in shape["size"]]
        geom = f'<geom type="{shape["type"]}" size="{_text(sizes)}"/>'
        place = (
            f'pos="{_text(body["position"])}" quat="{_text(body.get("quaternion", [1, 0, 0, 0]))}"'
        )
        joint = "" if body.get("static") else "<freejoint/>"
        rows.append(f"<body {place}>{joint}{geom}</body>")
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{TIME_STEP}" cone="elliptic"/><default><geom solref="{STIFF}" '
        f'friction="{FRICTION} 0 0"/></default><worldbody>{"".join(rows)}</worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    start = data.qpos.copy().reshape(-1, 7)
    for _ in range(round(seconds / TIME_STEP)):
        mujoco.mj_step(model, data)
    moved = data.qpos.reshape(-1, 7)
    free = [body for body in bodies if not body.get("static")]
    for body, old, new in zip(free, start, moved, strict=True):
        size = 2 * body["shape"].get("radius", max(body["shape"].get("size", [0])) / 2)
        turn = 2 * math.acos(min(abs(float(old[3:] @ new[3:])), 1.0))
        if np.linalg.norm(new[:3] - old[:3]) > MOVED * size or turn > TURNED:
            return True
    return False


def _text(numbers: list[float]) -> str:
    return " ".join(map(repr, map(float, numbers)))


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 3.0
    differ = 0
    with TemporaryDirectory() as folder:
        for name, bodies in scenes().items():
            answer, doubts = by_rules(Path(folder), bodies)
            fell = by_simulation(bodies, seconds)
            same = (answer == "no") == fell and answer != "open"
            differ += not same
            mark = "" if same else "  <- differs"
            line = f"{name:36} {answer:5} {'fell' if fell else 'stood':6} {doubts}{mark}"
            sys.stdout.write(f"{line}\n")
    sys.stdout.write(f"{len(scenes())} scenes, {differ} differ\n")


if __name__ == "__main__":
    main()
