"""Small MJCF files as text, and what reading them gives."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest

from satcheck.audit import Settings
from satcheck.audit.check import check
from satcheck.scene import Refused, Scene, load_scene
from satcheck.scene.robot import Robot, posed
from tests.scene.robot.robots import read_robot

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def geom(name: str, more: str = "", kind: str = "box", size: str = ".5 .5 .5") -> str:
    return f'<geom name="{name}" type="{kind}" size="{size}" {more}/>'


def body(name: str, *inside: str, pos: str = "0 0 0", more: str = "") -> str:
    return f'<body name="{name}" pos="{pos}" {more}>{"".join(inside)}</body>'


def model(*inside: str, before: str = "", after: str = "") -> str:
    """The world body, and what stands before and after it."""
    return "\n".join(
        ['<mujoco model="m">', before, "<worldbody>", *inside, "</worldbody>", after, "</mujoco>"]
    )


def write(folder: Path, text: str, name: str = "m.xml") -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def load(folder: Path, text: str, **options: object) -> Scene:
    return load_scene([write(folder, text)], **options)  # type: ignore[arg-type]


def read(folder: Path, text: str) -> Robot:
    return read_robot(write(folder, text))[0]


def codes(scene: Scene) -> list[str]:
    return [issue.code for issue in scene.issues]


def refusal(folder: Path, text: str) -> tuple[str, str]:
    """(code, message) of a file that must be refused, its name in front."""
    path = write(folder, text)
    with pytest.raises(Refused) as caught:
        load_scene([path])
    assert str(caught.value).startswith(path.as_posix())
    return caught.value.code, caught.value.message


def allowed(scene: Scene) -> dict[tuple[str, str], str]:
    """The pairs that are not checked, with the reason of the last rule."""
    found: dict[tuple[str, str], str] = {}
    for x, y in combinations([body.id for body in scene.in_order()], 2):
        for rule in scene.rules:
            a, b = ({body.id for body in s.select(scene.in_order())} for s in (rule.a, rule.b))
            if (x in a and y in b) or (y in a and x in b):
                found[x, y] = rule.reason or ""
                if rule.allowed is False:
                    del found[x, y]
    return found


def relations(scene: Scene) -> dict[tuple[str, str], str | None]:
    return {(f.a, f.b): f.relation for f in check(scene, Settings()).findings}


def centres(scene: Scene, pose: dict[str, tuple[float, ...]] | None = None) -> dict[str, object]:
    """The middle of each body in the pose, rounded to nine digits."""
    centre = {}
    for each in posed(scene, pose or {}).bodies:
        mesh = each.file.mesh
        low, high = (mesh.transformed(each.transform) if each.transform else mesh).bounds
        middle = ((a + b) / 2 for a, b in zip(low, high, strict=True))
        centre[each.id] = tuple(round(c, 9) + 0.0 for c in middle)
    return centre
