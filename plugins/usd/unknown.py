"""Looks for what the prims of a stage hold that nobody reads: names that no schema has, values that
are none, ops that are not there."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from functools import cache
from typing import Any

from pxr import Sdf, Usd, UsdGeom, UsdShade

from satcheck.plugins.usd import names
from satcheck.plugins.usd.choice import Choice
from satcheck.plugins.usd.remarks import Remarks
from satcheck.plugins.usd.walk import type_of
from satcheck.scene.vocabulary import Names

# What is below these shapes no body.
_OF_LOOKS = frozenset(("Material", "Shader", "NodeGraph", "Camera"))
_ORDER = UsdGeom.Tokens.xformOpOrder
_RESET, _INVERSE, _OP = "!resetXformStack!", "!invert!", "xformOp:"
# Tokens that place, hide or shape a body.
_TOKENS = names.named(
    "visibility purpose orientation subdivisionScheme axis physics:approximation physics:axis"
)
_NOT_READ = "is not read; it may hold or move a body"
_OF_GEOMETRY = names.named(
    "points faceVertexCounts size radius height width length xformOpOrder positions protoIndices"
)


def look_at_stage(stage: Any, choice: Choice, said: Remarks) -> None:
    """Says what the stage holds that is not read. Raises SatcheckError for names that are
    misspelt."""
    look = _Look(choice, said)
    look.at_layer(stage)
    prims = iter(Usd.PrimRange.AllPrims(stage.GetPseudoRoot()))
    for prim in prims:
        if prim.IsPseudoRoot():
            continue
        if type_of(prim) == "Material" and prim.IsActive():
            look.at_material(prim)
        if not prim.IsActive() or prim.IsAbstract() or type_of(prim) in _OF_LOOKS:
            prims.PruneChildren()
        else:
            look.at(prim)
    for prototype in stage.GetPrototypes():
        for prim in Usd.PrimRange.AllPrims(prototype):
            if prim != prototype:
                look.at(prim)


class _Look:
    def __init__(self, choice: Choice, said: Remarks) -> None:
        self._choice = choice
        self._said = said
        self._physics = names.of_physics()

    def at_layer(self, stage: Any) -> None:
        names.LAYER.refuse_misspelt(_unregistered(stage.GetPseudoRoot()), "the root layer")

    def at(self, prim: Any) -> None:
        path = str(prim.GetPath())
        names.PRIM.refuse_misspelt(_unregistered(prim), path)
        self._unread(names.APIS, self._unknown_apis(prim), path, prim)
        self._at_properties(prim, path)
        self._at_tokens(prim, path)
        self._at_ops(prim, path)
        self._at_cards(prim, path)
        self._at_variants(prim, path)
        if self._choice.collides(prim):
            self._at_collider(prim, path)

    def at_material(self, prim: Any) -> None:
        """A preview surface may displace the surface. Connections for single renderers are written
        by habit, and say nothing."""
        if self._choice.colliders:
            return
        source, _, _ = UsdShade.Material(prim).ComputeDisplacementSource()
        shader = UsdShade.Shader(source.GetPrim()) if source else None
        given = shader.GetInput("displacement") if shader else None
        if given and (given.HasConnectedSource() or given.Get(self._choice.time)):
            words = "the material displaces surfaces; they are checked without"
            self._said.add("unread", words, str(prim.GetPath()))

    def _unread(self, known: Names, found: Iterable[str], path: str, prim: Any) -> None:
        """Says which of these names nobody knows. Raises SatcheckError for one that is misspelt."""
        for name in found:
            if list(known.unread([name], path)) and prim.IsA(UsdGeom.Imageable):
                self._said.add("unread", f"{name} {_NOT_READ}", path)

    def _unknown_apis(self, prim: Any) -> Iterator[str]:
        registry = Usd.SchemaRegistry
        for name in prim.GetPrimTypeInfo().GetAppliedAPISchemas():
            kind = registry.GetTypeNameAndInstance(name)[0]
            if registry().FindAppliedAPIPrimDefinition(kind) is None:
                yield kind

    def _at_properties(self, prim: Any, path: str) -> None:
        authored = prim.GetAuthoredPropertyNames()
        known = frozenset(prim.GetPrimDefinition().GetPropertyNames())
        plain, physics, primvars = [], [], []
        for name in authored:
            space, _, rest = name.partition(":")
            if name in known:
                continue
            if not rest:
                plain.append(name)
            elif space == "physics":
                physics.append(rest)
            elif space == "primvars":
                primvars.append(rest)
        if plain:
            own = _names_of(known)
            custom = {name for name in plain if prim.GetProperty(name).IsCustom()}
            own.refuse_misspelt(plain, path)
            if prim.IsA(UsdGeom.Gprim) or prim.IsA(UsdGeom.PointInstancer):
                self._unread(own, [name for name in plain if name not in custom], path, prim)
            elif prim.IsA(UsdGeom.Imageable):
                for name in _OF_GEOMETRY.intersection(plain):
                    kind = prim.GetTypeName()
                    self._said.add("unread", f"{name}: a prim of the type {kind} has none", path)
        self._physics.refuse_misspelt(physics, path)
        if prim.IsA(UsdGeom.Gprim):
            names.PRIMVARS.refuse_misspelt(primvars, path)

    def _at_tokens(self, prim: Any, path: str) -> None:
        definition = prim.GetPrimDefinition()
        for name in _TOKENS:
            attribute = prim.GetAttribute(name)
            if not attribute or not attribute.HasAuthoredValue():
                continue
            allowed = definition.GetPropertyMetadata(name, "allowedTokens")
            value = attribute.Get(self._choice.time)
            if allowed and value is not None and value not in allowed:
                words = f"{name} is {value!r}, not one of {', '.join(allowed)}"
                self._said.add("unread", words, path)

    def _at_ops(self, prim: Any, path: str) -> None:
        attribute = prim.GetAttribute(_ORDER)
        order = attribute.Get() if attribute else None
        if not order:
            return
        if not prim.IsA(UsdGeom.Xformable):
            if _has_geometry_below(prim):
                kind = prim.GetTypeName() or "no type"
                words = f"a prim of {kind} is not moved by its ops; it may be meant to be an Xform"
                self._said.add("unread", words, path)
            return
        present = frozenset(
            name for name in prim.GetAuthoredPropertyNames() if name.startswith(_OP)
        )
        place = f"{path}: {_ORDER}"
        for op in dict.fromkeys(str(each) for each in order):
            name = op.removeprefix(_INVERSE)
            if op == _RESET:
                continue
            if not name.startswith(_OP):
                self._unread(Names(frozenset((_RESET, *present))), [name], place, prim)
            elif name not in present and not prim.HasAttribute(name):
                self._unread(Names(present - set(map(str, order))), [name], place, prim)
            else:
                self._at_op(prim.GetAttribute(name), name, place, prim)

    def _at_op(self, attribute: Any, name: str, place: str, prim: Any) -> None:
        self._unread(names.OPS, [name.split(":")[1]], place, prim)
        if not attribute.HasAuthoredValue():
            self._said.add("unread", f"the op {name} has no value", str(prim.GetPath()))

    def _at_cards(self, prim: Any, path: str) -> None:
        if not prim.HasAPI(UsdGeom.ModelAPI) and not prim.HasAttribute("model:drawMode"):
            return
        mode = UsdGeom.ModelAPI(prim).GetModelDrawModeAttr().Get()
        if mode not in (None, "default", "inherited") and not _has_geometry_below(prim):
            self._said.add("unread", f"it is drawn as its extent ({mode}), which is no body", path)

    def _at_variants(self, prim: Any, path: str) -> None:
        if not prim.HasVariantSets():
            return
        for name in prim.GetVariantSets().GetNames():
            variants = prim.GetVariantSet(name)
            if not variants.GetVariantSelection() and any(
                holds_geometry(spec) for spec in _variants(prim, name)
            ):
                words = f"no variant of the set {name!r} is selected, and they hold bodies"
                self._said.add("unread", words, path)

    def _at_collider(self, prim: Any, path: str) -> None:
        shaped = names.SHAPES_OF_COLLIDERS.intersection(
            prim.GetPrimTypeInfo().GetAppliedAPISchemas()
        )
        if shaped and not prim.GetAttribute("physics:approximation").HasAuthoredValue():
            words = f"{min(shaped)} may shape the collider otherwise; its geometry is checked"
            self._said.add("unread", words, path)
        rest = prim.GetAttribute("physxCollision:restOffset")
        value = rest.Get(self._choice.time) if rest else None
        if isinstance(value, float) and value != 0 and math.isfinite(value):
            self._said.add("unread", f"its restOffset of {value:g} is not applied", path)


def _unregistered(prim: Any) -> list[str]:
    """The fields of the prim that no schema and no plugin defines."""
    return [
        name
        for name, value in prim.GetAllAuthoredMetadata().items()
        if isinstance(value, Sdf.UnregisteredValue)
    ]


@cache
def _names_of(known: frozenset[str]) -> Names:
    return names.of_type(known)


def _has_geometry_below(prim: Any) -> bool:
    below = Usd.PrimRange(prim, Usd.TraverseInstanceProxies())
    return any(each.IsA(UsdGeom.Gprim) or each.IsA(UsdGeom.PointInstancer) for each in below)


def _variants(prim: Any, name: str) -> Iterator[Any]:
    """The specs of the variants of a set."""
    for spec in prim.GetPrimStack():
        if name in spec.variantSets:
            for variant in spec.variantSets[name].variants:
                yield variant.primSpec


def holds_geometry(spec: Any) -> bool:
    """Whether a prim spec, or one below it, may make or move a body."""
    if spec.typeName in _OF_LOOKS:
        return False
    if spec.hasReferences or spec.hasPayloads or spec.hasInheritPaths:
        return True
    if any(each.name in _OF_GEOMETRY for each in spec.properties):
        return True
    return any(holds_geometry(child) for child in spec.nameChildren)
