"""Opens a stage: its layers, its unit and up axis, and what of it could not be opened."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import Any

from msgspec import Struct
from pxr import Sdf, Usd, UsdGeom

from satcheck.core.transform import Transform
from satcheck.plugins.usd.names import LOOKS
from satcheck.plugins.usd.outside import Closed, file_of
from satcheck.scene.access import note
from satcheck.scene.document import Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.opening import File
from satcheck.scene.units import unit_of
from satcheck.scene.words import listed

_METRE = "m"
_PARSER = re.compile(r"parse error matching .*? at(?= ')")  # rules of the grammar in C++
_DIGITS = 7  # that float32 keeps
# What a reference to such a file lacks is no body.
_ONLY_MATERIALS = re.compile(r"@[^@]*\.mtlx(\?[^@]*)?@")
# Composition errors that concern single opinions. All others may hide a part of the scene.
_OF_OPINIONS = ("Target", "Inconsistent", "Property", "Opinion", "VariableExpression")
_CODES = {"ErrorInvalidAssetPath": "missing-resource", "ErrorArcCycle": "reference-cycle"}


class Stage(Struct, frozen=True):
    """An open stage.

    unit: of lengths after the factor `scale`. y_up: its y axis points up. lost: prim -> why what it
    refers to is missing. warnings: (code, message).
    """

    stage: Any
    unit: str
    scale: float
    y_up: bool
    lost: dict[str, Refusal]
    warnings: tuple[tuple[str, str], ...]

    def matrix(self, matrix: Any) -> Transform:
        """For column vectors, in the unit of the scene, with z up."""
        columns = [[matrix[column][row] for column in range(4)] for row in range(4)]
        if self.y_up:
            x, y, z, last = columns
            columns = [x, [0.0 - value for value in z], y, last]
        scale = self.scale
        scaled = [value * scale for row in columns[:3] for value in row]
        return (*scaled, *columns[3])


class Remarks:
    """Collects prims by what is said of them, for one warning each."""

    def __init__(self) -> None:
        self._names: dict[tuple[str, str], list[str]] = {}

    def add(self, code: str, words: str, name: str) -> None:
        """words: after the name of prims and a colon."""
        self._names.setdefault((code, words), []).append(name)

    def warnings(self) -> Iterator[tuple[str, str]]:
        for (code, words), names in self._names.items():
            others = f" and {len(names) - 1} more" if len(names) > 1 else ""
            yield code, f"{names[0]}{others}: {words}"


def open_stage(file: File) -> Stage:
    """Return the stage of a file. Raises Refused, and what the library raises."""
    closed, location = Closed(file.context), str(file.location)
    root = Sdf.Layer.FindOrOpen(location)
    if root is not None:
        closed.close(root)
    stage = Usd.Stage.Open(root or location)
    for layer in sorted(stage.GetUsedLayers(True), key=lambda each: each.identifier):
        if layer.anonymous:
            continue
        note(file_of(layer.realPath))
        if not closed.permits(layer.identifier):
            raise closed.refusal(layer.identifier)
    return stage_of(stage, file.options["time"])


def stage_of(stage: Any, time: float | None = None) -> Stage:
    """Return an open stage as a reader takes it. time: a time code; None: the first. Raises
    Refused."""
    lost, warnings = _composition_errors(stage)
    lost |= lost_by(stage, _missing_clips)
    unit, scale = _unit(stage, warnings)
    axis = UsdGeom.GetStageUpAxis(stage)
    if axis not in (UsdGeom.Tokens.y, UsdGeom.Tokens.z):
        raise Refused("bad-record", f"upAxis is {axis!r}, not Y or Z")
    layers = stage.GetUsedLayers(True)
    times = [each for layer in layers for each in layer.ListAllTimeSamples()]
    if times and time is None:
        between = f"the first of the time codes {min(times):g} to {max(times):g}"
        warnings.append(("time-sampled", f"bodies stand as at {between} (--read time=T)"))
    return Stage(stage, unit, scale, axis == UsdGeom.Tokens.y, lost, tuple(warnings))


def said(error: Exception) -> str:
    """What an error of the library says, without the places in its source code."""
    try:
        message = str(error)
    except UnicodeDecodeError:  # it quotes the file
        return "its text is no UTF-8"
    quoted = [line.partition(" : '")[2] for line in message.splitlines() if " : '" in line]
    text = next(filter(None, quoted), message).strip().rstrip("'")
    text = _PARSER.sub("parse error at", text)
    return " ".join(text.split())


def _composition_errors(stage: Any) -> tuple[dict[str, Refusal], list[tuple[str, str]]]:
    """(prim -> why a part of it is missing, warnings). Raises Refused for a lost layer."""
    lost: dict[str, Refusal] = {}
    ignored: list[str] = []
    for error in stage.GetCompositionErrors():
        kind, message = type(error).__name__, said(error)
        code = _CODES.get(kind, "missing-resource")
        is_lost_layer = "Sublayer" in kind
        if "VariableExpression" in kind:  # no place is known, so that the file is refused
            is_lost_layer = " for variant at " not in message
        if is_lost_layer:
            raise Refused(code, message)
        if any(word in kind for word in _OF_OPINIONS) or _ONLY_MATERIALS.search(message):
            ignored.append(message)
            continue
        path = error.rootSite.path.GetPrimPath()
        if _may_hold_bodies(stage.GetPrimAtPath(path)):
            lost.setdefault(str(path.StripAllVariantSelections()), Refusal(code, message))
        else:
            ignored.append(message)
    counted = f" (and {len(ignored) - 1} more)" if len(ignored) > 1 else ""
    return lost, [("ignored-opinion", ignored[0] + counted)] if ignored else []


def _may_hold_bodies(prim: Any) -> bool:
    """Whether geometry may be missing below a prim with an unresolved reference."""
    return not prim or not (prim.IsAbstract() or prim.GetTypeName() in LOOKS)


def lost_by(stage: Any, missing: Callable[[Any], Iterator[str]]) -> dict[str, Refusal]:
    """Prim -> the first that it misses. USD says nothing of these."""
    prims = stage.Traverse(Usd.TraverseInstanceProxies())
    lost = ((str(prim.GetPath()), next(missing(prim), None)) for prim in prims)
    return {path: Refusal("missing-resource", words) for path, words in lost if words}


def _missing_clips(prim: Any) -> Iterator[str]:
    clips = Usd.ClipsAPI(prim)
    for name in prim.GetMetadata("clips") or ():
        for path in clips.GetClipAssetPaths(name) or ():
            if not path.resolvedPath:
                yield f"missing value clip {path.path!r}"


def missing_variants(prim: Any) -> Iterator[str]:
    """Yield words about the variants that a prim selects and does not have."""
    sets = prim.GetVariantSets()
    for name in sets.GetNames() if _may_hold_bodies(prim) else ():
        variants = sets.GetVariantSet(name)
        selected, known = variants.GetVariantSelection(), variants.GetVariantNames()
        if selected and selected not in known:
            yield f"variant set {name!r} has no variant {selected!r} ({listed(known)})"


def _unit(stage: Any, warnings: list[tuple[str, str]]) -> tuple[str, float]:
    """(unit, factor from stage units to it). Only the root layer's value counts."""
    metres = stage.GetMetadata(UsdGeom.Tokens.metersPerUnit)  # some files store it as float32
    if not (isinstance(metres, float) and math.isfinite(metres) and metres > 0):
        raise Refused("bad-record", f"metersPerUnit is {metres}")
    if not UsdGeom.StageHasAuthoredMetersPerUnit(stage):
        message = f"the file has no metersPerUnit: {metres:g} counts, the default of USD"
        warnings.append(("assumed-units", message))
    unit = unit_of(f"{metres:.{_DIGITS}g} * meters")
    return (_METRE, metres) if unit is None else (unit, 1.0)
