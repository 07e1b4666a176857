"""Collision checker for meshes: relation, penetration depth and the shortest way out, with proofs.

`check` takes files, `check_meshes` two meshes in memory, which `Mesh` prepares for many checks.
`satcheck.core` has the convex shapes.
Names are imported when they are first used, so that `import satcheck` alone costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck._version import __version__

if TYPE_CHECKING:
    from satcheck.audit import Finding, Report, Settings
    from satcheck.audit.check import check
    from satcheck.audit.meshes import check_meshes
    from satcheck.core.errors import SatcheckError
    from satcheck.scene import load_scene
    from satcheck.scene.meshes import Mesh, scene_of_meshes

__all__ = [
    "Finding",
    "Mesh",
    "Report",
    "SatcheckError",
    "Settings",
    "__version__",
    "check",
    "check_meshes",
    "load_scene",
    "scene_of_meshes",
]

_MODULES = {
    "Finding": "satcheck.audit",
    "Mesh": "satcheck.scene.meshes",
    "Report": "satcheck.audit",
    "SatcheckError": "satcheck.core.errors",
    "Settings": "satcheck.audit",
    "check": "satcheck.audit.check",
    "check_meshes": "satcheck.audit.meshes",
    "load_scene": "satcheck.scene",
    "scene_of_meshes": "satcheck.scene.meshes",
}


def __getattr__(name: str) -> object:
    from importlib import import_module

    if name == "core":
        return import_module("satcheck.core")
    if name not in _MODULES:
        raise AttributeError(f"module 'satcheck' has no attribute {name!r}")
    value = getattr(import_module(_MODULES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, "core"])
