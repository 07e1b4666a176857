"""Walks the prims of a stage, with instances and point instancers, and places them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from msgspec import Struct
from pxr import Usd, UsdGeom

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits
from satcheck.scene.loading.raw_mesh import Refusal


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

    def ancestors(self, prim: Any) -> Iterator[tuple[str, Any]]:
        """The prim and those above it, each with its name, through point instancers."""
        frame = self
        while True:
            while prim and not prim.IsPseudoRoot():
                yield frame.name_of(prim), prim
                if prim == frame.root:
                    break
                prim = prim.GetParent()
            if frame.instancer is None:
                return
            prim, frame = frame.instancer


WORLD = Frame()


class Found(Struct, frozen=True):
    """A geometric prim, or why what stands for one is lost. matrix: of row vectors, to the
    world."""

    name: str
    prim: Any
    frame: Frame
    matrix: Any = None
    refusal: Refusal | None = None


class Walk:
    """time: a Usd.TimeCode."""

    def __init__(self, stage: Any, time: Any) -> None:
        self._stage = stage
        self._time = time
        self._cache = UsdGeom.XformCache(time)
        self._count = 0

    def prims(self) -> Iterator[Found]:
        """Every active, defined prim but the prototypes of point instancers; and each instance of
        these. Raises MeshFileError for more than the limit."""
        yield from self._below(Usd.PrimRange.Stage(self._stage, _WITH_INSTANCES), WORLD)

    def _below(self, prims: Any, frame: Frame) -> Iterator[Found]:
        each = iter(prims)
        for prim in each:
            if prim.IsA(UsdGeom.PointInstancer):
                each.PruneChildren()
                yield from self._instances(prim, frame)
            else:
                self._refuse_too_many()
                yield self._found(prim, frame)

    def _refuse_too_many(self) -> None:
        self._count += 1
        if self._count > limits.MAX_PLACEMENTS:
            message = f"more than {limits.MAX_PLACEMENTS} prims with all instances: split the file"
            raise MeshFileError("too-large", message)

    def _found(self, prim: Any, frame: Frame) -> Found:
        name = frame.name_of(prim)
        if frame.root is None:
            return Found(name, prim, frame, self._cache.GetLocalToWorldTransform(prim))
        if prim == frame.root:
            return Found(name, prim, frame, frame.matrix)
        inner, reset = self._cache.ComputeRelativeTransform(prim, frame.root)
        if reset:
            message = f"{name}: a prototype that resets its transforms has no place"
            return Found(name, prim, frame, None, Refusal("unsupported-feature", message))
        return Found(name, prim, frame, inner * frame.matrix)

    def _instances(self, prim: Any, frame: Frame) -> Iterator[Found]:
        """The prims below each prototype, once for each instance."""
        own = self._found(prim, frame)
        instancer = UsdGeom.PointInstancer(prim)
        yield own
        if own.refusal is not None:
            return
        try:
            roots = [
                self._prototype(path) for path in instancer.GetPrototypesRel().GetForwardedTargets()
            ]
            numbers = _value(instancer.GetProtoIndicesAttr(), self._time)
            if numbers and not 0 <= min(numbers) <= max(numbers) < len(roots):
                raise MeshFileError("index-out-of-range", f"a prototype of {len(roots)} is missing")
            time = self._time_of(instancer)
            placed = instancer.ComputeInstanceTransformsAtTime(
                time,
                time,
                UsdGeom.PointInstancer.IncludeProtoXform,
                UsdGeom.PointInstancer.IgnoreMask,
            )
            if len(placed or ()) != len(numbers):
                raise MeshFileError(
                    "count-mismatch", f"{len(numbers)} indices, {len(placed or ())} placements"
                )
        except MeshFileError as error:
            reason = Refusal(error.code, f"{own.name}: point instancer: {error.message}")
            yield Found(own.name, prim, frame, None, reason)
            return
        mask = instancer.ComputeMaskAtTime(time)
        for index, number in enumerate(numbers):
            if not mask or mask[index]:
                root = roots[number]
                name = f"{own.name}[{index}]:{root.GetName()}"
                inside = Frame(root, placed[index] * own.matrix, name, (prim, frame))
                yield from self._below(Usd.PrimRange(root, _WITH_INSTANCES), inside)

    def _prototype(self, path: Any) -> Any:
        prim = self._stage.GetPrimAtPath(path)
        if not prim:
            raise MeshFileError("missing-resource", f"there is no prototype {path}")
        return prim

    def _time_of(self, instancer: Any) -> Any:
        """A time code with a number where there are samples: velocities count from there."""
        samples = instancer.GetPositionsAttr().GetTimeSamples()
        earliest = self._time == Usd.TimeCode.EarliestTime()
        return Usd.TimeCode(samples[0]) if earliest and samples else self._time


_WITH_INSTANCES = Usd.TraverseInstanceProxies()


def _value(attribute: Any, time: Any) -> Any:
    value = attribute.Get(time)
    return () if value is None else value
