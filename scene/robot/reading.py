"""Reads a robot, of URDF or SDFormat: the outermost element says which."""

from __future__ import annotations

from pathlib import Path

from satcheck.scene.issue import Issue, issue
from satcheck.scene.read_options import GeometryKind
from satcheck.scene.robot.model import Robot
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.urdf import robot_of
from satcheck.scene.robot.xml_tree import SDF_ROOTS, read_tree


def read_robot(
    path: str, location: Path, places: FilePlaces, geometry: GeometryKind = "collision"
) -> tuple[Robot, tuple[Issue, ...]]:
    """The robot, and issues. Raises SceneFileError with the file, the line and the element.

    path: of the file, for messages; location: where it lies. places: where included files are
    looked for. geometry: which elements of links become bodies. No mesh is opened.
    """
    root = read_tree(path, location, "robot", *SDF_ROOTS)
    if root.tag in SDF_ROOTS:
        from satcheck.scene.robot.sdf.includes import Includes
        from satcheck.scene.robot.sdf.reading import read_sdf

        robot, issues = read_sdf(root, Includes(places), geometry)
    else:
        robot, issues = robot_of(root, geometry)
    if geometry == "visual":
        message = "<visual> geometry is checked, not <collision>"
        issues = (*issues, issue("visual-geometry", message, file=path))
    return robot, issues
