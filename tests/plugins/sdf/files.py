"""Small SDFormat files as text, and what reading them gives."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.core.transform import Transform
from satcheck.scene import Issue, Refused, load_scene
from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.robot import Robot
from tests.scene.robot.robots import link_transforms, read_robot

Point = tuple[float, float, float]
BOX = '<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>'


def link(name: str, pose: str = "", inside: str = BOX) -> str:
    return f'<link name="{name}"><pose>{pose}</pose>{inside}</link>'


def joint(name: str, parent: str, child: str, kind: str = "fixed", inside: str = "") -> str:
    ends = f"<parent>{parent}</parent><child>{child}</child>"
    return f'<joint name="{name}" type="{kind}">{ends}{inside}</joint>'


def axis(xyz: str = "0 0 1", inside: str = "") -> str:
    return f"<axis><xyz>{xyz}</xyz>{inside}</axis>"


def model(name: str, *inside: str, attributes: str = "") -> str:
    return "\n".join([f'<model name="{name}" {attributes}>', *inside, "</model>"])


def sdf(*inside: str, version: str = "1.9") -> str:
    """One element a line, the first in line 2."""
    return "\n".join([f'<sdf version="{version}">', *inside, "</sdf>"])


def world(*inside: str, version: str = "1.9") -> str:
    """One element a line, the first in line 3."""
    return sdf("\n".join(['<world name="w">', *inside, "</world>"]), version=version)


def include(uri: str, inside: str = "") -> str:
    return f"<include><uri>{uri}</uri>{inside}</include>"


def write_model(folder: Path, name: str, text: str) -> None:
    """A model in a folder of its own, with a manifest."""
    place = folder / name
    place.mkdir(parents=True)
    (place / "model.config").write_text('<model><sdf version="1.9">model.sdf</sdf></model>')
    (place / "model.sdf").write_text(text)


def write(folder: Path, text: str) -> Path:
    path = folder / "w.sdf"
    path.write_text(text)
    return path


def read(
    folder: Path, text: str, geometry: GeometryKind = "collision"
) -> tuple[Robot, tuple[Issue, ...]]:
    path = write(folder, text)
    return read_robot(path, geometry=geometry)


def codes(folder: Path, text: str) -> list[str]:
    return [issue.code for issue in load_scene([write(folder, text)]).issues]


def refusal(folder: Path, text: str) -> tuple[str, str]:
    """(code, message) of a file that must be refused, its name in front."""
    path = write(folder, text)
    with pytest.raises(Refused) as caught:
        read_robot(path, "w.sdf")
    assert str(caught.value).startswith("w.sdf: line ")
    return caught.value.code, caught.value.message


def poses(robot: Robot, pose: dict[str, float] | None = None) -> dict[str, Transform]:
    """Of the links, with these values of joints."""
    values = {name: (value,) for name, value in (pose or {}).items()}
    return link_transforms(robot, values)


def origins(robot: Robot, pose: dict[str, float] | None = None) -> dict[str, Point]:
    """Of the links, rounded to nine digits."""
    return {
        name: (round(t[3], 9) + 0.0, round(t[7], 9) + 0.0, round(t[11], 9) + 0.0)
        for name, t in poses(robot, pose).items()
        if name
    }
