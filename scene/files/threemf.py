"""3MF core specification 1.3 with the production extension: packages of XML model parts.

This reader is our own: trimesh inflates every part of the package, merges objects of equal id from
different parts, and skips missing ones. Only the parts that the build refers to are opened. An
object with a mesh is placed once for each path of items and components that leads to it from the
build. Supports count like any other object.
"""

from __future__ import annotations

import fnmatch
import io
import math
import posixpath
import zipfile
from array import array
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import IO, NamedTuple
from urllib.parse import unquote

from msgspec.structs import replace

from satcheck._native import readers
from satcheck.core.transform import Transform
from satcheck.scene.document import Document, RawMesh, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import instances, raw_scene, tidy_name
from satcheck.scene.files.readers import File, mesh_reader
from satcheck.scene.files.slicer_config import CONFIGS, SIDE_FILES, Volume, volumes
from satcheck.scene.files.threemf_vocabulary import (
    ATTRIBUTES,
    CHILDREN,
    CORE,
    CURA_VOLUMES,
    FULL,
    PREFIXES,
    RELATIONSHIP,
    RELATIONSHIPS,
    TYPES,
    UNITS,
    ignorable,
    short,
    short_element,
)
from satcheck.scene.files.xml_tree import (
    UNDECLARED,
    UnboundPrefix,
    guarded_parser,
    parse_stream,
    read_elements,
    split_name,
    with_declared_prefixes,
)
from satcheck.scene.files.zip_guard import open_part, opened_zip
from satcheck.scene.vocabulary import UnknownNames
from satcheck.scene.words import listed

_START_PART = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_DEFAULT_PART = "3D/3dmodel.model"
# Extensions that a model may require: what they add is read, or looked at where it stands.
_REQUIRED = frozenset({"p", "m", "s", "t", "sc"})
_ENCODINGS = frozenset({"utf-8", "utf-16"})
_DEFAULT_UNIT = "millimeter"
# Attributes of the elements of a mesh, whose errors refuse only their object.
_NUMBERS = {"vertex": ["x", "y", "z"], "triangle": ["v1", "v2", "v3"]}
_ONCE = frozenset({"mesh", "vertices", "triangles", "components"})  # in an object
# Elements of extensions that define geometry other than triangles.
_OTHER_GEOMETRY = frozenset(
    {"beamlattice", "booleanshape", "displacementmesh", "levelset", "volumedata"}
)


def read_3mf(file: File) -> Document:
    """Return the objects that the build of a 3MF package places. Raises Refused without a
    file name."""
    with opened_zip(memoryview(file.data), "a 3MF file") as package:
        return _Package(package).read()


