"""Reads a robot, of URDF, SDFormat or MJCF: the outermost element says which."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from satcheck.scene.errors import MeshFileError, SceneFileError
from satcheck.scene.issue import Issue, issue
from satcheck.scene.read_options import GeometryKind
from satcheck.scene.robot.model import Robot
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.urdf import robot_of
from satcheck.scene.robot.xml_tree import MJCF_ROOT, SDF_ROOTS, read_tree

if TYPE_CHECKING:
    from satcheck.plugins.mjcf.messages import Model


def read_robot(
    path: str,
    location: Path,
    places: FilePlaces,
    geometry: GeometryKind = "collision",
    *,
    compiled: Callable[[str], Model] | None = None,
    hulls: bool = False,
) -> tuple[Robot, tuple[Issue, ...]]:
    """The robot, and issues. Raises SceneFileError with the file, the line and the element.

    path: of the file, for messages; location: where it lies. places: where included files are
    looked for. geometry: which elements of links become bodies. No mesh is opened. compiled:
    what MuJoCo says about an MJCF file. hulls: of its meshes are meant.
    """
    root = read_tree(path, location, "robot", *SDF_ROOTS, MJCF_ROOT)
    if root.tag in SDF_ROOTS:
        from satcheck.plugins.sdf.includes import Includes
        from satcheck.plugins.sdf.reading import read_sdf

        robot, issues = read_sdf(root, Includes(places), geometry)
    elif root.tag == MJCF_ROOT and compiled is not None:
        from satcheck.plugins.mjcf.reading import robot_of_model

        robot, issues = robot_of_model(path, _model(path, compiled), geometry, hulls=hulls)
    else:
        robot, issues = robot_of(root, geometry)
    if geometry == "visual":
        message = "visual geometry is checked, not collision geometry"
        issues = (*issues, issue("visual-geometry", message, file=path))
    return robot, issues


def _model(path: str, compiled: Callable[[str], Model]) -> Model:
    try:
        return compiled(path)
    except MeshFileError as error:
        raise SceneFileError(error.code, error.message, file=error.file) from error.__cause__
