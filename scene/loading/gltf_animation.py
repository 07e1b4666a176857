"""Animations of glTF: the nodes as they stand at one time. Source: glTF 2.0, appendix C."""

from __future__ import annotations

import math
from array import array
from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from msgspec import Struct

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.gltf_accessors import Accessors
from satcheck.scene.loading.gltf_buffers import extension, integer, items, member
from satcheck.scene.words import listed

# What a channel may move, with the type of its values; None: as many numbers as morph targets.
_PATHS = {"translation": "VEC3", "rotation": "VEC4", "scale": "VEC3", "weights": None}
_WIDTHS = {"VEC3": 3, "VEC4": 4}
_POINTER = "KHR_animation_pointer"
_NEARLY_PARALLEL = 1 - 1e-9  # cosine above which an arc between two quaternions is a straight line


class Keys(Struct, frozen=True):
    """Keyframes. times: rising. values: of each key `width` numbers; with CUBICSPLINE each key has
    an incoming tangent, a value and an outgoing tangent."""

    times: Sequence[float]
    values: Sequence[float]
    width: int
    interpolation: str
    turns: bool  # the values are quaternions

    def at(self, time: float) -> list[float]:
        """The value at a time. Before the first key and after the last one it stays."""
        number = bisect_right(self.times, time) - 1
        if number < 0 or number == len(self.times) - 1:
            return self._value(max(number, 0))
        if self.interpolation == "STEP":
            return self._value(number)
        start, end = self.times[number], self.times[number + 1]
        share = (time - start) / (end - start)
        if self.interpolation == "CUBICSPLINE":
            return self._on_spline(number, share, end - start)
        first, second = self._value(number), self._value(number + 1)
        return _on_arc(first, second, share) if self.turns else _blended(first, second, share)

    def _row(self, row: int) -> list[float]:
        return list(self.values[row * self.width : (row + 1) * self.width])

    def _value(self, number: int) -> list[float]:
        return self._row(3 * number + 1 if self.interpolation == "CUBICSPLINE" else number)

    def _on_spline(self, number: int, t: float, seconds: float) -> list[float]:
        """Between two keys of a cubic Hermite spline."""
        leaving, entering = self._row(3 * number + 2), self._row(3 * number + 3)
        rows = (self._value(number), leaving, self._value(number + 1), entering)
        shares = (
            2 * t**3 - 3 * t**2 + 1,
            seconds * (t**3 - 2 * t**2 + t),
            3 * t**2 - 2 * t**3,
            seconds * (t**3 - t**2),
        )
        return [
            sum(share * row[k] for share, row in zip(shares, rows, strict=True))
            for k in range(self.width)
        ]


def _blended(first: Sequence[float], second: Sequence[float], share: float) -> list[float]:
    return [(1 - share) * a + share * b for a, b in zip(first, second, strict=True)]


def _on_arc(first: Sequence[float], second: Sequence[float], share: float) -> list[float]:
    """Between two unit quaternions on the shorter arc (slerp)."""
    cosine = sum(a * b for a, b in zip(first, second, strict=True))
    if cosine < 0:  # the opposite quaternion is the same rotation
        second, cosine = [-b for b in second], -cosine
    if cosine > _NEARLY_PARALLEL:
        return _blended(first, second, share)
    angle = math.acos(cosine)
    weights = math.sin((1 - share) * angle), math.sin(share * angle)
    return [
        (weights[0] * a + weights[1] * b) / math.sin(angle)
        for a, b in zip(first, second, strict=True)
    ]


def animations(document: dict[str, Any]) -> list[str]:
    """Their names; a number for those without."""
    return [
        str(animation.get("name") or number) if isinstance(animation, dict) else str(number)
        for number, animation in enumerate(items(document, "animations"))
    ]


def number_of(document: dict[str, Any], wanted: str | None) -> int:
    """The number of the animation of this name, else of this number; of the first one for None.
    Raises MeshFileError if there is none."""
    if wanted is None:
        return 0
    names = animations(document)
    if wanted in names:
        return names.index(wanted)
    if wanted.isdecimal() and int(wanted) < len(names):
        return int(wanted)
    message = f"there is no animation {wanted!r}: the animations are {listed(names)}"
    raise MeshFileError("unknown-part", message)


def posed(
    document: dict[str, Any], accessors: Accessors, time: float, number: int = 0
) -> dict[str, Any]:
    """The document with its nodes as an animation places them at a time, in seconds.

    Raises MeshFileError for an animation that is not as the format prescribes.
    """
    animation = member(items(document, "animations"), number, "animation")
    nodes = list(items(document, "nodes"))
    samplers = items(animation, "samplers")
    read: dict[int, array[float]] = {}
    for channel in items(animation, "channels"):
        target = channel.get("target") if isinstance(channel, dict) else None
        if not isinstance(target, dict):
            raise MeshFileError("bad-record", "animation: a channel without a target")
        if extension(target, _POINTER) is not None:
            raise MeshFileError("unsupported-feature", f"extension {_POINTER!r} is not read")
        if "node" not in target:  # the format lets an extension say what moves
            continue
        moved, path = integer(target, "node", -1), target.get("path")
        if path not in _PATHS:
            raise MeshFileError("bad-record", f"animation: a channel moves {path!r}")
        node = member(nodes, moved, "node")
        if "matrix" in node:
            raise MeshFileError("bad-record", f"node {moved} is animated and has a matrix")
        sampler = member(samplers, integer(channel, "sampler", -1), "sampler")
        keys = _keys(sampler, path, accessors, read)
        nodes[moved] = {**node, path: keys.at(time)}
    return {**document, "nodes": nodes}


def _keys(
    sampler: dict[str, Any], path: str, accessors: Accessors, read: dict[int, array[float]]
) -> Keys:
    """read: what was read of the accessors before."""
    interpolation = sampler.get("interpolation", "LINEAR")
    if interpolation not in ("LINEAR", "STEP", "CUBICSPLINE"):
        raise MeshFileError("bad-record", f"animation: interpolation {interpolation!r}")
    kind = _PATHS[path]
    times = _numbers(accessors, read, integer(sampler, "input", -1), "SCALAR")
    values = _numbers(accessors, read, integer(sampler, "output", -1), kind or "SCALAR")
    rows = len(times) * (3 if interpolation == "CUBICSPLINE" else 1)
    width = _WIDTHS[kind] if kind else len(values) // max(rows, 1)
    if not rows or len(values) != rows * width:
        raise MeshFileError("count-mismatch", "animation: keys and values are not one each")
    if any(later <= earlier for earlier, later in pairwise(times)):
        raise MeshFileError("bad-record", "animation: the times of the keys do not rise")
    return Keys(times, values, width, interpolation, path == "rotation")


def _numbers(
    accessors: Accessors, read: dict[int, array[float]], index: int, kind: str
) -> array[float]:
    if index not in read:
        read[index] = accessors.numbers(index, kind)
    return read[index]
