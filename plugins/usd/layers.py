"""Layers of a stage that state another unit or up axis than its root. USD does not convert them.

Where the prim that brings in the layer scales and turns it, as programs do that resolve units, all
is well. Else its bodies are too large, too small, or lie on their side. A layer that states nothing
may be meant in the units of the stage: it is named.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from msgspec import Struct
from pxr import Usd, UsdGeom

from satcheck.plugins.usd.stage import Remarks
from satcheck.plugins.usd.unknown import holds_geometry

_SAME = 1e-4  # a share: programs write few digits of a scale
_UP = {"Y": 1, "Z": 2}


class Metrics(Struct, frozen=True):
    """metres of a unit, and the up axis; None: a layer states none."""

    metres: float | None
    up: str | None


def look_at_layers(stage: Any, said: Remarks) -> None:
    """Names the layers with geometry that USD places in wrong units or axes, and those that state
    none, where the stage has others than the default."""
    own = frozenset(stage.GetLayerStack(False))
    stated = {
        layer: _stated(layer)
        for layer in stage.GetUsedLayers()
        if layer != stage.GetRootLayer() and any(map(holds_geometry, layer.rootPrims))
    }
    root = _of_root(stage, stated.values())
    default = Metrics(UsdGeom.LinearUnits.centimeters, str(UsdGeom.GetFallbackUpAxis()))
    places = UsdGeom.XformCache(Usd.TimeCode.EarliestTime())
    for layer, each in stated.items():
        name, words = f"layer {layer.GetDisplayName()}", _words(each, root)
        if words and (
            layer in own
            or not all(
                _is_resolved(places.GetLocalToWorldTransform(prim), each, root)
                for prim in _tops(stage, layer)
            )
        ):
            said.add("unread", f"{' and '.join(words)}; USD does not convert it", name)
            continue
        missing = ["metersPerUnit"] if each.metres is None and _ratio(default, root) else []
        missing += ["upAxis"] if each.up is None and root.up != default.up else []
        if missing:
            what = " and ".join(missing)
            said.add("assumed-units", f"it states no {what}: that of the stage counts", name)


def _stated(layer: Any) -> Metrics:
    root = layer.pseudoRoot
    metres = root.GetInfo("metersPerUnit") if root.HasInfo("metersPerUnit") else None
    return Metrics(metres, str(root.GetInfo("upAxis")) if root.HasInfo("upAxis") else None)


def _of_root(stage: Any, others: Any) -> Metrics:
    """What the root states. If it states none, what all others state alike, else the default."""
    own = _stated(stage.GetRootLayer())
    metres = own.metres or _only(each.metres for each in others)
    up = own.up or _only(each.up for each in others)
    return Metrics(
        metres or UsdGeom.GetStageMetersPerUnit(stage), up or str(UsdGeom.GetStageUpAxis(stage))
    )


def _only(values: Any) -> Any:
    """The one value among these; None: there are none, or others."""
    known = {value for value in values if value is not None}
    return known.pop() if len(known) == 1 else None


def _ratio(each: Metrics, root: Metrics) -> float | None:
    """How much larger the unit of the layer is; None: it is the same."""
    if each.metres is None or not root.metres:
        return None
    ratio = float(each.metres / root.metres)
    return None if abs(ratio - 1) <= _SAME else ratio


def _tops(stage: Any, layer: Any) -> Iterator[Any]:
    """The prims with an opinion of the layer whose parents have none."""

    def has(prim: Any) -> bool:
        return any(spec.layer == layer for spec in prim.GetPrimStack())

    for prim in stage.Traverse(Usd.TraverseInstanceProxies()):
        if has(prim) and not has(prim.GetParent()):
            yield prim


def _is_resolved(matrix: Any, each: Metrics, root: Metrics) -> bool:
    """Whether the placement has the scale and the turn between the units and axes."""
    rows = np.array(matrix)[:3, :3]
    scales = np.linalg.norm(rows, axis=1)
    if not np.allclose(scales, _ratio(each, root) or scales, rtol=_SAME, atol=0):
        return False
    if each.up is None or each.up == root.up:
        return True
    axis = _UP.get(each.up, 0)
    turned = rows[axis] / (scales[axis] or 1)
    return bool(np.allclose(turned, np.eye(3)[_UP.get(root.up or "Y", 1)], rtol=0, atol=_SAME))


def _words(each: Metrics, root: Metrics) -> list[str]:
    """How the layer differs from the stage."""
    words = []
    if _ratio(each, root) is not None:
        words.append(f"metersPerUnit {each.metres:g}, the stage {root.metres:g}")
    if each.up is not None and each.up != root.up:
        words.append(f"upAxis {each.up}, the stage {root.up}")
    return words
