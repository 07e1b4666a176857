"""Small robots as text, and what reading them gives."""

from __future__ import annotations

from contextlib import chdir
from pathlib import Path

import pytest

from satcheck.core.transform import Transform
from satcheck.scene import Issue, Refused
from satcheck.scene.files.readers import GeometryKind
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.robot import Pose, Robot, settle
from satcheck.scene.robot.kinematics import link_poses
from satcheck.scene.robot.poses import values_of

SAMPLES = Path(__file__).resolve().parents[3] / "sample_meshes"
BOX = '<collision><geometry><box size="1 1 1"/></geometry></collision>'


def link_transforms(robot: Robot, pose: Pose) -> dict[str, Transform]:
    """The poses of the links of a robot in a pose."""
    values = {name: values_of(own) for name, own in settle([robot], pose).joints.items()}
    return {
        link: (*own.ravel(), 0.0, 0.0, 0.0, 1.0) for link, own in link_poses(robot, values).items()
    }


def link(name: str, inside: str = BOX) -> str:
    return f'<link name="{name}">{inside}</link>'


def joint(name: str, parent: str, child: str, kind: str = "fixed", inside: str = "") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f"{inside}</joint>"
    )


def read_robot(
    location: Path, path: str | None = None, geometry: GeometryKind = "collision"
) -> tuple[Robot, tuple[Issue, ...]]:
    """The robot of a file of any format, and the issues of its reader. path: from its folder
    on."""
    with chdir(location.parent):
        document = MeshFiles().robot(path or str(location), {}, geometry)
    assert document.robot is not None
    return document.robot, tuple(
        issue for issue in document.issues if issue.code != "no-collision-geometry"
    )


def robot_of(*elements: str) -> str:
    """One element a line, the first in line 2."""
    return "\n".join(['<robot name="r">', *elements, "</robot>"])


def read(folder: Path, text: str) -> Robot:
    return read_with_issues(folder, text)[0]


def read_with_issues(folder: Path, text: str) -> tuple[Robot, tuple[Issue, ...]]:
    path = folder / "r.urdf"
    path.write_text(text)
    return read_robot(path, "r.urdf")


def refusal(folder: Path, text: str) -> tuple[str, str]:
    """(code, message) of a URDF that must be refused, its file named."""
    with pytest.raises(Refused) as caught:
        read(folder, text)
    assert str(caught.value).startswith("r.urdf: ")
    assert "\n" not in str(caught.value)
    return caught.value.code, caught.value.message
