"""The bodies of a STEP file: the products of its assemblies, as OpenCascade makes facets of them.

cascadio writes a glTF document: a node for each occurrence of a product, in metres, with the axes
of the STEP file. Its meshes are read like those of any glTF file.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from msgspec import Struct, field
from msgspec.structs import replace

from satcheck.core.transform import Transform
from satcheck.plugins.step.exchange import Exchange, read_exchange
from satcheck.scene.access import NOTHING_ELSE, Context
from satcheck.scene.document import Document, RawMesh, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf import GltfScene
from satcheck.scene.files.gltf_buffers import Accessors, Work, split_glb
from satcheck.scene.files.gltf_document import NONE, Count, GltfDocument, Primitive
from satcheck.scene.files.gltf_meshes import NO_TRIANGLES, Shape
from satcheck.scene.files.placing import Instance, raw_scene, tidy_name
from satcheck.scene.files.readers import File, imported
from satcheck.scene.words import listed

_MILLIMETRES = 1000.0  # in the metre of glTF
_FACES = "TM_brep_faces"  # the extension in which cascadio says what the faces of a solid are
# Names that programs make up: of SolidWorks, and of OpenCascade.
_MADE_UP = re.compile(r"NAUO\d+|=>\[[\d:]*\]|")


class _Face(Struct, frozen=True):
    type: str | None = None
    face_index: Count = NONE


class _Faces(Struct, frozen=True):
    face_indices: Count = field(name="faceIndices")
    faces: tuple[_Face | None, ...] = ()


class _Part(Struct, frozen=True):
    """mesh: its number in the glTF document; None: the file has no surface for it."""

    name: str
    mesh: int | None


def read_step(file: File) -> Document:
    """Return a body for each occurrence of a product that has surfaces, in millimetres.

    Raises Refused without a file name.
    """
    data, options = bytes(file.data), file.options
    exchange = read_exchange(data)
    glb = _tessellated(data, options)
    text, chunk = split_glb(memoryview(glb))
    try:
        document = GltfDocument(json.loads(str(text, "utf-8")))
    except ValueError:  # it writes numbers that are not finite as they are
        message = "OpenCascade turns it into coordinates that are infinite or no numbers"
        raise Refused("non-finite", message) from None
    return _Assembly(document, chunk, exchange, options).read()


def _tessellated(data: bytes, options: Mapping[str, Any]) -> bytes:
    """The glTF document that OpenCascade makes of the file. One thread: the same facets in every
    run."""
    glb: bytes = imported("cascadio", "step", "STEP files").load(
        data,
        tol_linear=options["chord_tolerance"],
        tol_angular=options["angular_tolerance"],
        use_parallel=False,
        include_brep=True,
    )
    if not glb:
        raise Refused("bad-record", "OpenCascade finds no product in the file")
    return glb


class _Assembly(GltfScene):
    kind = "product"

    def __init__(
        self,
        document: GltfDocument,
        chunk: memoryview | None,
        exchange: Exchange,
        options: Mapping[str, Any],
    ) -> None:
        work = Work(isolated=True)
        context = Context("", NOTHING_ELSE)
        super().__init__(document, Accessors(document, chunk, context, work))
        self._primitives = [mesh.primitives for mesh in document.meshes]
        self._exchange = exchange
        self._options = options

    def read(self) -> Document:
        nodes = self.placed(
            lambda node: self.nodes[node].mesh != NONE or not self.nodes[node].children
        )
        curves = [node.path for node in nodes if self._is_curves(node.key)]
        placed = [
            Instance(self._part(node.key), node.matrix, node.path)
            for node in nodes
            if not self._is_curves(node.key)
        ]
        if all(part.key.mesh is None for part in placed):
            names = [part.key.name for part in placed]
            if names and self._exchange.documents:
                refusal = self._missing(names[0])
                raise Refused(refusal.code, refusal.message)
            what = "curves alone" if curves else f"products without a shape: {listed(names)}"
            message = "; ".join((f"empty mesh: the file has {what}", *self._exchange.unread))
            raise Refused("empty-mesh", message)
        scene = raw_scene(placed, lambda part: part.name, self._mesh_of)
        lost = self._lost_faces(part.key for part in placed)
        return replace(scene, warnings=tuple(self._warnings(scene, curves, lost)))

    def matrix(self, number: int) -> Transform | None:
        """The placement in millimetres. Coordinates in the document are of float32."""
        matrix = super().matrix(number)
        if matrix is None:
            return None
        x, y, z = _millimetres(np.array(matrix[3:12:4])).tolist()
        return (*matrix[:3], x, *matrix[4:7], y, *matrix[8:11], z, *matrix[12:])

    def name(self, number: int) -> str:
        """The name of the occurrence, else of the product."""
        node = self.nodes[number]
        name = tidy_name(node.name, "")
        if name not in self._exchange.products and not _MADE_UP.fullmatch(name):
            return name
        named = None if node.mesh == NONE else self.document.meshes.name(node.mesh)
        return tidy_name(named or self._exchange.products.get(name), name or f"product{number}")

    def _is_curves(self, node: int) -> bool:
        mesh = self.nodes[node].mesh
        if mesh == NONE:
            return False
        return all(primitive.mode in NO_TRIANGLES for primitive in self._primitives[mesh])

    def _part(self, node: int) -> _Part:
        """Occurrences of one product have meshes of their own, with the same primitives."""
        mesh = self.nodes[node].mesh
        if mesh == NONE:
            return _Part(self.name(node), None)
        return _Part(
            tidy_name(self.document.meshes.name(mesh), f"mesh{mesh}"),
            self._primitives.index(self._primitives[mesh]),
        )

    def _mesh_of(self, part: _Part) -> RawMesh | Refusal:
        if part.mesh is None:
            return self._missing(part.name)
        raw = self.mesh(Shape(part.mesh))
        if isinstance(raw, Refusal):
            return raw
        vertices = _millimetres(np.frombuffer(raw.vertices))
        flat = not self._exchange.is_curved or all(map(self._is_flat, self._primitives[part.mesh]))
        return replace(
            raw,
            vertices=vertices.tobytes(),
            units="mm",
            surface_tolerance=0.0 if flat else self._options["chord_tolerance"],
        )

    def _missing(self, name: str) -> Refusal:
        documents = self._exchange.documents
        if documents:
            files = listed([repr(each) for each in documents])
            return Refusal(
                "missing-resource",
                f"its shape is in another file, which is not read: the file names {files}. Write "
                "the assembly into one STEP file",
            )
        return Refusal("no-surface", f"the file has no surface for the product {name!r}")

    def _is_flat(self, primitive: Primitive) -> bool:
        """Whether all faces are planes, of which facets are exact."""
        faces = primitive.extension(_FACES, _Faces, "a primitive")
        if faces is None:
            return False
        planes = {
            face.face_index for face in faces.faces if face is not None and face.type == "plane"
        }
        used, _ = self.accessors.indices(faces.face_indices)
        return planes.issuperset(used)

    def _warnings(
        self, scene: Document, curves: list[str], lost: str | None
    ) -> Iterator[tuple[str, str]]:
        if not self._exchange.has_unit:
            message = "the file states no unit of length: its numbers count as millimetres"
            yield "assumed-units", message
        if curves:
            words = f"{len(curves)} products of curves alone have no body: {listed(curves)}"
            yield "ignored-geometry", words
        for message in (*self._exchange.unread, *filter(None, [lost])):
            yield "unread", message
        meshes = [part.mesh for part in scene.parts if isinstance(part.mesh, RawMesh)]
        faceted = sum(mesh.surface_tolerance > 0 for mesh in meshes)
        if faceted:
            message = (
                f"{faceted} of {len(scene.parts)} products have curved faces: their facets are off "
                f"by up to about {self._options['chord_tolerance']:g} mm (--read chord-tolerance)"
            )
            yield "faceted", message

    def _lost_faces(self, parts: Iterable[_Part]) -> str | None:
        """Words about faces that the file has and the bodies lack; None: there are none, or
        cascadio states the faces only of a part of them."""
        used = {part.mesh for part in parts if part.mesh is not None}
        faces = [
            each.extension(_FACES, _Faces, "a primitive")
            for mesh in used
            for each in self._primitives[mesh]
        ]
        known = [each.faces for each in faces if each is not None]
        read, wanted = sum(map(len, known)), self._exchange.faces
        if len(known) < len(faces) or read >= wanted:
            return None
        return f"OpenCascade reads {read} of the {wanted} faces of the file; bodies may be missing"


def _millimetres(metres: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """float32 numbers in metres as float32 numbers in millimetres, held as float64."""
    return (metres * _MILLIMETRES).astype(np.float32).astype(np.float64)
