"""Which prims are bodies: drawn geometry, or the colliders of a simulation; and which of them
satcheck does not read: with extent, they are bodies that cannot be checked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pxr import Usd, UsdGeom, UsdLux, UsdPhysics, UsdSkel

from satcheck.plugins.usd.names import TYPES
from satcheck.plugins.usd.walk import PlacedPrim, type_of
from satcheck.scene.document import Refusal

_WITH_WIDTHS = frozenset(("BasisCurves", "NurbsCurves", "HermiteCurves", "Points"))
_OF_MESHES = ("points", "faceVertexCounts", "faceVertexIndices")
_OF_SHAPES = (*_OF_MESHES, "size", "radius", "height")
_OF_SKELETONS = (UsdSkel.Root, UsdSkel.Skeleton)
# Properties that only a prim has that takes up space, whatever its type.
_OF_SPACE = ("extent", "points", "xformOpOrder", "visibility", "purpose", "material:binding")


class Choice:
    """time: the Usd.TimeCode of all values. purposes: that are drawn. colliders: these are the
    bodies, drawn or not."""

    def __init__(self, options: Mapping[str, Any]) -> None:
        time = options["time"]
        self.time = Usd.TimeCode.EarliestTime() if time is None else Usd.TimeCode(time)
        self.purposes = frozenset(("default", *(options["purpose"] or ("render",))))
        self.colliders = options["geometry"] == "collision"
        self._hidden: dict[tuple[Any, Any], bool] = {}

    def why_not(self, placed: PlacedPrim, *, lost: bool) -> str | None:
        """Why this prim is no body, for `Remarks`; None: it is one. lost: something in it or below
        is not known."""
        if self.colliders:
            known = not lost and not self.collides(placed.prim)
            return "no enabled collider" if known else None
        around = placed.frame.around(placed.prim)
        if any(self._hidden_below(prim, frame.root) for prim, frame in around):
            return "invisible"
        purpose = _purpose(placed)
        return (
            None if purpose in self.purposes else f"of purpose {purpose} (--read purpose={purpose})"
        )

    def collides(self, prim: Any) -> bool:
        """Whether colliders are checked, and the prim is an enabled one."""
        if not self.colliders or not prim.HasAPI(UsdPhysics.CollisionAPI):
            return False
        return bool(UsdPhysics.CollisionAPI(prim).GetCollisionEnabledAttr().Get(self.time))

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


def without_extent(prim: Any, choice: Choice) -> str | None:
    """Words about drawn geometry that takes up no space: lines, points, a mesh of nothing. None:
    it does."""
    if choice.colliders:
        return None
    kind = type_of(prim)
    if kind in _WITH_WIDTHS and not _has_widths(prim, choice):
        return f"of type {kind} and without widths, it has no surface"
    if kind == "Mesh" and not any(prim.GetAttribute(name).Get(choice.time) for name in _OF_MESHES):
        return "a mesh without points and faces"
    return None


def hidden_geometry(prim: Any, choice: Choice) -> Refusal | None:
    """Why a prim that is no known geometry may hide a body; None: it does not.

    A prim of a type that a plugin defines may if it has a place, an extent or a material. A
    collider without geometry of its own may if the prims below have geometry.
    """
    kind = prim.GetTypeName()
    stated = [name for name in _OF_SHAPES if prim.HasAttribute(name)]
    placed = prim.HasAttribute("xformOpOrder")
    of_shape = (placed and not prim.GetAttribute(name).IsCustom() for name in stated)
    is_shape = any(of_shape) or not set(stated).isdisjoint(_OF_MESHES)
    if is_shape and not kind and not choice.colliders:
        message = f"a prim of no type has {', '.join(stated)}: it may be meant to be a shape"
        return Refusal("unsupported-feature", message)
    if _is_made_elsewhere(prim) and not choice.colliders:
        return Refusal("unsupported-feature", f"geometry of the type {kind} is not read")
    has_points = any(map(prim.HasProperty, ("extent", "points")))
    is_unknown = kind and not type_of(prim) and (has_points or not TYPES.knows(kind))
    is_drawn = not choice.colliders and any(map(prim.HasProperty, _OF_SPACE))
    if is_unknown and (choice.collides(prim) or is_drawn):
        message = f"prims of the type {kind} are not known: convert it to a Mesh"
        return Refusal("unsupported-feature", message)
    if choice.collides(prim) and _has_drawn_below(prim):
        message = f"a collider of type {kind or 'unknown'} that joins what is below is not read"
        return Refusal("unsupported-feature", message)
    return None


def _is_made_elsewhere(prim: Any) -> bool:
    """Whether the prim has an extent, and a renderer makes its geometry."""
    if not prim.IsA(UsdGeom.Boundable) or prim.HasAPI(UsdLux.LightAPI):
        return False
    return not any(map(prim.IsA, (UsdGeom.Gprim, UsdGeom.PointInstancer, *_OF_SKELETONS)))


def _has_drawn_below(prim: Any) -> bool:
    """Geometry that is no collider of its own."""
    below = Usd.PrimRange(prim, Usd.TraverseInstanceProxies())
    return any(
        each.IsA(UsdGeom.Gprim) and not each.HasAPI(UsdPhysics.CollisionAPI) for each in below
    )


def _has_widths(prim: Any, choice: Choice) -> bool:
    inherited = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("widths")
    values = [prim.GetAttribute("widths").Get(choice.time)]
    values.append(inherited.Get(choice.time) if inherited else None)
    return any(width > 0 for widths in values if widths is not None for width in widths)
