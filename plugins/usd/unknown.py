"""Looks for what the prims of a stage hold that nobody reads: names that no schema has, values that
are none, ops that are not there."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import Any

from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade, UsdSkel

from satcheck.plugins.usd import names
from satcheck.plugins.usd.choice import Choice
from satcheck.plugins.usd.clips import why_not_applied
from satcheck.plugins.usd.stage import Remarks
from satcheck.plugins.usd.walk import has_geometry_below, type_of
from satcheck.scene.vocabulary import Names

Found = Iterator[tuple[str, str]]
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
_OF_GEOMETRY = names.named(
    "points faceVertexCounts size radius height width length xformOpOrder positions protoIndices"
)


def look_at_stage(stage: Any, choice: Choice, said: Remarks) -> None:
    """Says what the stage holds that is not read. Raises SatcheckError for names that are
    misspelt."""
    _look_at_layers(stage, said)
    not_drawn: list[tuple[Any, str]] = []
    prototypes: list[Any] = []  # paths
    for prim in _prims(stage):
        path = str(prim.GetPath())
        if not prim.IsActive():
            if _holds_geometry(prim):
                said.add("not-a-body", "inactive", path)
            continue
        if not prim.IsDefined() and prim.GetParent().IsDefined():
            not_drawn.append((prim, "an over that no prim defines"))
        if prim.IsA(UsdGeom.PointInstancer):
            prototypes += UsdGeom.PointInstancer(prim).GetPrototypesRel().GetTargets()
            words = "in a point instancer, and no prototype"
            not_drawn += [(each, words) for each in prim.GetAllChildren() if each.IsActive()]
        for code, words in _Look(prim, choice).words():
            said.add(code, words, path)
    for prim, words in not_drawn:
        is_placed = any(path.HasPrefix(prim.GetPath()) for path in prototypes)
        if not is_placed and _holds_geometry(prim):
            said.add("not-a-body", words, str(prim.GetPath()))


def _look_at_layers(stage: Any, said: Remarks) -> None:
    for layer in stage.GetUsedLayers():
        alone = Usd.Stage.OpenMasked(layer, Usd.StagePopulationMask())
        root = layer == stage.GetRootLayer()
        place = "the root layer" if root else f"layer {layer.GetDisplayName()}"
        names.LAYER.refuse_misspelt(_unregistered(alone.GetPseudoRoot()), place)
    for layer in stage.GetLayerStack():
        for source, target in layer.relocates:
            if target and not stage.GetPrimAtPath(target):
                said.add("unread", f"relocates takes it to {target}, where no prim is", str(source))


def _prims(stage: Any) -> Iterator[Any]:
    """Those that are not abstract, and of what is inactive the outermost."""
    for top in (stage.GetPseudoRoot(), *stage.GetPrototypes()):
        prims = iter(Usd.PrimRange.AllPrims(top))
        for prim in prims:
            if prim.IsAbstract() or not prim.IsActive():
                prims.PruneChildren()
            if prim != top and not prim.IsAbstract():
                yield prim


class _Look:
    """At one prim. What it finds is a code and words, for `Remarks`."""

    def __init__(self, prim: Any, choice: Choice) -> None:
        self._prim = prim
        self._path = str(prim.GetPath())
        self._kind = type_of(prim)
        self._choice = choice
        self._time = choice.time

    def words(self) -> Found:
        prim = self._prim
        names.PRIM.refuse_misspelt(_unregistered(prim), self._path)
        yield from self._of_variants()
        if self._kind == "Material":
            yield from self._of_material()
        if self._kind in names.LOOKS and not self._has_below:
            return
        yield from self._of_type()
        yield from self._of_arcs()
        yield from self._unread(names.APIS, self._unknown_apis(), self._path)
        yield from self._of_properties()
        yield from self._of_tokens()
        yield from self._of_ops()
        yield from self._of_skeleton()
        yield from self._of_exemptions()
        if self._choice.collides(prim):
            yield from self._of_collider()
        elif self._choice.colliders:
            for own in sorted(names.COLLIDERS_OF_THEIR_OWN.intersection(_apis(prim)))[:1]:
                yield "unread", f"{own} makes a collider, which is not read"

    @cached_property
    def _has_below(self) -> bool:
        return has_geometry_below(self._prim)

    def _of_type(self) -> Found:
        prim = self._prim
        if prim.IsA(UsdGeom.PointInstancer):
            instancer = UsdGeom.PointInstancer(prim)
            count = len(instancer.GetProtoIndicesAttr().Get(self._time) or ())
            known = instancer.GetIdsAttr().Get(self._time) or range(count)
            hidden = set(instancer.GetInvisibleIdsAttr().Get(self._time) or ())
            for number in sorted(hidden.difference(known)):
                yield "left-out", f"invisibleIds has {number}, which is the id of no instance"
        elif self._kind and not prim.IsA(UsdGeom.Gprim):
            weaker = [spec.typeName for spec in prim.GetPrimStack()]
            for name in sorted(names.GEOMETRY.intersection(weaker)):
                yield "unread", f"a stronger opinion makes a {self._kind} of this {name}"

    def _of_arcs(self) -> Found:
        prim = self._prim
        if not self._has_below:  # USD says nothing of a class that is not there
            others = [*prim.GetInherits().GetAllDirectInherits()]
            if prim.IsA(UsdGeom.Imageable) and (bases := prim.GetMetadata("specializes")):
                others += bases.GetAddedOrExplicitItems()
            for other in others:
                if not prim.GetStage().GetPrimAtPath(other):
                    words = f"it is like {other}, which is no prim: its geometry may be missing"
                    yield "left-out", words
            if prim.HasAPI(UsdGeom.ModelAPI) or prim.HasAttribute("model:drawMode"):
                mode = UsdGeom.ModelAPI(prim).GetModelDrawModeAttr().Get()
                if mode not in (None, "default", "inherited"):
                    yield "unread", f"it is drawn as its extent ({mode}), which is no body"
        for clips in (prim.GetMetadata("clips") or {}).values():
            names.CLIPS.refuse_misspelt(clips, f"{self._path}: clips")
        for words in why_not_applied(prim) if self._has_below else ():
            yield "unread", words
        if prim.IsInstance():
            for child in [child for spec in prim.GetPrimStack() for child in spec.nameChildren]:
                shared = prim.GetPrototype().GetChild(child.name)
                if not (shared and child in shared.GetPrimStack()) and _shapes(child):
                    yield "left-out", f"an override of {child.name}, below an instance: not applied"

    def _of_material(self) -> Found:
        """A preview surface may displace the surface. Connections for single renderers are written
        by habit, and say nothing."""
        if self._choice.colliders:
            return
        source, _, _ = UsdShade.Material(self._prim).ComputeDisplacementSource()
        shader = UsdShade.Shader(source.GetPrim()) if source else None
        given = shader.GetInput("displacement") if shader else None
        if given and (given.HasConnectedSource() or given.Get(self._time)):
            yield "unread", "the material displaces surfaces; they are checked without"

    def _unread(self, known: Names, found: Iterable[str], place: str) -> Found:
        """Those of these names that nobody knows. Raises SatcheckError for one that is misspelt."""
        takes_space = self._prim.IsA(UsdGeom.Imageable) or not self._prim.GetTypeName()
        for name in found:
            if list(known.unread([name], place)) and takes_space:
                yield "unread", f"{name} is not read; it may hold or move a body"

    def _unknown_apis(self) -> Iterator[str]:
        registry = Usd.SchemaRegistry
        for name in _apis(self._prim):
            kind, instance = registry.GetTypeNameAndInstance(name)
            if registry().FindAppliedAPIPrimDefinition(kind) is None:
                yield kind
            elif instance and not registry().IsMultipleApplyAPISchema(kind):
                yield name

    def _of_properties(self) -> Found:
        prim, spaces = self._prim, names.of_spaces()
        known = frozenset(prim.GetPrimDefinition().GetPropertyNames())
        unknown = defaultdict(list)
        for name in prim.GetAuthoredPropertyNames():
            space, _, rest = name.partition(":")
            if name not in known:
                unknown[space if rest else ""].append(rest or name)
            is_read = space + ":" == names.OP or (space in spaces and rest in spaces[space].read)
            if is_read or name in names.SHAPING:
                found = prim.GetProperty(name)
                names.PROPERTY.refuse_misspelt(_unregistered(found), f"{self._path}: {name}")
                if isinstance(found, Usd.Attribute) and found.HasAuthoredConnections():
                    yield "unread", f"{name} is connected to another value, which is not read"
        yield from self._of_plain(unknown.pop("", []), known)
        for space, others in unknown.items():
            yield from self._of_space(space, others)

    def _of_plain(self, found: list[str], known: frozenset[str]) -> Found:
        """Of the properties without a name space that no schema of the prim has."""
        prim, own = self._prim, names.of_type(known)
        own.refuse_misspelt(found, self._path)
        if prim.IsA(UsdGeom.Gprim) or prim.IsA(UsdGeom.PointInstancer):
            stated = [name for name in found if not prim.GetProperty(name).IsCustom()]
            yield from self._unread(own, stated, self._path)
        elif prim.IsA(UsdGeom.Imageable):
            moves = names.OPS.read if self._has_below else frozenset()
            for name in sorted((_OF_GEOMETRY | moves).intersection(found)):
                yield "unread", f"{name}: a prim of the type {prim.GetTypeName()} has none"
        elif self._has_below:
            for name in sorted({"visibility", "purpose"}.intersection(found)):
                yield "left-out", f"{name}: a prim of no type has none, it hides nothing"

    def _of_space(self, space: str, found: list[str]) -> Found:
        """Of the properties of a name space that no schema of the prim has."""
        spaces = names.of_spaces()
        if space == "skel" and self._prim.IsA(UsdGeom.Imageable):
            yield "unread", f"skel:{found[0]} is of no concern without SkelBindingAPI"
        if space in spaces and space + ":" != names.OP:
            spaces[space].refuse_misspelt(found, self._path)
        elif any(
            name.partition(":")[0] in known.read for known in spaces.values() for name in found
        ):
            Names(frozenset(spaces)).refuse_misspelt([space], self._path)

    def _of_tokens(self) -> Found:
        definition = self._prim.GetPrimDefinition()
        for name in _TOKENS | names.SWITCHES:
            attribute = self._prim.GetAttribute(name)
            if not attribute or not attribute.HasAuthoredValue():
                continue
            allowed = definition.GetPropertyMetadata(name, "allowedTokens")
            value = attribute.Get(self._time)
            if allowed and value is not None and value not in allowed:
                yield "unread", f"{name} is {value!r}, not one of {', '.join(allowed)}"
            if name in names.SWITCHES and not isinstance(value, int):
                yield "unread", f"{name} is {value!r}, no true or false"

    def _of_ops(self) -> Found:
        prim, attribute = self._prim, self._prim.GetAttribute(_ORDER)
        written = [name for name in prim.GetAuthoredPropertyNames() if name.startswith(names.OP)]
        present = frozenset(written)
        order = [str(each) for each in (attribute.Get() if attribute else None) or ()]
        if not prim.IsA(UsdGeom.Xformable):
            if (order or present) and self._has_below:
                kind = prim.GetTypeName() or "no type"
                words = f"a prim of {kind} is not moved by its ops; it may be meant to be an Xform"
                yield "unread", words
            return
        place = f"{self._path}: {_ORDER}"
        for op in dict.fromkeys(order):
            name = op.removeprefix(_INVERSE)
            if op == _RESET:
                continue
            if not name.startswith(names.OP):
                yield from self._unread(Names(frozenset((_RESET, *present))), [name], place)
            elif name not in present and not prim.HasAttribute(name):
                yield from self._unread(Names(present - set(order)), [name], place)
            else:
                yield from self._unread(names.OPS, [name.split(":")[1]], place)
                if not prim.GetAttribute(name).HasAuthoredValue() and self._has_below:
                    yield "unread", f"the op {name} has no value"
        idle = sorted(present.difference(op.removeprefix(_INVERSE) for op in order))
        moving = [name for name in idle if self._moves(prim.GetAttribute(name))]
        if moving and self._has_below:
            yield "left-out", f"{', '.join(moving)} not in {_ORDER}: not applied"

    def _moves(self, op: Any) -> bool:
        if op.GetName().split(":")[1] not in names.OPS.read or not op.HasAuthoredValue():
            return False
        matrix = UsdGeom.XformOp(op).GetOpTransform(self._time)
        return bool(matrix != Gf.Matrix4d(1.0))

    def _of_skeleton(self) -> Found:
        prim = self._prim
        if prim.IsA(UsdSkel.Animation) and prim.GetAttribute("joints").HasAuthoredValue():
            lacks = [name for name in _MOVES if not prim.GetAttribute(name).HasAuthoredValue()]
            if lacks:  # UsdSkel leaves it out
                yield "unread", f"the animation has no {' and '.join(lacks)}: not applied"
        if not prim.HasAPI(UsdSkel.BindingAPI):
            return
        for name, kind in _BOUND.items():
            for target in prim.GetRelationship(f"skel:{name}").GetForwardedTargets():
                other = prim.GetStage().GetPrimAtPath(target)
                if not (other and other.IsA(kind)):
                    yield "unread", f"skel:{name} is {target}, which is no {kind.__name__}"
        if not prim.IsA(UsdGeom.Gprim) or not prim.GetAttribute(_JOINTS).HasAuthoredValue():
            return
        binding = UsdSkel.BindingAPI(prim)
        skeleton = binding.GetInheritedSkeleton()
        if not (prim.IsA(UsdGeom.Mesh) and skeleton and UsdSkel.Root.Find(prim)):
            words = "it is bound to a skeleton, which moves only meshes below a SkelRoot"
            yield "left-out", words
            return
        known = skeleton.GetJointsAttr().Get() or ()
        for lost in sorted(set(binding.GetJointsAttr().Get() or ()).difference(known))[:1]:
            yield "unread", f"skel:joints has {lost}, which its skeleton lacks"

    def _of_variants(self) -> Found:
        prim, sets = self._prim, self._prim.GetVariantSets()
        declared = sets.GetNames()
        for name in sorted(sets.GetAllVariantSelections().keys() - declared):
            if self._has_below:
                yield "left-out", f"it selects a variant of {name!r}, which is no set of variants"
        stack = prim.GetPrimStack()
        written = {name for spec in stack for name in spec.variantSets.keys()}  # noqa: SIM118
        for name in sorted(written.union(declared)):
            if name in declared and prim.GetVariantSet(name).GetVariantSelection():
                continue
            sets_of = [spec.variantSets[name] for spec in stack if name in spec.variantSets]
            specs = [variant.primSpec for each in sets_of for variant in each.variants]
            if any(holds_geometry(spec, self._kind) for spec in specs):
                yield "unread", f"no variant of the set {name!r} is selected, and they hold bodies"

    def _of_exemptions(self) -> Found:
        prim = self._prim
        for name in filter(prim.HasRelationship, _EXEMPT):
            for target in prim.GetRelationship(name).GetForwardedTargets():
                if not prim.GetStage().GetPrimAtPath(target):
                    code = "unread" if name.endswith("excludes") else "ignored-opinion"
                    yield code, f"{name} has {target}, which is no prim"
        if prim.HasRelationship(_EXEMPT[0]) and not prim.HasAPI(UsdPhysics.FilteredPairsAPI):
            yield "ignored-opinion", "filteredPairs without PhysicsFilteredPairsAPI exempt nothing"
        together = prim.GetAttribute("physxArticulation:enabledSelfCollisions")
        if together and together.Get(self._time) is False:
            words = "enabledSelfCollisions is not applied: bodies of the articulation are checked"
            yield "left-out", words

    def _of_collider(self) -> Found:
        prim, approximation = self._prim, self._prim.GetAttribute("physics:approximation")
        shaped = names.SHAPES_OF_COLLIDERS.intersection(_apis(prim))
        if shaped and not approximation.HasAuthoredValue():
            words = f"{min(shaped)} may shape the collider otherwise; its geometry is checked"
            yield "unread", words
        if approximation and not prim.HasAPI(UsdPhysics.MeshCollisionAPI):
            words = "physics:approximation is of no concern without PhysicsMeshCollisionAPI"
            yield "unread", words
        rest = prim.GetAttribute("physxCollision:restOffset")
        value = rest.Get(self._time) if rest else None
        if isinstance(value, float) and value != 0 and math.isfinite(value):
            yield "unread", f"its restOffset of {value:g} is not applied"


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


def _holds_geometry(prim: Any) -> bool:
    return any(map(holds_geometry, prim.GetPrimStack()))


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
    return (
        holds_geometry(spec)
        or spec.HasInfo("active")
        or any(each.name in names.SHAPING for each in spec.properties)
        or any(map(_shapes, spec.nameChildren))
    )
