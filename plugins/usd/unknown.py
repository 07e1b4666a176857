"""Looks for what the prims of a stage hold that nobody reads: names that no schema has, values that
are none, ops that are not there."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import Any

from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, UsdSkel

from satcheck.plugins.usd import names
from satcheck.plugins.usd.choice import Choice
from satcheck.plugins.usd.clips import why_not_applied
from satcheck.plugins.usd.stage import Remarks
from satcheck.plugins.usd.walk import has_geometry_below, type_of
from satcheck.scene.vocabulary import Names

_ORDER = UsdGeom.Tokens.xformOpOrder
_RESET, _INVERSE = "!resetXformStack!", "!invert!"
# Tokens that place, hide or shape a body.
_TOKENS = names.named(
    """visibility purpose orientation subdivisionScheme axis physics:approximation physics:axis
    collection:colliders:expansionRule"""
)
_JOINTS = UsdSkel.Tokens.primvarsSkelJointIndices
_BOUND = {
    "skeleton": UsdSkel.Skeleton,
    "animationSource": UsdSkel.Animation,
    "blendShapeTargets": UsdSkel.BlendShape,
}
_MOVES = ("translations", "rotations", "scales")
# Relationships that exempt pairs.
_EXEMPT = (
    "physics:filteredPairs",
    "physics:filteredGroups",
    "collection:colliders:includes",
    "collection:colliders:excludes",
)
_NOT_READ = "is not read; it may hold or move a body"
_OF_GEOMETRY = names.named(
    "points faceVertexCounts size radius height width length xformOpOrder positions protoIndices"
)


def look_at_stage(stage: Any, choice: Choice, said: Remarks) -> None:
    """Says what the stage holds that is not read. Raises SatcheckError for names that are
    misspelt."""
    for layer in stage.GetUsedLayers():
        alone = Usd.Stage.OpenMasked(layer, Usd.StagePopulationMask())
        root = layer == stage.GetRootLayer()
        place = "the root layer" if root else f"layer {layer.GetDisplayName()}"
        names.LAYER.refuse_misspelt(_unregistered(alone.GetPseudoRoot()), place)
    for layer in stage.GetLayerStack():
        for source, target in layer.relocates:
            if target and not stage.GetPrimAtPath(target):
                said.add("unread", f"relocates takes it to {target}, where no prim is", str(source))
    look = _Look(choice, said)
    for top in (stage.GetPseudoRoot(), *stage.GetPrototypes()):
        prims = iter(Usd.PrimRange.AllPrims(top))
        for prim in prims:
            if prim.IsAbstract() or not prim.IsActive():
                prims.PruneChildren()
            if prim != top and not prim.IsAbstract():
                look.at(prim)
    look.at_not_drawn()


class _Look:
    def __init__(self, choice: Choice, said: Remarks) -> None:
        self._choice = choice
        self._said = said
        self._overs: list[Any] = []
        self._below: list[Any] = []  # prims in point instancers
        self._prototypes: list[Any] = []  # paths

    def at(self, prim: Any) -> None:
        path, kind = str(prim.GetPath()), type_of(prim)
        if not prim.IsActive():
            if any(map(holds_geometry, prim.GetPrimStack())):
                self._said.add("not-a-body", "inactive", path)
            return
        if not prim.IsDefined() and prim.GetParent().IsDefined():
            self._overs.append(prim)
        names.PRIM.refuse_misspelt(_unregistered(prim), path)
        self._at_variants(prim, path)
        if kind == "Material":
            self._at_material(prim)
        if kind in names.LOOKS and not has_geometry_below(prim):
            return
        if kind == "PointInstancer":
            self._at_instancer(prim, path)
        elif not prim.IsA(UsdGeom.Gprim):
            weaker = [spec.typeName for spec in prim.GetPrimStack()]
            for name in sorted(names.GEOMETRY.intersection(weaker) if kind else ()):
                words = f"a stronger opinion makes a {kind} of this {name}"
                self._said.add("unread", words, path)
        if not has_geometry_below(prim):
            self._at_missing(prim, path)
        self._at_clips(prim, path)
        self._at_instance(prim, path)
        self._unread(names.APIS, self._unknown_apis(prim), path, prim)
        self._at_properties(prim, path)
        self._at_tokens(prim, path)
        self._at_ops(prim, path)
        self._at_cards(prim, path)
        self._at_skeleton(prim, path)
        self._at_exempt(prim, path)
        if self._choice.collides(prim):
            self._at_collider(prim, path)
        elif self._choice.colliders:
            self._at_no_collider(prim, path)

    def _at_instancer(self, prim: Any, path: str) -> None:
        instancer, time = UsdGeom.PointInstancer(prim), self._choice.time
        self._prototypes += instancer.GetPrototypesRel().GetTargets()
        self._below += prim.GetAllChildren()
        count = len(instancer.GetProtoIndicesAttr().Get(time) or ())
        known = instancer.GetIdsAttr().Get(time) or range(count)
        for number in set(instancer.GetInvisibleIdsAttr().Get(time) or ()).difference(known):
            words = f"invisibleIds has {number}, which is the id of no instance"
            self._said.add("left-out", words, path)

    def _at_missing(self, prim: Any, path: str) -> None:
        """USD says nothing of a class that is not there."""
        bases = prim.GetMetadata("specializes")
        others = [*prim.GetInherits().GetAllDirectInherits()]
        others += bases.GetAddedOrExplicitItems() if bases and prim.IsA(UsdGeom.Imageable) else []
        for other in others:
            if not prim.GetStage().GetPrimAtPath(other):
                words = f"it is like {other}, which is no prim: its geometry may be missing"
                self._said.add("left-out", words, path)

    def _at_clips(self, prim: Any, path: str) -> None:
        for clips in (prim.GetMetadata("clips") or {}).values():
            names.CLIPS.refuse_misspelt(clips, f"{path}: clips")
        if has_geometry_below(prim):
            for words in why_not_applied(prim):
                self._said.add("unread", words, path)

    def _at_instance(self, prim: Any, path: str) -> None:
        """At the opinions of prims below an instance that its prototype does not have."""
        if not prim.IsInstance():
            return
        for child in [child for spec in prim.GetPrimStack() for child in spec.nameChildren]:
            shared = prim.GetPrototype().GetChild(child.name)
            if not (shared and child in shared.GetPrimStack()) and _shapes(child):
                words = "an override below an instance, which USD does not apply"
                self._said.add("left-out", words, f"{path}/{child.name}")

    def at_not_drawn(self) -> None:
        """Name the prims that are only changed, and defined nowhere, and those in a point instancer
        that are no prototypes."""
        for words, prims in (
            ("an over that no prim defines", self._overs),
            ("in a point instancer, and no prototype", self._below),
        ):
            for prim in prims:
                is_placed = any(path.HasPrefix(prim.GetPath()) for path in self._prototypes)
                if not is_placed and any(map(holds_geometry, prim.GetPrimStack())):
                    self._said.add("not-a-body", words, str(prim.GetPath()))

    def _at_material(self, prim: Any) -> None:
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
        takes_space = prim.IsA(UsdGeom.Imageable) or not prim.GetTypeName()
        for name in found:
            if list(known.unread([name], path)) and takes_space:
                self._said.add("unread", f"{name} {_NOT_READ}", path)

    def _unknown_apis(self, prim: Any) -> Iterator[str]:
        registry = Usd.SchemaRegistry
        for name in _apis(prim):
            kind, instance = registry.GetTypeNameAndInstance(name)
            if registry().FindAppliedAPIPrimDefinition(kind) is None:
                yield kind
            elif instance and not registry().IsMultipleApplyAPISchema(kind):
                yield name

    def _at_properties(self, prim: Any, path: str) -> None:
        known = frozenset(prim.GetPrimDefinition().GetPropertyNames())
        unknown = defaultdict(list)
        spaces = names.of_spaces()
        for name in prim.GetAuthoredPropertyNames():
            space, _, rest = name.partition(":")
            if name not in known:
                unknown[space if rest else ""].append(rest or name)
            is_read = space + ":" == names.OP or (space in spaces and rest in spaces[space].read)
            if is_read or name in names.SHAPING:
                self._at_fields(prim.GetProperty(name), path)
        self._at_plain(prim, path, unknown.pop("", []), known)
        for space, found in unknown.items():
            self._at_space(prim, path, space, found)

    def _at_fields(self, found: Any, path: str) -> None:
        place = f"{path}: {found.GetName()}"
        names.PROPERTY.refuse_misspelt(_unregistered(found), place)
        if isinstance(found, Usd.Attribute) and found.HasAuthoredConnections():
            words = f"{found.GetName()} is connected to another value, which is not read"
            self._said.add("unread", words, path)

    def _at_plain(self, prim: Any, path: str, found: list[str], known: frozenset[str]) -> None:
        """At the properties without a name space that no schema of the prim has."""
        own = names.of_type(known)
        own.refuse_misspelt(found, path)
        if prim.IsA(UsdGeom.Gprim) or prim.IsA(UsdGeom.PointInstancer):
            stated = [name for name in found if not prim.GetProperty(name).IsCustom()]
            self._unread(own, stated, path, prim)
        elif not prim.IsA(UsdGeom.Imageable):
            for name in sorted({"visibility", "purpose"}.intersection(found)):
                if has_geometry_below(prim):
                    words = f"{name}: a prim of no type has none, it hides nothing"
                    self._said.add("left-out", words, path)
        else:
            moves = names.OPS.read if has_geometry_below(prim) else frozenset()
            for name in sorted((_OF_GEOMETRY | moves).intersection(found)):
                words = f"{name}: a prim of the type {prim.GetTypeName()} has none"
                self._said.add("unread", words, path)

    def _at_space(self, prim: Any, path: str, space: str, found: list[str]) -> None:
        """At the properties of a name space that no schema of the prim has."""
        spaces = names.of_spaces()
        if space == "skel" and prim.IsA(UsdGeom.Imageable):
            words = f"skel:{found[0]} is of no concern without SkelBindingAPI"
            self._said.add("unread", words, path)
        if space in spaces and space + ":" != names.OP:
            spaces[space].refuse_misspelt(found, path)
        elif any(
            name.partition(":")[0] in known.read for known in spaces.values() for name in found
        ):
            Names(frozenset(spaces)).refuse_misspelt([space], path)

    def _at_tokens(self, prim: Any, path: str) -> None:
        definition = prim.GetPrimDefinition()
        for name in _TOKENS | names.SWITCHES:
            attribute = prim.GetAttribute(name)
            if not attribute or not attribute.HasAuthoredValue():
                continue
            allowed = definition.GetPropertyMetadata(name, "allowedTokens")
            value = attribute.Get(self._choice.time)
            if allowed and value is not None and value not in allowed:
                words = f"{name} is {value!r}, not one of {', '.join(allowed)}"
                self._said.add("unread", words, path)
            if name in names.SWITCHES and not isinstance(value, int):
                self._said.add("unread", f"{name} is {value!r}, no true or false", path)

    def _at_ops(self, prim: Any, path: str) -> None:
        attribute = prim.GetAttribute(_ORDER)
        present = frozenset(
            name for name in prim.GetAuthoredPropertyNames() if name.startswith(names.OP)
        )
        order = [str(each) for each in (attribute.Get() if attribute else None) or ()]
        if not prim.IsA(UsdGeom.Xformable):
            if (order or present) and has_geometry_below(prim):
                kind = prim.GetTypeName() or "no type"
                words = f"a prim of {kind} is not moved by its ops; it may be meant to be an Xform"
                self._said.add("unread", words, path)
            return
        place = f"{path}: {_ORDER}"
        for op in dict.fromkeys(order):
            name = op.removeprefix(_INVERSE)
            if op == _RESET:
                continue
            if not name.startswith(names.OP):
                self._unread(Names(frozenset((_RESET, *present))), [name], place, prim)
            elif name not in present and not prim.HasAttribute(name):
                self._unread(Names(present - set(order)), [name], place, prim)
            else:
                self._at_op(prim.GetAttribute(name), name, place, prim)
        self._at_idle_ops(prim, path, present.difference(op.removeprefix(_INVERSE) for op in order))

    def _at_idle_ops(self, prim: Any, path: str, idle: Iterable[str]) -> None:
        """At the ops that the order does not list, so that they move nothing."""
        moving = [name for name in sorted(idle) if self._moves(prim.GetAttribute(name))]
        if moving and has_geometry_below(prim):
            words = f"{', '.join(moving)} not in {_ORDER}: not applied"
            self._said.add("left-out", words, path)

    def _moves(self, op: Any) -> bool:
        if op.GetName().split(":")[1] not in names.OPS.read or not op.HasAuthoredValue():
            return False
        matrix = UsdGeom.XformOp(op).GetOpTransform(self._choice.time)
        return bool(matrix != Gf.Matrix4d(1.0))

    def _at_op(self, attribute: Any, name: str, place: str, prim: Any) -> None:
        self._unread(names.OPS, [name.split(":")[1]], place, prim)
        if not attribute.HasAuthoredValue() and has_geometry_below(prim):
            self._said.add("unread", f"the op {name} has no value", str(prim.GetPath()))

    def _at_skeleton(self, prim: Any, path: str) -> None:
        if prim.IsA(UsdSkel.Animation):
            self._at_animation(prim, path)
        if not prim.HasAPI(UsdSkel.BindingAPI):
            return
        stage, binding = prim.GetStage(), UsdSkel.BindingAPI(prim)
        for name, kind in _BOUND.items():
            for target in prim.GetRelationship(f"skel:{name}").GetForwardedTargets():
                other = stage.GetPrimAtPath(target)
                if not (other and other.IsA(kind)):
                    words = f"skel:{name} is {target}, which is no {kind.__name__}"
                    self._said.add("unread", words, path)
        if not prim.IsA(UsdGeom.Gprim) or not prim.GetAttribute(_JOINTS).HasAuthoredValue():
            return
        skeleton = binding.GetInheritedSkeleton()
        if not (prim.IsA(UsdGeom.Mesh) and skeleton and UsdSkel.Root.Find(prim)):
            words = "it is bound to a skeleton, which moves only meshes below a SkelRoot"
            self._said.add("left-out", words, path)
            return
        known = skeleton.GetJointsAttr().Get() or ()
        lost = sorted(set(binding.GetJointsAttr().Get() or ()).difference(known))
        if lost:
            words = f"skel:joints has {lost[0]}, which its skeleton lacks"
            self._said.add("unread", words, path)

    def _at_animation(self, prim: Any, path: str) -> None:
        """UsdSkel leaves out an animation that lacks a part."""
        lacks = [name for name in _MOVES if not prim.GetAttribute(name).HasAuthoredValue()]
        if prim.GetAttribute("joints").HasAuthoredValue() and lacks:
            words = f"the animation has no {' and '.join(lacks)}: not applied"
            self._said.add("unread", words, path)

    def _at_cards(self, prim: Any, path: str) -> None:
        if not prim.HasAPI(UsdGeom.ModelAPI) and not prim.HasAttribute("model:drawMode"):
            return
        mode = UsdGeom.ModelAPI(prim).GetModelDrawModeAttr().Get()
        if mode not in (None, "default", "inherited") and not has_geometry_below(prim):
            self._said.add("unread", f"it is drawn as its extent ({mode}), which is no body", path)

    def _at_variants(self, prim: Any, path: str) -> None:
        declared = prim.GetVariantSets().GetNames()
        written = {name for spec in prim.GetPrimStack() for name in spec.variantSets.keys()}  # noqa: SIM118
        for name in sorted(prim.GetVariantSets().GetAllVariantSelections().keys() - declared):
            if has_geometry_below(prim):
                words = f"it selects a variant of {name!r}, which is no set of variants"
                self._said.add("left-out", words, path)
        for name in sorted(written.union(declared)):
            is_composed = name in declared and prim.GetVariantSet(name).GetVariantSelection()
            if not is_composed and any(
                holds_geometry(spec, type_of(prim)) for spec in _variants(prim, name)
            ):
                words = f"no variant of the set {name!r} is selected, and they hold bodies"
                self._said.add("unread", words, path)

    def _at_exempt(self, prim: Any, path: str) -> None:
        for name in filter(prim.HasRelationship, _EXEMPT):
            for target in prim.GetRelationship(name).GetForwardedTargets():
                if not prim.GetStage().GetPrimAtPath(target):
                    code = "unread" if name.endswith("excludes") else "ignored-opinion"
                    self._said.add(code, f"{name} has {target}, which is no prim", path)
        if prim.HasRelationship(_EXEMPT[0]) and not prim.HasAPI(UsdPhysics.FilteredPairsAPI):
            words = "filteredPairs without PhysicsFilteredPairsAPI exempt nothing"
            self._said.add("ignored-opinion", words, path)
        together = prim.GetAttribute("physxArticulation:enabledSelfCollisions")
        if together and together.Get(self._choice.time) is False:
            words = "enabledSelfCollisions is not applied: bodies of the articulation are checked"
            self._said.add("left-out", words, path)

    def _at_collider(self, prim: Any, path: str) -> None:
        shaped = names.SHAPES_OF_COLLIDERS.intersection(_apis(prim))
        if shaped and not prim.GetAttribute("physics:approximation").HasAuthoredValue():
            words = f"{min(shaped)} may shape the collider otherwise; its geometry is checked"
            self._said.add("unread", words, path)
        approximation = prim.GetAttribute("physics:approximation")
        if approximation and not prim.HasAPI(UsdPhysics.MeshCollisionAPI):
            words = "physics:approximation is of no concern without PhysicsMeshCollisionAPI"
            self._said.add("unread", words, path)
        rest = prim.GetAttribute("physxCollision:restOffset")
        value = rest.Get(self._choice.time) if rest else None
        if isinstance(value, float) and value != 0 and math.isfinite(value):
            self._said.add("unread", f"its restOffset of {value:g} is not applied", path)

    def _at_no_collider(self, prim: Any, path: str) -> None:
        own = names.COLLIDERS_OF_THEIR_OWN.intersection(_apis(prim))
        if own:
            self._said.add("unread", f"{min(own)} makes a collider, which is not read", path)


def _apis(prim: Any) -> Any:
    """The APIs that the prim applies, known to the library or not."""
    return prim.GetPrimTypeInfo().GetAppliedAPISchemas()


def _unregistered(found: Any) -> list[str]:
    """The fields of a prim or property that no schema and no plugin defines."""
    return [
        name
        for name, value in found.GetAllAuthoredMetadata().items()
        if isinstance(value, Sdf.UnregisteredValue)
    ]


def _variants(prim: Any, name: str) -> Iterator[Any]:
    """The specs of the variants of a set."""
    for spec in prim.GetPrimStack():
        if name in spec.variantSets:
            for variant in spec.variantSets[name].variants:
                yield variant.primSpec


def holds_geometry(spec: Any, kind: str = "") -> bool:
    """Whether a prim spec, or one below it, may make or move a body. kind: the type of its prim."""
    if (kind or spec.typeName) not in names.LOOKS:
        if spec.hasReferences or spec.hasPayloads or spec.hasInheritPaths:
            return True
        if spec.typeName in names.GEOMETRY or any(
            each.name in _OF_GEOMETRY or each.name.startswith(names.OP) for each in spec.properties
        ):
            return True
    return any(map(holds_geometry, spec.nameChildren))


def _shapes(spec: Any) -> bool:
    """Whether a prim spec, or one below it, may make, move, hide or shape a body."""
    own = holds_geometry(spec) or spec.HasInfo("active")
    return (
        own
        or any(each.name in names.SHAPING for each in spec.properties)
        or any(map(_shapes, spec.nameChildren))
    )
