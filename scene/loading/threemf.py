"""3MF core specification 1.3 with the production extension: packages of XML model parts.

Read here and not by trimesh, which inflates every part of the package, merges objects of equal id
from different parts, and skips what it does not find. Only the parts that the build refers to are
opened. An object with a mesh is placed once for each way that leads to it from the build, through
items and components; supports count like any other object.
"""

from __future__ import annotations

import io
import math
import posixpath
import zipfile
import zlib
from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import IO

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits
from satcheck.scene.loading.placing import instances, tidy_name
from satcheck.scene.loading.raw_mesh import Matrix, RawMesh, RawNode, RawPart, RawScene
from satcheck.scene.loading.xml_guard import guarded_parser, parse_stream, split_name
from satcheck.scene.plain_ids import UniqueNames

_CORE = frozenset(
    {
        "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
        "http://schemas.microsoft.com/3dmanufacturing/2013/01",
    }
)
_PRODUCTION_PATH = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06 path"
# Extensions a model may require and that leave its triangles as they are.
_HARMLESS = ("/production/", "/material/", "/slice/", "/trianglesets/")
_START_PART = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_DEFAULT_PART = "3D/3dmodel.model"
_ENCODINGS = frozenset({"utf-8", "utf-16"})
_DEFAULT_UNIT = "millimeter"
_MESH = frozenset({"vertex", "triangle"})  # what is wrong with them concerns their object alone


@dataclass(slots=True)
class _Object:
    """decimals, significant: as in RawMesh. refusal: the first thing wrong with its mesh."""

    name: str
    vertices: array[float] = field(default_factory=lambda: array("d"))
    triangles: array[int] = field(default_factory=lambda: array("I"))
    references: list[_Reference] = field(default_factory=list)
    decimals: int = 0
    significant: int = 0
    refusal: MeshFileError | None = None

    @property
    def has_mesh(self) -> bool:
        return self.refusal is not None or bool(self.triangles)

    def mesh(self, unit: str) -> RawMesh | MeshFileError:
        if self.refusal is not None:
            return self.refusal
        return RawMesh(
            vertices=self.vertices.tobytes(),
            triangles=self.triangles.tobytes(),
            precision="written-digits",
            decimals=self.decimals,
            significant=self.significant,
            units=unit,
        )


@dataclass(slots=True)
class _Reference:
    """A component or a build item: object `id` of `part`, placed by `matrix` (row-major 4x4)."""

    part: str
    id: str
    matrix: Matrix | None


@dataclass(slots=True)
class _Model:
    unit: str = _DEFAULT_UNIT
    objects: dict[str, _Object] = field(default_factory=dict)
    items: list[_Reference] = field(default_factory=list)


