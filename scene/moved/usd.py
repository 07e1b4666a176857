"""Writes moved bodies into a USD file, in a child process, as USD files are read.

Each moved prim gets one more translation, before its own operations. All other opinions stay.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from satcheck.core.errors import SatcheckError
from satcheck.core.worker import WorkerError
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.raw_mesh import Refusal
from satcheck.scene.read_options import ReadOptions

if TYPE_CHECKING:
    from satcheck.scene.loading.reading_children import ReadingChildren

Vector = tuple[float, float, float]

_CRATE = b"PXR-USDC"  # the first bytes of the binary encoding
_ORIGIN = (0.0, 0.0, 0.0)
# Of a translation through a few matrices, relative to the largest coordinate.
_ROUNDING = 2.0**-40
_SUFFIX = "resolved"  # of the operation xformOp:translate:resolved


class Request(msgspec.Struct, frozen=True):
    """location: of the file. suffix: of the file to write. bodies: the paths of all prims that are
    bodies. translations: path -> translation in the world of the scene, in its unit."""

    location: str
    suffix: str
    bodies: tuple[str, ...]
    translations: dict[str, Vector]
    options: ReadOptions


class Moved(msgspec.Struct, frozen=True, tag=True):
    """The new file."""

    data: bytes


def moved_usd(request: Request, children: ReadingChildren, *, seconds: float) -> bytes:
    """The root layer with these prims moved, and all other bodies where they were.

    Raises SatcheckError: `not-movable` for a prim that only an instance places, or a code of the
    reader.
    """
    try:
        reply = children.ask(__name__, msgspec.msgpack.encode(request), seconds=seconds)
    except WorkerError as error:
        message = f"{request.location} cannot be written: {error.message}; write a scene file"
        raise SatcheckError("reader-failed", message) from error
    answer = msgspec.msgpack.decode(reply, type=Moved | Refusal)
    if isinstance(answer, Refusal):
        raise SatcheckError(answer.code, answer.message)
    return answer.data


def serve(message: bytes) -> bytes:
    """Runs in the child process."""
    request = msgspec.msgpack.decode(message, type=Request)
    answer: Moved | Refusal
    try:
        answer = Moved(_written(request))
    except (MeshFileError, SatcheckError) as error:
        answer = Refusal(error.code, error.message)
    return msgspec.msgpack.encode(answer)


def _written(request: Request) -> bytes:
    from satcheck.scene.loading.usd.stage import open_stage

    opened = open_stage(Path(request.location), allow_outside=True)
    stage = opened.stage
    root = stage.GetRootLayer()
    stage.SetEditTarget(root)
    steps = {
        path: _in_stage(by, y_up=opened.y_up, scale=opened.scale)
        for path, by in request.translations.items()
    }
    _move(stage, request, steps)
    return _exported(root, request.suffix)


def _in_stage(by: Vector, *, y_up: bool, scale: float) -> Vector:
    """A translation of the scene, whose z axis points up, in the frame and unit of the stage."""
    x, y, z = (value / scale for value in by)
    return (x, z, 0.0 - y) if y_up else (x, y, z)


def _move(stage: Any, request: Request, steps: Mapping[str, Vector]) -> None:
    """Bodies below a moved prim move with it, so they are moved back."""
    from pxr import UsdGeom

    from satcheck.scene.loading.usd.choice import Choice

    cache = UsdGeom.XformCache(Choice(request.options).time)
    shifted: dict[str, Vector] = {}
    changes = []  # made after all placements are read
    for path in sorted(request.bodies, key=len):  # those above come first
        prim = None if "[" in path else stage.GetPrimAtPath(path)
        step = steps.get(path, _ORIGIN)
        inherited = _ORIGIN if prim is None else _inherited(prim, shifted)
        if step == inherited:
            continue
        if prim is None or prim.IsInstanceProxy():
            raise _not_movable(path, "it is one of several instances")
        if not UsdGeom.Xformable(prim):
            raise _not_movable(path, "it is no Xformable prim")
        shifted[path] = step
        parent = cache.GetParentToWorldTransform(prim)
        changes.append((prim, _local(prim, parent, step, inherited)))
    before = _places(stage, request)
    for prim, by in changes:
        _translate(prim, by)
    _refuse_others(request.bodies, steps, before, _places(stage, request))


def _places(stage: Any, request: Request) -> dict[str, Any]:
    """Body -> world matrix; of an instance of a point instancer, that of the instancer."""
    from pxr import UsdGeom

    from satcheck.scene.loading.usd.choice import Choice

    cache = UsdGeom.XformCache(Choice(request.options).time)
    places = {}
    for path in request.bodies:
        if prim := stage.GetPrimAtPath(path.partition("[")[0]):
            places[path] = cache.GetLocalToWorldTransform(prim)
    return places


def _refuse_others(
    bodies: Sequence[str],
    steps: Mapping[str, Vector],
    before: Mapping[str, Any],
    after: Mapping[str, Any],
) -> None:
    """A reference to a moved prim, or an instancer below it, moves with it."""
    from pxr import Gf

    for path in bodies:
        if path not in before:
            continue
        step = Gf.Vec3d(*steps.get(path, _ORIGIN))
        old, new = before[path].ExtractTranslation(), after[path].ExtractTranslation()
        largest = max(map(abs, (*old, *new, *step)))
        if (new - old - step).GetLength() > _ROUNDING * largest:
            raise _not_movable(path, "it refers to a prim that is moved, or lies below one")


def _inherited(prim: Any, shifted: Mapping[str, Vector]) -> Vector:
    """How far the nearest moved prim above moves this one."""
    while not (prim.IsPseudoRoot() or _resets(prim)):
        prim = prim.GetParent()
        if (step := shifted.get(str(prim.GetPath()))) is not None:
            return step
    return _ORIGIN


def _resets(prim: Any) -> bool:
    """Whether the prims above do not place it."""
    from pxr import UsdGeom

    xform = UsdGeom.Xformable(prim)
    return bool(xform) and bool(xform.GetResetXformStack())


def _local(prim: Any, parent: Any, step: Vector, inherited: Vector) -> Any:
    """The difference of two translations in the world, in the space of the parent."""
    from pxr import Gf

    difference = Gf.Vec3d(*step) - Gf.Vec3d(*inherited)
    if _resets(prim):
        return difference
    return parent.GetInverse().TransformDir(difference)


def _translate(prim: Any, by: Any) -> None:
    from pxr import UsdGeom

    xform = UsdGeom.Xformable(prim)
    operations, resets = xform.GetOrderedXformOps(), xform.GetResetXformStack()
    names = {operation.GetOpName() for operation in operations}
    suffix, number = _SUFFIX, 1
    while f"xformOp:translate:{suffix}" in names:
        number += 1
        suffix = f"{_SUFFIX}{number}"
    added = xform.AddTranslateOp(UsdGeom.XformOp.PrecisionDouble, suffix)
    added.Set(by)
    xform.SetXformOpOrder([added, *operations], resets)


def _exported(layer: Any, suffix: str) -> bytes:
    """In the encoding of the suffix; .usd: in that of the file that was read."""
    kind = suffix.removeprefix(".")
    if kind == "usd":
        with Path(layer.realPath).open("rb") as file:
            kind = "usdc" if file.read(len(_CRATE)) == _CRATE else "usda"
    if kind == "usda":
        return str(layer.ExportToString()).encode()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"layer.{kind}"
        layer.Export(str(path))
        return path.read_bytes()


def _not_movable(path: str, reason: str) -> SatcheckError:
    return SatcheckError(
        "not-movable", f"{path} cannot be moved in the USD file: {reason}; write a scene file"
    )
