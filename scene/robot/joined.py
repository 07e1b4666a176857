"""Puts the robots of all inputs into a scene: URDF, SDFormat and MJCF files with their SRDFs, and
documents with joints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from msgspec.structs import replace

from satcheck.scene.bodies import IDENTITY, Scene
from satcheck.scene.robot.assembly import RobotBody, SceneRobot, permissions, with_srdfs
from satcheck.scene.robot.postures import posed
from satcheck.scene.robot.srdf import Srdf
from satcheck.scene.robot.trees import robots_of_documents
from satcheck.scene.units import InOneUnit

if TYPE_CHECKING:
    from satcheck.scene.building import Input


def with_robots(
    scene: Scene, inputs: Sequence[Input], srdfs: Sequence[Srdf], common: InOneUnit
) -> Scene:
    """Return the scene with its robots, at rest. Raises Refused."""
    robots = with_srdfs([_robot(each) for each in inputs if each.document.robot], srdfs)
    jointed = [
        (each.document, {id_: item.link for item, id_ in each.named() if item.link})
        for each in inputs
        if each.document.moves and not each.document.robot
    ]
    documents, remarks = robots_of_documents(jointed, scene.bodies, common)
    allowed, issues = [], [*scene.issues, *remarks]
    for robot in robots:
        permitted, remarks = permissions(robot)
        allowed += permitted
        issues += remarks
    scene = replace(
        scene,
        robots=(*robots, *documents),
        rules=(*allowed, *scene.rules),  # so that a rule can take a permission back
        issues=tuple(issues),
    )
    return posed(scene, {})


def _robot(added: Input) -> SceneRobot:
    document = added.document
    assert document.robot is not None
    own, bodies = [], {body.id: body for body in added.readable}
    for item, id_ in added.named():
        placed = bodies[id_].transform if id_ in bodies else item.transform
        own.append(RobotBody(id_, item.link or "", placed or IDENTITY, item.groups))
    return SceneRobot(document.robot, tuple(own), groups=added.groups)
