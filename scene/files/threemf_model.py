"""One XML part of a 3MF package, its model: objects with meshes and references to others.

An error in the mesh of one object is stored in this object. Nearly all of a part are rows, vertices
and triangles. Runs of them are taken out before the XML is parsed, because an event for each row
would take most of the time.
"""

from __future__ import annotations

import math
import posixpath
import re
from array import array
from dataclasses import dataclass, field
from urllib.parse import unquote

from satcheck._native import readers
from satcheck.core.transform import Transform
from satcheck.scene.document import RawMesh, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import tidy_name
from satcheck.scene.files.slicer_config import Volume
from satcheck.scene.files.threemf_vocabulary import (
    ATTRIBUTES,
    CHILDREN,
    CURA_VOLUMES,
    FULL,
    PREFIXES,
    UNITS,
    ignorable,
    short,
    short_element,
)
from satcheck.scene.files.xml_tree import (
    Element,
    UnboundPrefix,
    read_elements,
    with_declared_prefixes,
)
from satcheck.scene.vocabulary import UnknownNames

ENCODINGS = frozenset({"utf-8", "utf-16"})
# Extensions that a model may require: what they add is read, or looked at where it stands.
_REQUIRED = frozenset({"p", "m", "s", "t", "sc"})
_DEFAULT_UNIT = "millimeter"
# Attributes of the rows of a mesh, whose errors refuse only their object.
_NUMBERS = {"vertex": ["x", "y", "z"], "triangle": ["v1", "v2", "v3"]}


def _run(name: str, numbers: list[str]) -> str:
    values = "".join(rf'\s++{each}="[-+.0-9eE]++"' for each in numbers)
    harmless = "|".join(filter(str.isidentifier, ATTRIBUTES[name].harmless))
    row = rf"""<{name}{values}(?:\s++(?:{harmless})="[^"<&]*+")*+\s*+/>\s*+"""
    return f"({row})((?:{row})++)"


# A row and those like it after it, as nearly all programs write them.
_RUN = re.compile("|".join(_run(*each) for each in _NUMBERS.items()).encode())
_NUMBER = re.compile(r'\s(?:[xyz]|v[123])="([^"]*)"')
_TAKEN = "satcheck-rows"  # the element in place of a run


Key = tuple[str, str]  # a part, and the id of an object in it
Reference = tuple[Key, Transform | None]  # an object, and where it is placed


