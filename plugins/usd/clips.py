"""Value clips: files that give the prims below a prim their values over time.

USD says nothing of clips that it does not apply, and the bodies then stand where they would
without.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pxr import Sdf, Usd

from satcheck.plugins.usd import names
from satcheck.plugins.usd.walk import has_geometry_below

# One of these, with primPath, is what a set needs to count.
_WHOLE = (
    names.named("assetPaths active"),
    names.named("templateAssetPath templateStride templateStartTime templateEndTime"),
)
_FIRST = Usd.TimeCode.EarliestTime()


def why_not_applied(prim: Any) -> Iterator[str]:
    """Why clips of a prim with geometry below are not applied, though they are meant to move, hide
    or shape it."""
    api, sets = Usd.ClipsAPI(prim), prim.GetMetadata("clips") or {}
    counted = sorted(sets)
    for spec in reversed(prim.GetPrimStack()):  # ClipsAPI.GetClipSets ends the process
        if spec.HasInfo("clipSets"):
            counted = spec.GetInfo("clipSets").ApplyOperations(counted)
    for name in counted:
        if name not in sets:
            yield f"clipSets names {name!r}, which clips do not define"
    for name in sorted(set(counted) & sets.keys()):
        reason = _why_not(prim, api, name, sets[name])
        if reason is not None:
            yield f"value clips {name!r}: {reason}: not applied"


def _why_not(prim: Any, api: Any, name: str, clips: Any) -> str | None:
    if not isinstance(clips, dict):
        return "no dictionary"
    if not all(clips[each] for each in ("assetPaths", "active") if each in clips):
        return None  # they are switched off
    if "primPath" not in clips or not any(each <= clips.keys() for each in _WHOLE):
        return "they lack primPath, or assetPaths and active"
    paths = api.ComputeClipAssetPaths(name)
    if not paths:
        return f"there is no file {clips.get('templateAssetPath', '')} at its times"
    numbers = [int(number) for _, number in sorted(map(tuple, api.GetClipActive(name) or ()))]
    first = numbers[0] if numbers and 0 <= numbers[0] < len(paths) else 0
    path = paths[first]  # the clip of the first times
    if not path.resolvedPath:
        return None  # the body is lost
    layer, root = Sdf.Layer.FindOrOpen(path.resolvedPath), str(clips["primPath"])
    spec = layer.GetPrimAtPath(root) if Sdf.Path.IsValidPathString(root) else None
    if spec is None:
        return f"{path.path} has no prim {root}"
    places, stage = list(_given(prim, layer, spec.path)), prim.GetStage()
    there = [place for place in places if stage.GetPrimAtPath(place.GetPrimPath())]
    if places and not there:
        return f"no prim is at {places[0]}"
    for attribute in filter(None, map(stage.GetAttributeAtPath, there)):
        used = any(spec.layer == layer for spec in attribute.GetPropertyStack(_FIRST))
        if not used and has_geometry_below(attribute.GetPrim()):
            return f"{attribute.GetPath()} does not come from {path.path}"
    return None


def _given(prim: Any, layer: Any, root: Any) -> Iterator[Any]:
    """Where the attributes belong that the layer has values for."""
    paths: list[Any] = []
    layer.Traverse(root, paths.append)
    for path in paths:
        shapes = path.name in names.SHAPING or path.name.startswith(names.OP)
        if path.IsPropertyPath() and shapes and layer.GetNumTimeSamplesForPath(path):
            yield path.ReplacePrefix(root, prim.GetPath())
