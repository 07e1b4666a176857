"""Keeps files outside of the permitted folders closed.

USD opens each layer that a file names. So the layers inside are looked at first, and an empty layer
in memory stands in for each file outside. The stage then uses that, and is refused.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pxr import Ar, Sdf, Tf

from satcheck.scene.errors import Refused
from satcheck.scene.paths import Permitted, followed


class Closed:
    """own: the folder of the file. Holds the layers that stand in for those outside."""

    def __init__(self, permitted: Permitted, own: Path) -> None:
        self._permitted = permitted
        self._own = followed(own)
        self._stand_ins: dict[str, Any] = {}

    def close(self, root: Any) -> None:
        """Puts empty layers for what the root layer, and the layers that it names, name outside.
        Raises Refused for value clips outside, which USD opens late."""
        variables = root.pseudoRoot.GetInfo("expressionVariables") or {}
        seen, waiting = {root.identifier}, [root]
        while waiting:
            layer = waiting.pop()
            for place in _named_by(layer, variables):
                if place in seen:
                    continue
                seen.add(place)
                if not self.permits(place):
                    self._stand_in(place)
                elif (inner := _opened(place)) is not None:
                    waiting.append(inner)
            for place in _clips_of(layer):
                if not self.permits(place):
                    raise self.refusal(place)

    def permits(self, place: str) -> bool:
        return self._permitted.has(Path(_file_of(place)), self._own)

    def refusal(self, place: str) -> Refused:
        where = self._permitted.beyond("the file's directory")
        message = f"layer {place!r} lies {where}: refused (allow it with --allow-outside)"
        return Refused("outside-path", message)

    def _stand_in(self, place: str) -> None:
        if Path(_file_of(place)).exists():
            text = Sdf.FileFormat.FindById("usda")
            self._stand_ins[place] = Sdf.Layer.New(text, place)


def _file_of(place: str) -> str:
    """The file, without arguments and the path within a package."""
    return str(Ar.SplitPackageRelativePathOuter(Sdf.Layer.SplitIdentifier(place)[0])[0])


def _named_by(layer: Any, variables: dict[str, Any]) -> Iterator[str]:
    for name in filter(None, layer.GetCompositionAssetDependencies()):
        if Sdf.VariableExpression.IsExpression(name):
            name = Sdf.VariableExpression(name).Evaluate(variables).value
        if name:
            yield _place(layer, name)


def _place(layer: Any, name: str) -> str:
    """Of a file that a layer names. One that is missing counts from the folder of the layer."""
    place = Sdf.ComputeAssetPathRelativeToLayer(layer, name)
    return (
        place if Path(place).is_absolute() else str(Path(_file_of(layer.realPath)).parent / place)
    )


def _opened(place: str) -> Any:
    """The layer; None: it cannot be opened, as the composition then says."""
    try:
        return Sdf.Layer.FindOrOpen(place)
    except Tf.ErrorException:
        return None


def _clips_of(layer: Any) -> Iterator[str]:
    """The files of the value clips of a layer, and the places of their templates."""
    found: list[str] = []

    def look(path: Any) -> None:
        spec = layer.GetPrimAtPath(path) if path.IsPrimPath() else None
        for clips in (spec.GetInfo("clips") if spec else {}).values():
            for value in clips.values():
                if isinstance(value, Sdf.AssetPath):
                    found.append(value.path)
                elif isinstance(value, Sdf.AssetPathArray):
                    found.extend(each.path for each in value)
            found.append(clips.get("templateAssetPath", ""))

    layer.Traverse("/", look)
    for name in filter(None, found):
        yield _place(layer, name)
