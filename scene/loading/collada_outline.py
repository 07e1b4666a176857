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
_READ = frozenset({"triangles", "polylist", "polygons", "tristrips", "trifans"})
_ONE_P_EACH = frozenset({"polygons", "tristrips", "trifans"})
_NO_TRIANGLES = frozenset({"lines", "linestrips"})
_NOT_READ = frozenset({"ph"})
# Transformations that the parser misreads, and those that it ignores unless they have this many
# numbers.
_BENDS = frozenset({"lookat", "skew"})
_MOVES = {"matrix": 16, "translate": 3, "rotate": 4, "scale": 3}
_TEXTS = frozenset({"p", "vcount", "float_array", *_MOVES})
_SCENE_PREFIX = "scene:"  # keys of the graph: visual scenes and nodes; geometries, controllers
_GEOMETRY_PREFIX = "geometry:"
_CONTROLLER_PREFIX = "controller:"


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
            if self._holds_triangles(key) or self._is_shaped():  # any node can be a joint
                raise refusal
        total = sum(self.triangles[instance.key] for instance in placed)
        if total > limits.MAX_TRIANGLES:
            raise MeshFileError(
                "too-large", f"{total} triangles in all instances exceed {limits.MAX_TRIANGLES}"
            )
        return total

    def _is_shaped(self) -> bool:
        return any(key.startswith(_CONTROLLER_PREFIX) for key in self.children)

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


@dataclass(slots=True)
class _Accessor:
    """How the numbers of a source make points. The parser looks at the names only."""

    offset: str
    stride: str
    names: list[str] = field(default_factory=list)

    @property
    def makes_points(self) -> bool:
        return (self.offset, self.stride) == ("0", "3") and self.names in (
            ["X", "Y", "Z"],
            ["", "", ""],
        )


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
        self._around: list[str] = []  # the elements that are open
        self._owners: list[str] = []  # the visual scenes and nodes around
        self._geometry: str | None = None
        self._controller: str | None = None
        self._source: str | None = None
        self._accessors: dict[str, _Accessor] = {}  # of the sources of this geometry
        self._in_vertices = False
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
            "instance_controller": lambda attributes: self._refer(_CONTROLLER_PREFIX, attributes),
            "controller": self._start_controller,
            "skin": lambda attributes: self._start_shaper("skin", attributes),
            "morph": lambda attributes: self._start_shaper("morph", attributes),
            "source": self._start_source,
            "accessor": self._start_accessor,
            "param": self._start_param,
            "vertices": self._start_vertices,
            "input": self._start_input,
            "float_array": self._start_floats,
        }

    def _fail(self, code: str, message: str) -> MeshFileError:
        return MeshFileError(code, f"line {self.parser.CurrentLineNumber}: {message}")

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        local = split_name(name)[1]
        self._around.append(local)
        if len(self._around) == 1 and local != _ROOT:
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
        self._accessors.clear()
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

    def _target(self, attributes: dict[str, str], name: str = "url") -> str:
        url = attributes.get(name, "")
        if not url.startswith("#"):
            raise self._fail("outside-path", f"reference {url!r} leaves the file: refused")
        return url[1:]

    def _refer(self, prefix: str, attributes: dict[str, str]) -> None:
        if self._owners:
            self.outline.children[self._owners[-1]].append(prefix + self._target(attributes))

    def _start_controller(self, attributes: dict[str, str]) -> None:
        self._controller = _CONTROLLER_PREFIX + attributes.get("id", "")
        self.outline.children[self._controller] = []

    def _start_shaper(self, kind: str, attributes: dict[str, str]) -> None:
        if self._controller is None:
            return
        target = _GEOMETRY_PREFIX + self._target(attributes, "source")
        self.outline.children[self._controller].append(target)
        words = "joints stand" if kind == "skin" else "weights of morph targets are"
        self.outline.warnings["rest-shape"] = f"{words} as the file stores them"

    def _start_source(self, attributes: dict[str, str]) -> None:
        self._source = attributes.get("id")

    def _start_accessor(self, attributes: dict[str, str]) -> None:
        if self._source is not None:
            self._accessors[self._source] = _Accessor(
                attributes.get("offset", "0").strip(), attributes.get("stride", "1").strip()
            )

    def _start_param(self, attributes: dict[str, str]) -> None:
        if self._source in self._accessors:
            self._accessors[self._source].names.append(attributes.get("name", ""))

    def _start_vertices(self, _: dict[str, str]) -> None:
        self._in_vertices = True

    def _start_input(self, attributes: dict[str, str]) -> None:
        if self._in_vertices and attributes.get("semantic") == "POSITION":
            accessor = self._accessors.get(attributes.get("source", "").lstrip("#"))
            if accessor is None or not accessor.makes_points:
                message = "positions should be X, Y, Z after X, Y, Z from the first number on"
                raise self._fail("unsupported-feature", message)
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
        self._around.pop()
        if local in _TEXTS and self._words is not None:
            words = "".join(self._words).split()
            self._words = None
            self._end_text(local, words)
        elif local in ("node", "visual_scene"):
            self._owners.pop()
        elif local == "geometry":
            self._geometry = None
        elif local == "controller":
            self._controller = None
        elif local == "source":
            self._source = None
        elif local == "vertices":
            self._in_vertices = False
        elif local in _READ and self._primitive:
            self._end_primitive(self._primitive)
            self._primitive = None

    def _end_text(self, local: str, words: list[str]) -> None:
        if local == "float_array" and (self._geometry or self._controller):
            self._check_floats(words)
        elif local in _MOVES and self._around[-1] == "node":
            self._check_move(local, words)
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
            if primitive.kind in _ONE_P_EACH:
                primitive.polygons.append(len(words) // primitive.stride)

    def _check_move(self, local: str, words: list[str]) -> None:
        if len(words) != _MOVES[local] or not _are_finite(words):
            message = f"<{local}> should be {_MOVES[local]} finite numbers"
            refusal = self._fail("bad-record", message)
            self.outline.misplaced.setdefault(self._owners[-1], refusal)

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


def _are_finite(words: list[str]) -> bool:
    try:
        return all(math.isfinite(float(word)) for word in words)
    except ValueError:
        return False
