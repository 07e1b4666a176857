"""Keeps files closed that are outside of the permitted folders, or too large.

USD opens each layer that a file names. So the layers inside are looked at first, and an empty layer
in memory stands in for each file outside. The stage then uses that, and is refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from glob import escape
from pathlib import Path
from typing import Any

from pxr import Ar, Sdf, Tf

from satcheck.scene.access import Context, note
from satcheck.scene.errors import Refused
from satcheck.scene.opening import exists, is_folder, size_of


class Closed:
    """context: of the file. Holds the layers that stand in for those outside."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._stand_ins: dict[str, Any] = {}

    def close(self, root: Any) -> None:
        """Puts empty layers for what the root layer, and the layers that it names, name outside.
        Notes these files, even if they are not there. Raises Refused for value clips outside, which
        USD opens late, and for what is too large."""
        variables = root.pseudoRoot.GetInfo("expressionVariables") or {}
        seen, waiting = {root.identifier}, [root]
        while waiting:
            layer = waiting.pop()
            for place in _named_by(layer, variables):
                if place in seen:
                    continue
                seen.add(place)
                note(file_of(place))
                if not self.permits(place):
                    if Path(file_of(place)).exists():
                        text = Sdf.FileFormat.FindById("usda")
                        self._stand_ins[place] = Sdf.Layer.New(text, place)
                    continue
                self._refuse_large(place)
                if (inner := opened(place)) is not None:
                    waiting.append(inner)
            for place in clips_of(layer):
                note(file_of(place))
                if not self.permits(place):
                    raise self.refusal(place)
                self._refuse_large(place)

    def permits(self, place: str) -> bool:
        return self._context.permits(Path(file_of(place)))

    def refusal(self, place: str) -> Refused:
        return self._context.refusal(f"layer {place!r}")

    def _refuse_large(self, place: str) -> None:
        file = file_of(place)
        if exists(file) and not is_folder(file):  # the composition says what is missing
            try:
                self._context.permitted.most.refuse_beyond(size_of(file))
            except Refused as error:
                raise Refused(error.code, f"layer {place!r}: {error.message}") from None


def file_of(place: str) -> str:
    """The file, without arguments and the path within a package."""
    return str(Ar.SplitPackageRelativePathOuter(Sdf.Layer.SplitIdentifier(place)[0])[0])


def _named_by(layer: Any, variables: dict[str, Any]) -> Iterator[str]:
    for name in filter(None, layer.GetCompositionAssetDependencies()):
        if Sdf.VariableExpression.IsExpression(name):
            name = Sdf.VariableExpression(name).Evaluate(variables).value
        if name:
            yield place_of(layer, name)


def place_of(layer: Any, name: str) -> str:
    """Of a file that a layer names. One that is missing counts from the folder of the layer."""
    place = Sdf.ComputeAssetPathRelativeToLayer(layer, name)
    return place if Path(place).is_absolute() else str(Path(file_of(layer.realPath)).parent / place)


def opened(place: str) -> Any:
    """The layer; None: it cannot be opened, as the composition then says."""
    try:
        return Sdf.Layer.FindOrOpen(place)
    except Tf.ErrorException:
        return None


def clips_of(layer: Any) -> Iterator[str]:
    """The files of the clips that a layer names, and the folders in which templates look for
    theirs, which end with `/`."""
    paths: list[Any] = []
    layer.Traverse("/", paths.append)
    found: list[str] = []
    for spec in map(layer.GetObjectAtPath, paths):
        prim = spec.primSpec if isinstance(spec, Sdf.VariantSpec) else spec
        sets = prim.GetInfo("clips") if isinstance(prim, Sdf.PrimSpec) else {}
        for clips in sets.values():
            if not isinstance(clips, dict):
                continue
            for value in clips.values():
                if isinstance(value, Sdf.AssetPath):
                    found.append(value.path)
                elif isinstance(value, Sdf.AssetPathArray):
                    found.extend(each.path for each in value)
            found.append(str(clips.get("templateAssetPath", "")))
    for place in (place_of(layer, name) for name in found if name):
        if "#" not in Path(place).name:
            yield place
            continue
        pattern = re.sub("#+", "*", escape(Path(place).name))
        yield f"{Path(place).parent}/"
        yield from map(str, sorted(Path(place).parent.glob(pattern)))