def read_3mf(data: memoryview) -> RawScene:
    """What the build of a 3MF package places; raises MeshFileError without a file name."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as package:
            return _Package(package).read()
    except zipfile.BadZipFile as error:
        raise MeshFileError("not-this-format", f"not a 3MF file: {error}") from None
    except (zlib.error, EOFError) as error:
        raise MeshFileError("bad-record", f"damaged zip data: {error}") from None
    except (RuntimeError, NotImplementedError) as error:  # encrypted, or an unknown compression
        raise MeshFileError("unsupported-feature", f"zip: {error}") from None


class _Package:
    def __init__(self, package: zipfile.ZipFile) -> None:
        self._package = package
        self._names = {name.lower(): name for name in package.namelist()}
        self._models: dict[str, _Model] = {}

    def read(self) -> RawScene:
        start = self._start_part()
        root = self._model(start)
        if not root.items:
            raise MeshFileError("empty-mesh", "empty mesh: the build has no items")
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
            raise MeshFileError("empty-mesh", "empty mesh: the build has no triangles")
        used = {key: place for place, key in enumerate(dict.fromkeys(node.key for node in nodes))}
        names = UniqueNames()
        return RawScene(
            parts=tuple(
                RawPart(names.unique(object_.name), object_.mesh(root.unit))
                for object_ in (self._object(*key) for key in used)
            ),
            nodes=tuple(RawNode(node.path, used[node.key], node.matrix) for node in nodes),
        )

    def _start_part(self) -> str:
        relationships = self._names.get("_rels/.rels")
        if relationships is None:
            return _DEFAULT_PART
        targets: list[str] = []

        def start(name: str, attributes: dict[str, str]) -> None:
            if split_name(name)[1] == "Relationship" and attributes.get("Type") == _START_PART:
                targets.append(attributes.get("Target", _DEFAULT_PART))

        parser = guarded_parser(_ENCODINGS)
        parser.StartElementHandler = start
        with self._open(relationships) as stream:
            parse_stream(parser, stream)
        return _part_name(targets[0]) if targets else _DEFAULT_PART

    def _open(self, part: str) -> IO[bytes]:
        name = self._names.get(part.lower())
        if name is None:
            raise MeshFileError("missing-resource", f"the package has no part {part!r}")
        entry = self._package.getinfo(name)
        inflation = entry.file_size / max(entry.compress_size, 1)
        if entry.file_size > limits.MAX_PART_BYTES or (
            entry.file_size > limits.SMALL_PART_BYTES and inflation > limits.MAX_INFLATION
        ):
            raise MeshFileError(
                "too-large",
                f"part {part!r} unpacks {inflation:.0f}:1 to {entry.file_size} bytes",
            )
        return self._package.open(entry)

    def _model(self, part: str) -> _Model:
        model = self._models.get(part)
        if model is None:
            with self._open(part) as stream:
                model = self._models[part] = _ModelReader(part).read(stream)
        return model

    def _object(self, part: str, id_: str) -> _Object:
        object_ = self._model(part).objects.get(id_)
        if object_ is None:
            raise MeshFileError("index-out-of-range", f"unknown object id {id_!r} in {part!r}")
        return object_


def _part_name(target: str) -> str:
    return posixpath.normpath(posixpath.join("/", target)).lstrip("/")


class _ModelReader:
    """One model part, event by event: nothing but coordinates and indices is kept."""

    def __init__(self, part: str) -> None:
        self._part = part
        self._model = _Model()
        self._object: _Object | None = None
        self._parser = guarded_parser(_ENCODINGS)
        self._prefixes: dict[str | None, str] = {}
        self._handlers = {
            "model": self._on_model,
            "object": self._on_object,
            "vertex": self._on_vertex,
            "triangle": self._on_triangle,
            "component": self._on_component,
            "item": self._on_item,
        }

    def read(self, stream: IO[bytes]) -> _Model:
        self._parser.StartElementHandler = self._on_element
        self._parser.StartNamespaceDeclHandler = self._on_namespace
        parse_stream(self._parser, stream)
        for id_, object_ in self._model.objects.items():
            count = len(object_.vertices) // 3
            if object_.refusal is None and max(object_.triangles, default=-1) >= count:
                object_.refusal = MeshFileError(
                    "index-out-of-range",
                    f"object {id_!r}: face index out of range: "
                    f"{max(object_.triangles)} of {count} vertices",
                )
        return self._model

    def _fail(self, code: str, message: str) -> MeshFileError:
        line = self._parser.CurrentLineNumber
        return MeshFileError(code, f"{self._part}, line {line}: {message}")

    def _on_namespace(self, prefix: str | None, uri: str) -> None:
        self._prefixes[prefix] = uri

    def _on_element(self, name: str, attributes: dict[str, str]) -> None:
        namespace, local = split_name(name)
        handler = self._handlers.get(local)
        if handler is None or namespace not in _CORE:
            return
        try:
            self._handle(handler, local, attributes)
        except MeshFileError as error:
            if self._object is None or local not in _MESH:
                raise
            self._object.refusal = self._object.refusal or error

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
        for prefix in attributes.get("requiredextensions", "").split():
            uri = self._prefixes.get(prefix, prefix)
            if not any(part in uri for part in _HARMLESS):
                raise self._fail("unsupported-feature", f"the model requires extension {uri!r}")

    def _on_object(self, attributes: dict[str, str]) -> None:
        id_ = attributes["id"]
        if id_ in self._model.objects:
            raise self._fail("bad-record", f"object id {id_!r} occurs twice")
        name = tidy_name(attributes.get("name"), tidy_name(f"object{id_}", "object"))
        self._object = self._model.objects[id_] = _Object(name)

    def _current(self) -> _Object:
        if self._object is None:
            raise self._fail("bad-record", "geometry outside of an object")
        return self._object

    def _on_vertex(self, attributes: dict[str, str]) -> None:
        object_ = self._current()
        for axis in ("x", "y", "z"):
            text = attributes[axis]
            value = float(text)
            if not math.isfinite(value):
                raise self._fail("non-finite", f"non-finite coordinate {text[:24]!r}")
            object_.vertices.append(value)
            _note_digits(object_, text)

    def _on_triangle(self, attributes: dict[str, str]) -> None:
        triangles = self._current().triangles
        triangles.extend((int(attributes["v1"]), int(attributes["v2"]), int(attributes["v3"])))

    def _on_component(self, attributes: dict[str, str]) -> None:
        self._current().references.append(self._reference(attributes))

    def _on_item(self, attributes: dict[str, str]) -> None:
        self._model.items.append(self._reference(attributes))

    def _reference(self, attributes: dict[str, str]) -> _Reference:
        path = attributes.get(_PRODUCTION_PATH)
        part = _part_name(path) if path else self._part
        return _Reference(part, attributes["objectid"], self._matrix(attributes))

    def _matrix(self, attributes: dict[str, str]) -> Matrix | None:
        """3MF writes 4x3 values for row vectors; here they become a 4x4 for column vectors."""
        if "transform" not in attributes:
            return None
        values = [float(word) for word in attributes["transform"].split()]
        if len(values) != 12 or not all(map(math.isfinite, values)):
            raise self._fail("bad-record", "a transform needs 12 finite numbers")
        rows = [(*values[axis::3],) for axis in range(3)]
        return (*rows[0], *rows[1], *rows[2], 0.0, 0.0, 0.0, 1.0)


def _note_digits(object_: _Object, text: str) -> None:
    mantissa, exponent, _ = text.lower().partition("e")
    if exponent:
        digits = len(mantissa.lstrip("+-0.").replace(".", ""))
        object_.significant = max(object_.significant, digits)
    else:
        decimals = len(mantissa.rstrip().partition(".")[2])
        object_.decimals = max(object_.decimals, decimals)