class _Package:
    def __init__(self, package: zipfile.ZipFile) -> None:
        self._package = package
        parts = [(part_name(name).lower(), name) for name in package.namelist()]
        self._names = dict(parts)
        self._twice = {
            part for part, count in Counter(part for part, _ in parts).items() if count > 1
        }
        self._models: dict[str, Model] = {}
        self._used: set[tuple[str, str]] = set()
        self._settings: list[str] = []
        self._unknown = UnknownNames()

    def read(self) -> Document:
        start = self._start_part()
        root = self._model(start)
        self._apply_config(root)
        if not root.items:
            raise Refused("empty-mesh", "empty mesh: the build has no items")
        nodes = instances(
            [((item.part, item.id), item.matrix) for item in root.items],
            children=lambda key: [
                ((reference.part, reference.id), reference.matrix)
                for reference in self._object(*key).references
            ],
            has_mesh=lambda key: self._object(*key).has_mesh,
            name=lambda key: self._object(*key).name,
            kind="object",
        )
        if not nodes:
            raise Refused("empty-mesh", "empty mesh: the build has no triangles")
        scene = raw_scene(
            nodes,
            lambda key: self._object(*key).name,
            lambda key: self._object(*key).mesh(root.unit),
        )
        left_out = self._left_out()
        unread = [each for model in self._models.values() for each in model.unread]
        return replace(scene, warnings=(*unread, *self._unknown.warnings(), *left_out))

    def _left_out(self) -> list[tuple[str, str]]:
        """Notes about what has no body."""
        unused = [
            f"object {id_!r}"
            for part, model in self._models.items()
            for id_ in model.objects
            if (part, id_) not in self._used
        ]
        opened = {part.lower() for part in self._models}
        unused += [
            f"part {name!r}"
            for part, name in self._names.items()
            if part.endswith(".model") and part not in opened
        ]
        said = [f"{listed(unused)} not in the build"] if unused else []
        if self._settings:
            said.append(f"{listed(self._settings)} of a slicer, which print nothing")
        return [("left-out", "; ".join(said))] if said else []

    def _apply_config(self, root: Model) -> None:
        """Leave out the volumes that the config of a slicer makes settings; refuse an object that
        one of them is taken away from."""
        SIDE_FILES.refuse_misspelt(self._names, "the package")
        shown = [name for name in self._names if name.startswith("metadata/") or _is_mesh(name)]
        self._unknown.look(SIDE_FILES, shown, "part", "the package")
        for name in fnmatch.filter(self._names, CONFIGS):
            with self._open(name) as stream:
                config = read_elements(stream)
            for volume in volumes(config, self._unknown):
                object_ = root.objects.get(volume.owner)
                if object_ is None or volume.negative or not object_.leave_out(volume):
                    what = "has a negative volume" if volume.negative else "has a modifier"
                    message = f"object {volume.owner!r} {what}, which is not read"
                    if object_ is None:
                        raise Refused("unsupported-feature", message)
                    object_.refusal = Refused("unsupported-feature", message)
                    object_.references.clear()
                else:
                    self._settings.append(f"a volume of object {volume.owner!r}")

    def _start_part(self) -> str:
        relationships = self._names.get("_rels/.rels")
        if relationships is None:
            return _DEFAULT_PART
        with self._open(relationships) as stream:
            root = read_elements(stream, encodings=_ENCODINGS)
        targets = []
        for element in root.children:
            place = f"{relationships}, line {element.line}"
            self._unknown.look(RELATIONSHIPS, (element.tag,), "relationships", place)
            self._unknown.look(RELATIONSHIP, [*element.attributes], "relationship", place)
            target = element.attributes.get("Target", _DEFAULT_PART)
            if element.attributes.get("Type") == _START_PART:
                targets.append(target)
                if element.attributes.get("TargetMode") == "External":
                    message = f"{place}: the start part {target!r} is not in the package"
                    raise Refused("unsupported-feature", message)
            elif target.lower().endswith(".model"):
                message = f"{place}: {target} is no start part by its type, and is not read"
                self._unknown.note(("start part", target), message)
        if not targets:
            message = f"{relationships} states no start part; {_DEFAULT_PART} is read"
            self._unknown.note(("start part", ""), message)
        if len(set(targets)) > 1:
            message = f"of the start parts {', '.join(targets)} only the first is read"
            self._unknown.note(("start part", ""), message)
        return part_name(targets[0]) if targets else _DEFAULT_PART

    def _open(self, part: str) -> IO[bytes]:
        name = self._names.get(part.lower())
        if part.lower() in self._twice:
            raise Refused("bad-record", f"the package has two parts {part!r}")
        if name is None:
            raise Refused("missing-resource", f"the package has no part {part!r}")
        return open_part(self._package, name)

    def _model(self, part: str) -> Model:
        model = self._models.get(part)
        if model is None:
            try:
                with self._open(part) as stream:
                    model = read_model(part, stream)
            except UnboundPrefix:
                # Some programs write prefixes without a declaration for their own data.
                with self._open(part) as stream:
                    model = read_model(part, io.BytesIO(with_declared_prefixes(stream.read())))
            self._models[part] = model
            self._refuse_other_unit(part, model)
        return model

    def _refuse_other_unit(self, part: str, model: Model) -> None:
        """Programs disagree whether the unit of the build or that of the part counts."""
        unit = next(iter(self._models.values())).unit
        if model.unit == unit:
            return
        message = f"part {part!r} is in the unit {model.unit}, the build in {unit}: use one"
        for object_ in model.objects.values():
            if object_.corners:
                object_.refusal = Refused("unsupported-feature", message)

    def _object(self, part: str, id_: str) -> Object:
        object_ = self._model(part).objects.get(id_)
        if object_ is None:
            raise Refused("index-out-of-range", f"unknown object id {id_!r} in {part!r}")
        if (part, id_) not in self._used and object_.kind not in TYPES - {"other"}:
            message = (
                f"object {id_!r} of the build has the type {object_.kind!r}, which has no place"
            )
            self._unknown.note(("type", id_), f"{message} there; it is checked as a model")
        self._used.add((part, id_))
        return object_


