"""Walks the prims of a stage, with instances and point instancers, and places them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from msgspec import Struct
from pxr import Usd, UsdGeom

from satcheck.scene.document import Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits


class Frame(Struct, frozen=True):
    """What the prims of a walk are placed in: the world, or one instance of a point instancer.

    root: the prototype; None: the world. matrix: from the space of the root's parent to the world.
    name: path of the root, such as /World/Scatter[3]:Post. instancer: its prim, and the frame of
    that.
    """

    root: Any = None
    matrix: Any = None
    name: str = ""
    instancer: tuple[Any, Frame] | None = None

    def name_of(self, prim: Any) -> str:
        path = prim.GetPath()
        if self.root is None:
            return str(path)
        below = path.MakeRelativePath(self.root.GetPath())
        return self.name if path == self.root.GetPath() else f"{self.name}/{below}"

    def around(self, prim: Any) -> Iterator[tuple[Any, Frame]]:
        """The prim, then each point instancer around it, with their frames."""
        yield prim, self
        if self.instancer is not None:
            outer, frame = self.instancer
            yield from frame.around(outer)

    def ancestors(self, prim: Any) -> Iterator[tuple[str, Any, Frame]]:
        """The prim and those above it, through point instancers, each with its name and frame."""
        for below, frame in self.around(prim):
            while below and not below.IsPseudoRoot():
                yield frame.name_of(below), below, frame
                if below == frame.root:
                    break
                below = below.GetParent()


WORLD = Frame()


class PlacedPrim(Struct, frozen=True):
    """A geometric prim, or why what stands for one is lost. matrix: of row vectors, to the
    world."""

    name: str
    prim: Any
    frame: Frame
    matrix: Any = None
    refusal: Refusal | None = None

    def outermost(self) -> Any:
        """The path of the prim, or of the point instancer around all."""
        return [*self.frame.around(self.prim)][-1][0].GetPath()


class Walk:
    """time: a Usd.TimeCode."""

    def __init__(self, stage: Any, time: Any) -> None:
        self._stage = stage
        self._time = time
        self._cache = UsdGeom.XformCache(time)
        self._count = 0

    def prims(self) -> Iterator[PlacedPrim]:
        """Every active, defined prim but the prototypes of point instancers; and each instance of
        these. Raises Refused for more than the limit."""
        prims = Usd.PrimRange.Stage(self._stage, Usd.TraverseInstanceProxies())
        yield from self._below(prims, WORLD)

    def _below(self, prims: Any, frame: Frame) -> Iterator[PlacedPrim]:
        each = iter(prims)
        for prim in each:
            if prim.IsA(UsdGeom.PointInstancer):
                each.PruneChildren()
                yield from self._instances(prim, frame)
            else:
                self._count += 1
                limits.refuse_many(self._count, "prims with all instances")
                yield self._with_matrix(prim, frame)

    def _with_matrix(self, prim: Any, frame: Frame) -> PlacedPrim:
        name = frame.name_of(prim)
        if frame.root is None:
            return PlacedPrim(name, prim, frame, self._cache.GetLocalToWorldTransform(prim))
        if prim == frame.root:
            return PlacedPrim(name, prim, frame, frame.matrix)
        inner, reset = self._cache.ComputeRelativeTransform(prim, frame.root)
        if reset:
            message = f"{name}: a prototype that resets its transforms has no place"
            return PlacedPrim(name, prim, frame, None, Refusal("unsupported-feature", message))
        return PlacedPrim(name, prim, frame, inner * frame.matrix)

    def _instances(self, prim: Any, frame: Frame) -> Iterator[PlacedPrim]:
        """The point instancer, then the prims below each prototype, once for each instance."""
        own = self._with_matrix(prim, frame)
        yield own
        if own.refusal is not None:
            return
        try:
            placed = self._placed(prim, frame)
        except Refused as error:
            reason = Refusal(error.code, f"{own.name}: point instancer: {error.message}")
            yield PlacedPrim(own.name, prim, frame, None, reason)
            return
        for index, root, matrix in placed:
            name = f"{own.name}[{index}]:{root.GetName()}"
            inside = Frame(root, matrix * own.matrix, name, (prim, frame))
            yield from self._below(of_prototype(root), inside)

    def _placed(self, prim: Any, frame: Frame) -> list[tuple[int, Any, Any]]:
        """(number, prototype, placement in the space of the instancer) of each instance that is not
        masked. Raises Refused."""
        if prim in [each for each, _ in frame.around(prim)][1:]:
            raise Refused("reference-cycle", "a prototype holds it: a cycle")
        instancer, time = UsdGeom.PointInstancer(prim), self._time
        numbers = instancer.GetProtoIndicesAttr().Get(time) or ()
        for name in ("positions", "orientations", "orientationsf", "scales"):
            count = len(prim.GetAttribute(name).Get(time) or ())
            if count not in (0, len(numbers)):
                message = f"it has {len(numbers)} protoIndices and {count} {name}"
                raise Refused("count-mismatch", message)
        paths = instancer.GetPrototypesRel().GetForwardedTargets()
        used = sorted(set(numbers))
        if used and not 0 <= used[0] <= used[-1] < len(paths):
            wrong = used[0] if used[0] < 0 else used[-1]
            message = f"it places prototype {wrong} of {len(paths)}"
            raise Refused("index-out-of-range", message)
        roots = {number: self._stage.GetPrimAtPath(paths[number]) for number in used}
        for number, root in roots.items():
            if not root or root.IsAbstract():
                raise Refused("missing-resource", f"there is no prototype {paths[number]}")
        samples = instancer.GetPositionsAttr().GetTimeSamples()
        if samples and time == Usd.TimeCode.EarliestTime():
            time = Usd.TimeCode(samples[0])  # velocities count from there
        matrices = (
            instancer.ComputeInstanceTransformsAtTime(
                time,
                time,
                UsdGeom.PointInstancer.IncludeProtoXform,
                UsdGeom.PointInstancer.IgnoreMask,
            )
            or ()
        )
        if len(matrices) != len(numbers):
            message = f"{len(numbers)} indices, {len(matrices)} placements"
            raise Refused("count-mismatch", message)
        mask = instancer.ComputeMaskAtTime(time) or [True] * len(numbers)
        if len(mask) != len(numbers):
            raise Refused("count-mismatch", f"{len(numbers)} indices, {len(mask)} ids")
        return [
            (index, roots[number], matrices[index])
            for index, number in enumerate(numbers)
            if mask[index]
        ]


# Prototypes may be below an `over`, so that they are not drawn by themselves.
_OF_PROTOTYPES = Usd.TraverseInstanceProxies(
    Usd.PrimIsActive & Usd.PrimIsLoaded & ~Usd.PrimIsAbstract
)


def of_prototype(root: Any) -> Any:
    """The range of the prims of a prototype."""
    return Usd.PrimRange(root, _OF_PROTOTYPES)


def type_of(prim: Any) -> str:
    """The type whose schema counts, perhaps a fallback that the file names; "": none is known."""
    return str(prim.GetPrimTypeInfo().GetSchemaTypeName())


def has_geometry_below(prim: Any) -> bool:
    below = Usd.PrimRange(prim, Usd.TraverseInstanceProxies())
    return any(each.IsA(UsdGeom.Gprim) or each.IsA(UsdGeom.PointInstancer) for each in below)