@dataclass(slots=True)
class Object:
    """coordinates, corners: of vertices and triangles, as written. references: its components.
    refusal: the first thing wrong with its mesh."""

    name: str
    kind: str
    coordinates: list[str] = field(default_factory=list)
    corners: list[str] = field(default_factory=list)
    references: list[Reference] = field(default_factory=list)
    refusal: Refused | None = None

    @property
    def is_empty(self) -> bool:
        return not (self.refusal or self.corners or self.references)

    @property
    def has_mesh(self) -> bool:
        return self.refusal is not None or bool(self.corners)

    def texts(self, row: str) -> list[str]:
        return self.coordinates if row == "vertex" else self.corners

    def leave_out(self, volume: Volume) -> bool:
        """Drop a volume that is no material. False: it is none of this object, or not just one."""
        if volume.triangles is None:
            parts = [each for each in self.references if each[0][1] == volume.part]
            if len(parts) == 1:
                self.references.remove(parts[0])
            return len(parts) == 1
        first, last = volume.triangles
        if not first <= last < len(self.corners) // 3:
            return False
        # The triangles after it keep their numbers: a triangle of one corner has no area.
        self.corners[3 * first : 3 * last + 3] = ["0"] * (3 * (last - first + 1))
        if all(corner == "0" for corner in self.corners):
            self.corners = []
        return True

    def mesh(self, unit: str) -> RawMesh | Refusal:
        if self.refusal is not None:
            return Refusal(self.refusal.code, self.refusal.message)
        try:
            mesh = self._vertices()
            return RawMesh(
                vertices=mesh.vertices,
                triangles=self._triangles(len(self.coordinates) // 3),
                number_format="written-digits",
                decimals=mesh.decimals,
                significant=mesh.significant,
                units=unit,
            )
        except Refused as error:
            return Refusal(error.code, f"object {self.name!r}: {error.message}")

    def _vertices(self) -> readers.MeshData:
        read = readers.read_coordinates("\n".join(self.coordinates).encode())
        if isinstance(read, readers.ReadError):
            raise Refused(read.code, f"vertex {(read.line - 1) // 3}: {read.message}")
        if len(read.vertices) != 8 * len(self.coordinates):
            raise Refused("bad-record", "a coordinate has a line break in it")
        return read

    def _triangles(self, vertices: int) -> bytes:
        """vertices: their number."""
        try:
            _check_plain("".join(self.corners))
            triangles = array("I", map(int, self.corners))
        except (ValueError, OverflowError) as error:
            raise Refused("bad-record", f"<triangle>: {error}") from None
        if max(triangles) >= vertices:
            message = f"face index out of range: {max(triangles)} of {vertices} vertices"
            raise Refused("index-out-of-range", message)
        return triangles.tobytes()


@dataclass(slots=True)
class Model:
    unit: str = _DEFAULT_UNIT
    objects: dict[str, Object] = field(default_factory=dict)
    items: list[Reference] = field(default_factory=list)
    unread: tuple[tuple[str, str], ...] = ()


def read_model(part: str, data: bytes) -> Model:
    """Return the objects of a model part. part: its name in the package. Raises Refused."""
    runs: list[str] = []

    def take(match: re.Match[bytes]) -> bytes:
        first, run = filter(None, match.groups())
        runs.append(run.decode())
        lines = b"\n" * run.count(b"\n")  # the lines of errors stay
        return b'%b<%b n="%d"%b/>' % (first, _TAKEN.encode(), len(runs) - 1, lines)

    if _TAKEN.encode() not in data:
        data = _RUN.sub(take, data)
    try:
        return _ModelReader(part, runs).read(data)
    except UnboundPrefix:
        # Some programs write prefixes without a declaration for their own data.
        return _ModelReader(part, runs).read(with_declared_prefixes(data))


def part_name(target: str) -> str:
    path = unquote(target).replace("\\", "/")
    return posixpath.normpath(posixpath.join("/", path)).lstrip("/")


class _ModelReader:
    """Keeps only coordinates, indices and references. runs: the rows that were taken out."""

    def __init__(self, part: str, runs: list[str]) -> None:
        self._part = part
        self._runs = runs
        self._model = Model()
        self._object: Object | None = None
        self._row = ""  # the last row that was read, "vertex" or "triangle"
        self._unknown = UnknownNames()
        self._around: list[str] = []  # the elements that are open
        self._given: set[str] = set()  # elements of the object
        self._usual: set[tuple[str, ...]] = set()  # parent, element and attributes, all known
        self._prefixes: dict[str | None, str] = {}
        self._ignorable: frozenset[str] = frozenset()

    def read(self, data: bytes) -> Model:
        root = read_elements(
            data,
            encodings=ENCODINGS,
            tag_of=short_element,
            key_of=short,
            prefixes=self._prefixes,
        )
        if root.tag != "model":
            what = f"the outermost element is {root.tag}, and no model that is read"
            raise self._fail(root, "unsupported-feature", what)
        self._ignorable = ignorable(root.attributes, self._prefixes)
        self._visit(root)
        self._model.unread = self._unknown.warnings()
        for id_, object_ in self._model.objects.items():
            if object_.is_empty:
                object_.refusal = Refused("empty-mesh", f"object {id_!r} has no triangles")
        return self._model

    def _fail(self, element: Element, code: str, message: str) -> Refused:
        return Refused(code, f"{self._part}, line {element.line}: {message}")

    def _visit(self, element: Element) -> None:
        if element.tag == _TAKEN and self._runs:
            self._take(self._runs[int(element.attributes["n"])])
            return
        self._look(element)
        try:
            self._handle(element)
        except Refused as error:
            if self._object is None or element.tag not in _NUMBERS:
                raise
            self._object.refusal = self._object.refusal or error
        self._around.append(element.tag)
        for child in element.children:
            self._visit(child)
        self._around.pop()

    def _take(self, run: str) -> None:
        """Read the rows after a row."""
        if self._row:
            is_plain = run.count('"') == 6 * run.count("<")  # without other attributes
            texts = run.split('"')[1::2] if is_plain else _NUMBER.findall(run)
            self._current().texts(self._row).extend(texts)

    def _look(self, element: Element) -> None:
        """Gather the element, if it is unknown there, and its attributes."""
        name, around = element.tag, self._around[-1] if self._around else ""
        if (around, name, *element.attributes) in self._usual:
            return
        place = f"{self._part}, line {element.line}"
        children, own = CHILDREN.get(around), ATTRIBUTES.get(name)
        if children is not None and not self._is_ignorable(name):
            self._unknown.look(children, (name,), f"in {around}", f"{place}: <{around}>")
        elif around and name in ATTRIBUTES:
            message = f"{place}: <{name}> inside of <{around}>, which is not read"
            self._unknown.note((f"in {around}", name), message)
        if own is not None:
            given = [key for key in element.attributes if not self._is_ignorable(key)]
            self._unknown.look(own, given, name, f"{place}: <{name}>")
        elif name == "metadata" and ("object" in self._around or "build" in self._around):
            self._on_setting(element.attributes.get("name", ""), place)
        known = children is None or children.knows(name)
        if known and own is not None and all(map(own.knows, element.attributes)):
            self._usual.add((around, name, *element.attributes))

    def _is_ignorable(self, name: str) -> bool:
        return name.rpartition(":")[0] in self._ignorable

    def _on_setting(self, name: str, place: str) -> None:
        key = name.rpartition(":")[2]
        CURA_VOLUMES.refuse_misspelt([key], place)
        if CURA_VOLUMES.knows(key):
            message = f"{place}: {name} is not read; it may make a body none"
            self._unknown.note(("metadata", name), message)

    def _handle(self, element: Element) -> None:
        """Read an element of the core specification."""
        tag, attributes = element.tag, element.attributes
        self._row = ""
        try:
            match tag:
                case "model":
                    self._on_model(element)
                case "object":
                    self._on_object(element)
                case "mesh" | "vertices" | "triangles" | "components":
                    self._on_once(tag)
                case "vertex" | "triangle":
                    numbers = [attributes[key] for key in _NUMBERS[tag]]
                    self._current().texts(tag).extend(numbers)
                    self._row = tag
                case "component":
                    self._current().references.append(self._reference(attributes))
                case "item":
                    self._model.items.append(self._reference(attributes))
        except KeyError as error:
            raise self._fail(element, "bad-record", f"<{tag}> lacks {error.args[0]!r}") from None
        except (ValueError, OverflowError) as error:
            raise self._fail(element, "bad-record", f"<{tag}>: {error}") from None

    def _on_model(self, element: Element) -> None:
        attributes = element.attributes
        self._model.unit = attributes.get("unit", _DEFAULT_UNIT)
        if self._model.unit not in UNITS:
            message = f"the unit is {self._model.unit!r}, none of {', '.join(sorted(UNITS))}"
            raise self._fail(element, "bad-record", message)
        for prefix in attributes.get("requiredextensions", "").split():
            uri = self._prefixes.get(prefix, prefix)
            if PREFIXES.get(uri) not in _REQUIRED:
                raise self._fail(
                    element, "unsupported-feature", f"the model requires extension {uri!r}"
                )

    def _on_object(self, element: Element) -> None:
        attributes = element.attributes
        id_ = attributes["id"]
        if id_ in self._model.objects:
            raise self._fail(element, "bad-record", f"object id {id_!r} occurs twice")
        name = tidy_name(attributes.get("name"), tidy_name(f"object{id_}", "object"))
        self._object = self._model.objects[id_] = Object(name, attributes.get("type", "model"))
        for key, value in attributes.items():
            if key in FULL and value != "fullres":
                what = f"<object> {key}={value!r}: the mesh is not the body"
                message = f"{self._part}, line {element.line}: {what}"
                self._unknown.note(("resolution", key), message)
        self._given.clear()

    def _on_once(self, local: str) -> None:
        if local in self._given and self._object:
            twice = Refused("bad-record", f"an object with two <{local}>")
            self._object.refusal = self._object.refusal or twice
        self._given.add(local)

    def _current(self) -> Object:
        if self._object is None:
            raise ValueError("geometry outside of an object")
        return self._object

    def _reference(self, attributes: dict[str, str]) -> Reference:
        """A component or a build item."""
        path = attributes.get("p:path")
        part = part_name(path) if path else self._part
        return (part, attributes["objectid"]), self._matrix(attributes)

    def _matrix(self, attributes: dict[str, str]) -> Transform | None:
        """3MF writes 4x3 values for row vectors; here they become a 4x4 for column vectors."""
        if "transform" not in attributes:
            return None
        _check_plain(attributes["transform"])
        values = [float(word) for word in attributes["transform"].split()]
        if len(values) != 12 or not all(map(math.isfinite, values)):
            raise ValueError("a transform needs 12 finite numbers")
        rows = [(*values[axis::3],) for axis in range(3)]
        return (*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0)


def _check_plain(numbers: str) -> None:
    """Refuse what Python takes for a number and XML does not: "1_0", digits of other scripts."""
    if "_" in numbers or not numbers.isascii():
        raise ValueError(f"{numbers[:24]!r} is not a number")
