"""Which prims are bodies: drawn geometry, or the colliders of a simulation."""

from __future__ import annotations

from typing import Any

from pxr import Usd, UsdGeom, UsdPhysics

from satcheck.plugins.usd.walk import PlacedPrim
from satcheck.scene.read_options import ReadOptions


class Choice:
    """time: the Usd.TimeCode of all values. purposes: that are drawn. colliders: these are the
    bodies, drawn or not."""

    def __init__(self, options: ReadOptions) -> None:
        self.time = (
            Usd.TimeCode.EarliestTime() if options.time is None else Usd.TimeCode(options.time)
        )
        self.purposes = frozenset(("default", *(options.purpose or ("render",))))
        self.colliders = options.geometry == "collision"
        self._hidden: dict[tuple[Any, Any], bool] = {}

    def why_not(self, placed: PlacedPrim, *, lost: bool) -> str | None:
        """Why this prim is no body, for `Remarks`; None: it is one. lost: something in it or below
        is not known."""
        if self.colliders:
            known = not lost and not self.collides(placed.prim)
            return "no enabled collider" if known else None
        if self._is_hidden(placed):
            return "invisible"
        purpose = _purpose(placed)
        return None if purpose in self.purposes else f"of purpose {purpose} (--purpose)"

    def collides(self, prim: Any) -> bool:
        """Whether colliders are checked, and the prim is an enabled one."""
        if not self.colliders or not prim.HasAPI(UsdPhysics.CollisionAPI):
            return False
        return bool(UsdPhysics.CollisionAPI(prim).GetCollisionEnabledAttr().Get(self.time))

    def _is_hidden(self, placed: PlacedPrim) -> bool:
        around = placed.frame.around(placed.prim)
        return any(self._hidden_below(prim, frame.root) for prim, frame in around)

    def _hidden_below(self, prim: Any, root: Any) -> bool:
        """Whether the prim or one above it, up to the root, is invisible."""
        if not prim or prim.IsPseudoRoot():
            return False
        key = prim.GetPath(), root and root.GetPath()
        if key not in self._hidden:
            imageable = UsdGeom.Imageable(prim)
            own = bool(imageable) and (
                imageable.GetVisibilityAttr().Get(self.time) == UsdGeom.Tokens.invisible
            )
            above = prim != root and self._hidden_below(prim.GetParent(), root)
            self._hidden[key] = own or above
        return self._hidden[key]


def _purpose(placed: PlacedPrim) -> str:
    """The purpose of the prim; else that of the nearest point instancer around it that has one."""
    for prim, _ in placed.frame.around(placed.prim):
        purpose = str(UsdGeom.Imageable(prim).ComputePurpose())
        if purpose != UsdGeom.Tokens.default_:
            break
    return purpose
