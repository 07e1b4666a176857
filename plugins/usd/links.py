"""Colliders of links that no joint connects, and that overlap: what the requirement BA.002 of
SimReady forbids. The stage is read as it is open, with what is not saved."""

from __future__ import annotations

from typing import Any

from msgspec.structs import replace
from pxr import Sdf, UsdPhysics

from satcheck.audit.check import check
from satcheck.cli.formats.ci.problems import Problem, problems
from satcheck.plugins.usd.reading import Reading
from satcheck.plugins.usd.stage import stage_of
from satcheck.scene.document import Document, RawRule, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.loader import scene_of_document
from satcheck.scene.opening import File

_OPTIONS = {"time": None, "purpose": None, "geometry": "collision"}


def link_problems(stage: Any) -> list[Problem]:
    """Return the overlaps of links, and what could not be decided, which `stops` a pass.

    stage: a Usd.Stage, which stays as it is. Links are the rigid bodies below its default prim.
    Those that a joint connects may overlap, and so may pairs that a simulator does not collide.
    Raises Refused, or an error of the library, if the stage or all of its colliders are unreadable.
    """
    try:
        document = Reading(stage_of(stage), _OPTIONS).scene()
    except Refused as error:
        has_collider = any(prim.HasAPI(UsdPhysics.CollisionAPI) for prim in stage.TraverseAll())
        if has_collider and error.code not in ("no-body", "empty-mesh"):
            raise
        return []
    document = _of_links(document, stage.GetDefaultPrim())
    if not document.items:
        return []
    name = stage.GetRootLayer().GetDisplayName()
    scene = scene_of_document(document, File("usd", "", name, b"", path=name))
    found = problems({name: check(scene, least=1)})
    return [each for each in found if each.level == "error" or each.stops]


def _of_links(document: Document, top: Any) -> Document:
    """Return the document without bodies that are in no link, or not below the prim `top`, if there
    is one. What is not read may be in any link. Rules say which links a joint connects."""
    items = tuple(
        replace(item, groups=(*item.groups, f"link {item.link}"))
        for item in document.items
        if (item.link or isinstance(document.parts[item.number].mesh, Refusal))
        and (not top or Sdf.Path(prim_of(item.path or "")).HasPrefix(top.GetPath()))
    )
    rules = (
        RawRule(f"link {joint.parent}", f"link {joint.child}", joint.name, of_groups=True)
        for joint in document.joints
    )
    return replace(document, items=items, pairs=(*document.pairs, *rules))


def prim_of(body: str) -> str:
    """Return the path of the prim of a body; of an instance, that of its point instancer."""
    return body.partition("[")[0]
