"""3MF core specification 1.3 with the production extension: packages of XML model parts.

This reader is our own: trimesh inflates every part of the package, merges objects of equal id from
different parts, and skips missing ones. Only the parts that the build refers to are opened. An
object with a mesh is placed once for each path of items and components that leads to it from the
build. Supports count like any other object.
"""

from __future__ import annotations

import fnmatch
import posixpath
import zipfile
from collections import Counter

from msgspec.structs import replace

from satcheck.scene.access import Most
from satcheck.scene.document import Document
from satcheck.scene.errors import Refused
from satcheck.scene.files.placing import instances, raw_scene
from satcheck.scene.files.readers import File, mesh_reader
from satcheck.scene.files.slicer_config import CONFIGS, SIDE_FILES, volumes
from satcheck.scene.files.threemf_model import ENCODINGS, Model, Object, part_name, read_model
from satcheck.scene.files.threemf_vocabulary import RELATIONSHIP, RELATIONSHIPS, TYPES
from satcheck.scene.files.xml_tree import read_elements
from satcheck.scene.files.zip_guard import opened_zip, read_part
from satcheck.scene.vocabulary import UnknownNames
from satcheck.scene.words import listed

_START_PART = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_DEFAULT_PART = "3D/3dmodel.model"


def read_3mf(file: File) -> Document:
    """Return the objects that the build of a 3MF package places. Raises Refused without a
    file name."""
    with opened_zip(memoryview(file.data), "a 3MF file") as package:
        return _Package(package, file.permitted.most).read()


class _Package:
    def __init__(self, package: zipfile.ZipFile, most: Most) -> None:
        self._package = package
        self._most = most
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
        nodes = instances(
            root.items,
            children=lambda key: self._object(*key).references,
            has_mesh=lambda key: self._object(*key).has_mesh,
            name=lambda key: self._object(*key).name,
            kind="object",
        )
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
            for volume in volumes(read_elements(self._content(name)), self._unknown):
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
        root = read_elements(self._content(relationships), encodings=ENCODINGS)
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

    def _content(self, part: str) -> bytes:
        name = self._names.get(part.lower())
        if part.lower() in self._twice:
            raise Refused("bad-record", f"the package has two parts {part!r}")
        if name is None:
            raise Refused("missing-resource", f"the package has no part {part!r}")
        return read_part(self._package, name, self._most)

    def _model(self, part: str) -> Model:
        model = self._models.get(part)
        if model is None:
            model = self._models[part] = read_model(part, self._content(part))
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


def _is_mesh(part: str) -> bool:
    return mesh_reader(posixpath.splitext(part)[1]) is not None
