"""Robots: URDF, SRDF and SDFormat -> bodies in a pose.

`load_scene` reads them. `posed` puts the robots of a scene into another pose without reading files
again. `RandomPoses` draws random poses.
"""

from satcheck.scene.robot.assembly import RobotBody, SceneRobot
from satcheck.scene.robot.joint_path import JointPath, with_joint_path
from satcheck.scene.robot.model import Joint, Robot
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.poses import Pose, RandomPoses, read_path, read_poses
from satcheck.scene.robot.postures import Posture, pose_of_states, posed, settle
from satcheck.scene.robot.srdf import Srdf, read_srdf

__all__ = [
    "FilePlaces",
    "Joint",
    "JointPath",
    "Pose",
    "Posture",
    "RandomPoses",
    "Robot",
    "RobotBody",
    "SceneRobot",
    "Srdf",
    "pose_of_states",
    "posed",
    "read_path",
    "read_poses",
    "read_srdf",
    "settle",
    "with_joint_path",
]
