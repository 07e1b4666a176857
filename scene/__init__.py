"""satcheck.scene turns files into bodies and inspects each mesh before it is used.

`load_scene(paths)` reads mesh files (OBJ, STL, PLY, OFF, GLB, glTF, 3MF, DAE, STEP), buildings
(IFC), stages (USD), scene files (`satcheck.scene/1`, `satcheck-scene-1`) and robots (URDF, SRDF,
SDFormat; `scene.robot` poses them). A mesh file that cannot be used is reported as `Unreadable`;
warnings about the others are `Issue`s with the stable codes of `CODES`.
"""

from satcheck.core.mesh_health import MeshHealth
from satcheck.scene.bodies import Body, MeshFile, Scene, Unreadable
from satcheck.scene.errors import Refused
from satcheck.scene.issue import CODES, Code, Issue
from satcheck.scene.loader import load_scene
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.rules import Rule, Selector

__all__ = [
    "CODES",
    "Body",
    "Code",
    "Issue",
    "MeshFile",
    "MeshFiles",
    "MeshHealth",
    "Refused",
    "Rule",
    "Scene",
    "Selector",
    "Unreadable",
    "load_scene",
]
