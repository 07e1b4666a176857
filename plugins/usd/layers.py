"""Layers of a stage that state another unit or up axis than its root. USD does not convert them.

Where the prim that brings in the layer scales and turns it, as programs do that resolve units, all
is well. Else its bodies are too large, too small, or lie on their side.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from msgspec import Struct
from pxr import Usd, UsdGeom

from satcheck.plugins.usd.remarks import Remarks
from satcheck.plugins.usd.unknown import holds_geometry

_SAME = 1e-4  # a share: programs write few digits of a scale
_UP = {"Y": 1, "Z": 2}
_METRES = UsdGeom.LinearUnits.centimeters  # where no layer states a unit


class Stated(Struct, frozen=True):
    """metres, up: of a layer; None: it states none."""

    metres: float | None
    up: str | None

    @classmethod
    def of(cls, layer: Any) -> Stated:
        root = layer.pseudoRoot
        metres = root.GetInfo("metersPerUnit") if root.HasInfo("metersPerUnit") else None
        up = str(root.GetInfo("upAxis")) if root.HasInfo("upAxis") else None
        return cls(metres, up)

    def missing(self, root: Stated) -> str:
        """What it does not state although the root has another one than the default."""
        default = Stated(_METRES, str(UsdGeom.GetFallbackUpAxis()))
        words = ["metersPerUnit"] if self.metres is None and _ratio(default, root) else []
        words += ["upAxis"] if self.up is None and root.up != default.up else []
        return " and ".join(words)


def look_at_layers(stage: Any, said: Remarks) -> None:
    """Names the layers with geometry that USD places in wrong units or axes, and those that state
    none, where the stage has others than the default."""
    own = frozenset(stage.GetLayerStack(False))
    stated = {
        layer: Stated.of(layer)
        for layer in stage.GetUsedLayers()
        if layer != stage.GetRootLayer() and any(map(holds_geometry, layer.rootPrims))
    }
    root = _of_root(stage, stated.values())
    places = UsdGeom.XformCache(Usd.TimeCode.EarliestTime())
    for layer, each in stated.items():
        name = f"layer {layer.GetDisplayName()}"
        if _differs(each, root) and (
            layer in own
            or not all(
                _is_resolved(places.GetLocalToWorldTransform(prim), each, root)
                for prim in _tops(stage, layer)
            )
        ):
            said.add("unread", f"{_words(each, root)}; USD does not convert it", name)
        elif missing := each.missing(root):
            said.add("assumed-units", f"it states no {missing}: that of the stage counts", name)


def _of_root(stage: Any, others: Any) -> Stated:
    """What the root states. If it states none, what all others state alike, else the default."""
    root = Stated.of(stage.GetRootLayer())
    metres, up = root.metres, root.up
    if metres is None:
        known = {each.metres for each in others if each.metres is not None}
        metres = known.pop() if len(known) == 1 else UsdGeom.GetStageMetersPerUnit(stage)
    if up is None:
        axes = {each.up for each in others if each.up is not None}
        up = axes.pop() if len(axes) == 1 else str(UsdGeom.GetStageUpAxis(stage))
    return Stated(metres, up)


def _differs(each: Stated, root: Stated) -> bool:
    return _ratio(each, root) is not None or (each.up is not None and each.up != root.up)


def _ratio(each: Stated, root: Stated) -> float | None:
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


def _is_resolved(matrix: Any, each: Stated, root: Stated) -> bool:
    """Whether the placement has the scale and the turn between the units and axes."""
    rows = np.array(matrix)[:3, :3]
    ratio = _ratio(each, root)
    scales = np.linalg.norm(rows, axis=1)
    if ratio is not None and not np.allclose(scales, ratio, rtol=_SAME, atol=0):
        return False
    if each.up is None or each.up == root.up:
        return True
    up = rows[_UP.get(each.up, 0)] / (scales[_UP.get(each.up, 0)] or 1)
    return bool(np.allclose(up, np.eye(3)[_UP.get(root.up or "Y", 1)], rtol=0, atol=_SAME))


def _words(each: Stated, root: Stated) -> str:
    words = []
    if _ratio(each, root) is not None:
        words.append(f"metersPerUnit {each.metres:g}, the stage {root.metres:g}")
    if each.up is not None and each.up != root.up:
        words.append(f"upAxis {each.up}, the stage {root.up}")
    return " and ".join(words)
