"""3MF core specification 1.3 with the production extension: packages of XML model parts.

Read here and not by trimesh, which inflates every part of the package, merges objects of equal id
from different parts, and skips what it does not find. Only the parts that the build refers to are
opened. An object with a mesh is placed once for each way that leads to it from the build, through
items and components; supports count like any other object.
"""

from __future__ import annotations

import zipfile
from typing import IO

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.placing import instances
from satcheck.scene.loading.raw_mesh import RawNode, RawPart, RawScene
from satcheck.scene.loading.threemf_model import ENCODINGS, Model, Object, part_name, read_model
from satcheck.scene.loading.xml_tree import UnboundPrefix, read_elements
from satcheck.scene.loading.zip_guard import open_part, opened_zip
from satcheck.scene.plain_ids import UniqueNames

_START_PART = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_DEFAULT_PART = "3D/3dmodel.model"


def read_3mf(data: memoryview) -> RawScene:
    """What the build of a 3MF package places; raises MeshFileError without a file name."""
    with opened_zip(data, "a 3MF file") as package:
        return _Package(package).read()


class _Package:
    def __init__(self, package: zipfile.ZipFile) -> None:
        self._package = package
        self._names = {name.lower(): name for name in package.namelist()}
        self._models: dict[str, Model] = {}

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
        with self._open(relationships) as stream:
            root = read_elements(stream, encodings=ENCODINGS)
        targets = [
            element.attributes.get("Target", _DEFAULT_PART)
            for element in root.below()
            if element.tag == "Relationship" and element.attributes.get("Type") == _START_PART
        ]
        return part_name(targets[0]) if targets else _DEFAULT_PART

    def _open(self, part: str) -> IO[bytes]:
        name = self._names.get(part.lower())
        if name is None:
            raise MeshFileError("missing-resource", f"the package has no part {part!r}")
        return open_part(self._package, name)

    def _model(self, part: str) -> Model:
        model = self._models.get(part)
        if model is None:
            try:
                with self._open(part) as stream:
                    model = read_model(part, stream)
            except UnboundPrefix:
                with self._open(part) as stream:
                    model = read_model(part, stream, undeclared_prefixes=True)
            self._models[part] = model
        return model

    def _object(self, part: str, id_: str) -> Object:
        object_ = self._model(part).objects.get(id_)
        if object_ is None:
            raise MeshFileError("index-out-of-range", f"unknown object id {id_!r} in {part!r}")
        return object_