@dataclass(slots=True)
class Object:
    """coordinates, corners: of vertices and triangles, as written. refusal: the first thing wrong
    with its mesh."""

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

    def leave_out(self, volume: Volume) -> bool:
        """Drop a volume that is no material. False: it is none of this object, or not just one."""
        if volume.triangles is None:
            parts = [each for each in self.references if each.id == volume.part]
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
class Reference:
    """A component or a build item: object `id` of `part`, placed by `matrix` (row-major 4x4)."""

    part: str
    id: str
    matrix: Transform | None


@dataclass(slots=True)
class Model:
    unit: str = _DEFAULT_UNIT
    objects: dict[str, Object] = field(default_factory=dict)
    items: list[Reference] = field(default_factory=list)
    unread: tuple[tuple[str, str], ...] = ()


def read_model(part: str, stream: IO[bytes]) -> Model:
    """Reads the objects of a model part. part: its name in the package.

    Raises Refused. An error in the mesh of one object is stored in this object.
    """
    return _ModelReader(part).read(stream)


def _is_mesh(part: str) -> bool:
    return mesh_reader(posixpath.splitext(part)[1]) is not None


def part_name(target: str) -> str:
    path = unquote(target).replace("\\", "/")
    return posixpath.normpath(posixpath.join("/", path)).lstrip("/")


class _Row(NamedTuple):
    """A vertex or a triangle that is like the last one: its parent, its name and attributes, its
    short name, and where the texts of its numbers go."""

    around: str
    name: str
    keys: list[str]
    short: str
    texts: list[str]


