"""What a COLLADA file promises, before a parser that skips what it does not understand sees it.

The outline holds the node graph and the number of triangles of each geometry. Building it refuses
entities, numbers that are not finite, negative vertex numbers, and counts that do not fit.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits
from satcheck.scene.loading.placing import instances
from satcheck.scene.loading.xml_guard import guarded_parser, parse_xml, split_name

_ROOT = "COLLADA"
_READ = frozenset({"triangles", "polylist", "polygons"})
_NO_TRIANGLES = frozenset({"lines", "linestrips"})
_NOT_READ = frozenset({"tristrips", "trifans", "ph"})
# Transformations that the parser takes for others.
_BENDS = frozenset({"lookat", "skew"})
_TEXTS = frozenset({"p", "vcount", "float_array"})
_SCENE_PREFIX = "scene:"  # keys of the graph: visual scenes and nodes, and geometries
_GEOMETRY_PREFIX = "geometry:"


@dataclass(slots=True)
class Outline:
    """triangles: number of triangles of each geometry id. warnings: code -> message."""

    triangles: dict[str, int] = field(default_factory=dict)
    children: dict[str, list[str]] = field(default_factory=dict)
    root: str | None = None
    warnings: dict[str, str] = field(default_factory=dict)
    # Visual scenes and nodes that are placed in a way that is not read: no harm without triangles.
    misplaced: dict[str, MeshFileError] = field(default_factory=dict)

    def promised_triangles(self) -> int:
        """Triangles of all instances in the scene; raises MeshFileError for a circle."""
        if self.root is None or self.root not in self.children:
            raise MeshFileError("empty-mesh", "empty mesh: the file instantiates no visual scene")
        placed = instances(
            [(self.root, None)],
            children=lambda key: [(child, None) for child in self._children_of(key)],
            has_mesh=lambda key: self.triangles.get(key, 0) > 0,
            name=str,
            kind="node",
        )
        for key, refusal in self.misplaced.items():
            if self._holds_triangles(key):
                raise refusal
        total = sum(self.triangles[instance.key] for instance in placed)
        if total > limits.MAX_TRIANGLES:
            raise MeshFileError(
                "too-large", f"{total} triangles in all instances exceed {limits.MAX_TRIANGLES}"
            )
        return total

    def _holds_triangles(self, key: str) -> bool:
        seen, left = {key}, [key]
        while left:
            below = left.pop()
            if self.triangles.get(below, 0) > 0:
                return True
            new = set(self.children.get(below, ())) - seen
            seen |= new
            left += new
        return False

    def _children_of(self, key: str) -> list[str]:
        if key in self.children:
            return self.children[key]
        if key in self.triangles:
            return []
        raise MeshFileError("index-out-of-range", f"the scene refers to unknown {key!r}")


@dataclass(slots=True)
class _Primitive:
    kind: str
    count: int
    stride: int = 1  # numbers a corner
    polygons: list[int] = field(default_factory=list)  # corners of each <p>, or of each polygon
    words: int = 0


def read_outline(data: bytes) -> Outline:
    reader = _OutlineReader()
    parse_xml(lambda: reader.parser.Parse(data, True))
    return reader.outline


class _OutlineReader:
    def __init__(self) -> None:
        self.outline = Outline()
        self.parser = guarded_parser()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self._depth = 0
        self._owners: list[str] = []  # the visual scenes and nodes around
        self._geometry: str | None = None
        self._primitive: _Primitive | None = None
        self._promised_floats = -1
        self._words: list[str] | None = None
        self._starts: dict[str, Callable[[dict[str, str]], None]] = {
            "geometry": self._start_geometry,
            "visual_scene": self._start_owner,
            "node": self._start_owner,
            "instance_visual_scene": self._start_root,
            "instance_node": lambda attributes: self._refer(_SCENE_PREFIX, attributes),
            "instance_geometry": lambda attributes: self._refer(_GEOMETRY_PREFIX, attributes),
            "instance_controller": self._start_controller,
            "input": self._start_input,
            "float_array": self._start_floats,
        }

    def _fail(self, code: str, message: str) -> MeshFileError:
        return MeshFileError(code, f"line {self.parser.CurrentLineNumber}: {message}")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        local = split_name(name)[1]
        self._depth += 1
        if self._depth == 1 and local != _ROOT:
            raise MeshFileError("not-this-format", f"not a COLLADA file: its root is <{local}>")
        if local in _NOT_READ and self._geometry:
            raise self._fail("unsupported-feature", f"<{local}> is not read")
        if local in _BENDS and self._owners:
            refusal = self._fail("unsupported-feature", f"<{local}> is not read")
            self.outline.misplaced.setdefault(self._owners[-1], refusal)
        if local in _NO_TRIANGLES and self._geometry:
            self.outline.warnings["ignored-geometry"] = "lines are ignored"
        if local in _READ and self._geometry:
            self._primitive = _Primitive(local, self._count(attributes))
        if local in _TEXTS:
            self._words = []
        if local in self._starts:
            self._starts[local](attributes)

    def _count(self, attributes: dict[str, str]) -> int:
        try:
            return int(attributes["count"])
        except (KeyError, ValueError):
            raise self._fail("bad-record", "an element without a count") from None

    def _start_geometry(self, attributes: dict[str, str]) -> None:
        self._geometry = _GEOMETRY_PREFIX + attributes.get("id", "")
        self.outline.triangles[self._geometry] = 0

    def _start_owner(self, attributes: dict[str, str]) -> None:
        key = _SCENE_PREFIX + attributes.get("id", f"unnamed {len(self.outline.children)}")
        if key in self.outline.children:
            key += f" again {len(self.outline.children)}"
        self.outline.children[key] = []
        if self._owners:
            self.outline.children[self._owners[-1]].append(key)
        self._owners.append(key)

    def _start_root(self, attributes: dict[str, str]) -> None:
        self.outline.root = _SCENE_PREFIX + self._target(attributes)

    def _target(self, attributes: dict[str, str]) -> str:
        url = attributes.get("url", "")
        if not url.startswith("#"):
            raise self._fail("outside-path", f"reference {url!r} leaves the file: refused")
        return url[1:]

    def _refer(self, prefix: str, attributes: dict[str, str]) -> None:
        if self._owners:
            self.outline.children[self._owners[-1]].append(prefix + self._target(attributes))

    def _start_controller(self, _: dict[str, str]) -> None:
        raise self._fail("unsupported-feature", "skinned meshes are not read")

    def _start_input(self, attributes: dict[str, str]) -> None:
        if self._primitive and attributes.get("offset", "0").isdecimal():
            offset = int(attributes.get("offset", "0"))
            self._primitive.stride = max(self._primitive.stride, offset + 1)

    def _start_floats(self, attributes: dict[str, str]) -> None:
        self._promised_floats = self._count(attributes)

    def _text(self, text: str) -> None:
        if self._words is not None:
            self._words.append(text)

    def _end(self, name: str) -> None:
        local = split_name(name)[1]
        self._depth -= 1
        if local in _TEXTS and self._words is not None:
            words = "".join(self._words).split()
            self._words = None
            self._end_text(local, words)
        elif local in ("node", "visual_scene"):
            self._owners.pop()
        elif local == "geometry":
            self._geometry = None
        elif local in _READ and self._primitive:
            self._end_primitive(self._primitive)
            self._primitive = None

    def _end_text(self, local: str, words: list[str]) -> None:
        if local == "float_array" and self._geometry:
            self._check_floats(words)
        primitive = self._primitive
        if primitive is None:
            return
        if local == "vcount":
            if not all(word.isdecimal() for word in words):
                raise self._fail("bad-record", "vcount holds something else than numbers")
            primitive.polygons = [int(word) for word in words]
        elif local == "p":
            if any(word.startswith("-") for word in words):
                raise self._fail("index-out-of-range", "negative vertex number")
            primitive.words += len(words)
            if primitive.kind == "polygons":
                primitive.polygons.append(len(words) // primitive.stride)

    def _check_floats(self, words: list[str]) -> None:
        if len(words) != self._promised_floats:
            raise self._fail(
                "count-mismatch",
                f"float_array promises {self._promised_floats} numbers and has {len(words)}",
            )
        try:
            finite = all(math.isfinite(float(word)) for word in words)
        except ValueError as error:
            raise self._fail("bad-record", f"float_array: {error}") from None
        if not finite:
            raise self._fail("non-finite", "non-finite number in a float_array")

    def _end_primitive(self, primitive: _Primitive) -> None:
        if primitive.kind == "triangles":
            primitive.polygons = [3] * min(primitive.count, primitive.words)
        corners = sum(primitive.polygons)
        if len(primitive.polygons) != primitive.count or corners * primitive.stride != (
            primitive.words
        ):
            raise self._fail(
                "count-mismatch",
                f"<{primitive.kind}> promises {primitive.count} polygons, {corners} corners of "
                f"{primitive.stride} numbers, and has {primitive.words} numbers",
            )
        if any(polygon < 3 for polygon in primitive.polygons):
            raise self._fail("bad-record", "a polygon with fewer than 3 corners")
        assert self._geometry is not None
        self.outline.triangles[self._geometry] += corners - 2 * primitive.count