class _ModelReader:
    """Keeps only coordinates, indices and references."""

    def __init__(self, part: str) -> None:
        self._part = part
        self._model = Model()
        self._object: Object | None = None
        self._unknown = UnknownNames()
        self._around: list[str] = []  # the elements that are open
        self._given: set[str] = set()  # elements of the object
        self._usual: set[tuple[str, ...]] = set()  # parent, element and attributes, all known
        self._row: _Row | None = None
        self._parser = guarded_parser(_ENCODINGS)
        self._parser.ordered_attributes = True
        self._prefixes: dict[str | None, str] = {}
        self._ignorable: frozenset[str] = frozenset()
        self._parser.StartElementHandler = self._on_element
        self._parser.EndElementHandler = lambda _: self._around.pop()
        self._parser.StartNamespaceDeclHandler = self._on_namespace
        self._handlers = {
            "model": self._on_model,
            "object": self._on_object,
            "vertex": self._on_vertex,
            "triangle": self._on_triangle,
            "component": self._on_component,
            "item": self._on_item,
        }

    def read(self, stream: IO[bytes]) -> Model:
        parse_stream(self._parser, stream)
        self._model.unread = self._unknown.warnings()
        for id_, object_ in self._model.objects.items():
            if object_.is_empty:
                object_.refusal = Refused("empty-mesh", f"object {id_!r} has no triangles")
        return self._model

    def _fail(self, code: str, message: str) -> Refused:
        line = self._parser.CurrentLineNumber
        return Refused(code, f"{self._part}, line {line}: {message}")

    def _on_namespace(self, prefix: str | None, uri: str) -> None:
        self._prefixes[prefix] = uri

    def _on_element(self, name: str, given: list[str]) -> None:
        """given: names of attributes and their values, in turns."""
        around = self._around[-1] if self._around else ""
        row = self._row
        if row and row.name == name and row.around == around and row.keys == given[::2]:
            self._around.append(row.short)
            row.texts.extend(given[1:6:2])
            return
        attributes = dict(zip(given[::2], given[1::2], strict=True))
        namespace, local = split_name(name)
        if not self._around:
            if namespace not in CORE or local != "model":
                what = f"the outermost element is {short_element(name)}, and no model that is read"
                raise self._fail("unsupported-feature", what)
            self._ignorable = ignorable(attributes, self._prefixes)
        self._look(short_element(name), namespace in self._ignorable, attributes)
        if local in _ONCE and namespace in CORE and self._object:
            if local in self._given:
                twice = Refused("bad-record", f"an object with two <{local}>")
                self._object.refusal = self._object.refusal or twice
            self._given.add(local)
        handler = self._handlers.get(local) if namespace in CORE else None
        if handler is None:
            self._on_other(namespace, local)
            return
        try:
            self._handle(handler, local, attributes)
            if given[:6:2] == _NUMBERS.get(local):
                self._remember(around, name, given[::2])
        except Refused as error:
            if self._object is None or local not in _NUMBERS:
                raise
            self._object.refusal = self._object.refusal or error

    def _remember(self, around: str, name: str, keys: list[str]) -> None:
        """The next elements are like this one, as nearly all of a mesh. keys: its attributes, of
        which the numbers come first."""
        short, object_ = short_element(name), self._current()
        if (around, short, *keys) in self._usual:
            texts = object_.coordinates if short == "vertex" else object_.corners
            self._row = _Row(around, name, keys, short, texts)

    def _look(self, name: str, is_ignorable: bool, attributes: dict[str, str]) -> None:
        """Gather the element, if it is unknown there, and its attributes."""
        around = self._around[-1] if self._around else ""
        self._around.append(name)
        if (around, name, *attributes) in self._usual:
            return  # as nearly all elements of a mesh
        place = f"{self._part}, line {self._parser.CurrentLineNumber}"
        children, own = CHILDREN.get(around), ATTRIBUTES.get(name)
        given = [short(key) for key in attributes if split_name(key)[0] not in self._ignorable]
        if children is not None and not is_ignorable:
            self._unknown.look(children, (name,), f"in {around}", f"{place}: <{around}>")
        elif around and name in ATTRIBUTES:
            message = f"{place}: <{name}> inside of <{around}>, which is not read"
            self._unknown.note((f"in {around}", name), message)
        if own is not None:
            self._unknown.look(own, given, name, f"{place}: <{name}>")
        elif name == "metadata":
            if not self._is_outside:
                self._on_setting(attributes.get("name", ""), place)
            return
        if (children is None or children.knows(name)) and (
            own is None or all(map(own.knows, given))
        ):
            self._usual.add((around, name, *attributes))

    def _on_setting(self, name: str, place: str) -> None:
        key = name.rpartition(":")[2]
        CURA_VOLUMES.refuse_misspelt([key], place)
        if CURA_VOLUMES.knows(key):
            message = f"{place}: {name} is not read; it may make a body none"
            self._unknown.note(("metadata", name), message)

    @property
    def _in_build(self) -> bool:
        return "build" in self._around

    @property
    def _is_outside(self) -> bool:
        """Return whether no object is open, and not the build."""
        return "object" not in self._around and not self._in_build

    def _on_other(self, namespace: str, local: str) -> None:
        """Refuses other elements unless they are known to hold and place no geometry."""
        if self._is_outside:
            return
        if local in _OTHER_GEOMETRY:
            self._refuse(f"<{local}> is not read")
        elif namespace.startswith(UNDECLARED):
            prefix = namespace.removeprefix(UNDECLARED)
            self._refuse(f"<{prefix}:{local}> could be geometry: its prefix is not declared")

    def _refuse(self, message: str) -> None:
        """Refuses the current object, or the whole build."""
        refusal = self._fail("unsupported-feature", message)
        if self._object is None or self._in_build:
            raise refusal
        self._object.refusal = self._object.refusal or refusal

    def _handle(
        self, handler: Callable[[dict[str, str]], None], local: str, attributes: dict[str, str]
    ) -> None:
        try:
            handler(attributes)
        except KeyError as error:
            raise self._fail("bad-record", f"<{local}> lacks {error.args[0]!r}") from None
        except (ValueError, OverflowError) as error:
            raise self._fail("bad-record", f"<{local}>: {error}") from None

    def _on_model(self, attributes: dict[str, str]) -> None:
        self._model.unit = attributes.get("unit", _DEFAULT_UNIT)
        if self._model.unit not in UNITS:
            message = f"the unit is {self._model.unit!r}, none of {', '.join(sorted(UNITS))}"
            raise self._fail("bad-record", message)
        for prefix in attributes.get("requiredextensions", "").split():
            uri = self._prefixes.get(prefix, prefix)
            if PREFIXES.get(uri) not in _REQUIRED:
                raise self._fail("unsupported-feature", f"the model requires extension {uri!r}")

    def _on_object(self, attributes: dict[str, str]) -> None:
        id_ = attributes["id"]
        if id_ in self._model.objects:
            raise self._fail("bad-record", f"object id {id_!r} occurs twice")
        name = tidy_name(attributes.get("name"), tidy_name(f"object{id_}", "object"))
        self._object = self._model.objects[id_] = Object(name, attributes.get("type", "model"))
        for key in attributes:
            if short(key) in FULL and attributes[key] != "fullres":
                what = f"{short(key)}={attributes[key]!r}: the mesh is not the body"
                message = f"{self._part}, line {self._parser.CurrentLineNumber}: <object> {what}"
                self._unknown.note(("resolution", short(key)), message)
        self._given.clear()
        self._row = None

    def _current(self) -> Object:
        if self._object is None:
            raise self._fail("bad-record", "geometry outside of an object")
        return self._object

    def _on_vertex(self, attributes: dict[str, str]) -> None:
        self._current().coordinates += attributes["x"], attributes["y"], attributes["z"]

    def _on_triangle(self, attributes: dict[str, str]) -> None:
        self._current().corners += attributes["v1"], attributes["v2"], attributes["v3"]

    def _on_component(self, attributes: dict[str, str]) -> None:
        self._current().references.append(self._reference(attributes))

    def _on_item(self, attributes: dict[str, str]) -> None:
        self._model.items.append(self._reference(attributes))

    def _reference(self, attributes: dict[str, str]) -> Reference:
        path = next((text for key, text in attributes.items() if short(key) == "p:path"), None)
        part = part_name(path) if path else self._part
        return Reference(part, attributes["objectid"], self._matrix(attributes))

    def _matrix(self, attributes: dict[str, str]) -> Transform | None:
        """3MF writes 4x3 values for row vectors; here they become a 4x4 for column vectors."""
        if "transform" not in attributes:
            return None
        _check_plain(attributes["transform"])
        values = [float(word) for word in attributes["transform"].split()]
        if len(values) != 12 or not all(map(math.isfinite, values)):
            raise self._fail("bad-record", "a transform needs 12 finite numbers")
        rows = [(*values[axis::3],) for axis in range(3)]
        return (*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0)


def _check_plain(numbers: str) -> None:
    """Refuse what Python takes for a number and XML does not: "1_0", digits of other scripts."""
    if "_" in numbers or not numbers.isascii():
        raise ValueError(f"{numbers[:24]!r} is not a number")
