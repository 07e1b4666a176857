"""The nodes of a glTF document: their tree, their names, and where they stand."""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NoReturn

from satcheck.core.transform import Transform, placed, quaternion_matrix
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.errors import Refused
from satcheck.scene.files.gltf_buffers import Work, integer, items, member
from satcheck.scene.files.placing import Instance, instances, multiply, tidy_name
from satcheck.scene.words import listed, why_unreadable

_VERSION = "2.0"


def parse_document(data: memoryview) -> dict[str, Any]:
    """The JSON of a glTF file. Raises Refused."""
    try:
        text = str(data, "utf-8").removeprefix("\ufeff")
    except UnicodeDecodeError:
        raise Refused("bad-encoding", "the JSON is not UTF-8") from None
    document = _json(text)
    if not isinstance(document, dict) or not isinstance(document.get("asset"), dict):
        raise Refused("not-this-format", "not a glTF file: no asset object")
    version = document["asset"].get("version")
    if not isinstance(version, str) or not version.startswith("2."):
        raise Refused("unsupported-feature", f"glTF version {version!r}: 2.x is read")
    least = document["asset"].get("minVersion", _VERSION)
    if least != _VERSION:
        message = f"the file needs glTF version {least!r}: {_VERSION} is read"
        raise Refused("unsupported-feature", message)
    return document


def _json(text: str) -> Any:
    def refuse(token: str) -> NoReturn:
        raise Refused("bad-record", f"JSON: {token} is not a number of glTF")

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        values = dict(pairs)
        if len(values) < len(pairs):
            twice = next(key for key, count in Counter(k for k, _ in pairs).items() if count > 1)
            raise Refused("bad-record", f"JSON: the key {twice!r} occurs twice in one object")
        return values

    try:
        return json.loads(text, parse_constant=refuse, object_pairs_hook=once)
    except json.JSONDecodeError as error:
        raise Refused(
            "bad-record", f"line {error.lineno}: not well-formed JSON: {error.msg}"
        ) from None
    except RecursionError:
        raise Refused("bad-record", "the JSON is nested too deeply") from None
    except ValueError as error:
        raise Refused("bad-record", f"JSON: {why_unreadable(error)}") from None


class NodeGraph:
    """The nodes of the default scene of a document. Its methods raise Refused."""

    def __init__(self, document: dict[str, Any], work: Work) -> None:
        self._document = document
        self._work = work
        self._nodes = items(document, "nodes")
        self._meshes = items(document, "meshes")
        self._parents: dict[int, int] | None = None

    def drawn(self) -> list[Instance[int]]:
        """The nodes with a mesh, by their numbers, with world matrix and path."""
        return self.placed(lambda node: self.mesh_of(node) >= 0)

    def placed(self, chosen: Callable[[int], bool]) -> list[Instance[int]]:
        """The chosen nodes of the scene, as in `drawn`."""
        return instances(
            [(root, self.matrix(root)) for root in self.roots()],
            children=self.children,
            has_mesh=chosen,
            name=self._name,
            kind="node",
        )

    def world(self, node: int) -> Transform | None:
        """The world matrix of a node; None: the identity."""
        matrix = self.matrix(node)
        for parent in self._above(node):
            self._work.spend(len(IDENTITY))
            matrix = multiply(self.matrix(parent), matrix)
        return matrix

    def nearest(self, node: int, chosen: Callable[[int], bool]) -> int | None:
        """The first chosen node from a node upwards; None: there is none."""
        return next(filter(chosen, (node, *self._above(node))), None)

    def _above(self, node: int) -> Iterator[int]:
        """The nodes around a node, from the inside."""
        if self._parents is None:
            self._parents = {
                child: parent
                for parent in range(len(self._nodes))
                for child, _ in self.children(parent)
            }
        seen = {node}
        while (parent := self._parents.get(node)) is not None:
            if parent in seen:
                raise Refused("reference-cycle", f"node {parent} contains itself: a cycle")
            seen.add(parent)
            yield parent
            node = parent

    def unclear_scene(self) -> bool:
        """Say whether the file does not tell which of its scenes counts."""
        return "scene" not in self._document and len(items(self._document, "scenes")) > 1

    def left_out(self) -> str:
        """Name the nodes with a mesh that the scene lacks, and count meshes without a node."""
        drawn, waiting = set(), self.roots()
        while waiting:
            node = waiting.pop()
            if node not in drawn:
                drawn.add(node)
                waiting += [child for child, _ in self.children(node)]
        meshes = {
            number: node["mesh"]
            for number, node in enumerate(self._nodes)
            if isinstance(node, dict) and type(node.get("mesh")) is int
        }
        used = set(meshes.values())
        lost = [f"node {number}" for number in meshes if number not in drawn]
        unused = [f"mesh {number}" for number in range(len(self._meshes)) if number not in used]
        said = [f"{listed(lost)} outside of the scene"] if lost else []
        said += [f"{listed(unused)} without a node"] if unused else []
        return "; ".join(said)

    def roots(self) -> list[int]:
        """Of the default scene; without scenes, the nodes that are no children."""
        scenes = items(self._document, "scenes")
        if scenes:
            chosen = member(scenes, integer(self._document, "scene", 0), "scene")
            return [self.number(number) for number in items(chosen, "nodes")]
        placed = {child for node in range(len(self._nodes)) for child, _ in self.children(node)}
        roots = [node for node in range(len(self._nodes)) if node not in placed]
        if self._nodes and not roots:
            raise Refused("reference-cycle", "every node is a child of another: a cycle")
        return roots

    def number(self, number: object) -> int:
        """The number of a node that exists."""
        if type(number) is not int:
            raise Refused("bad-record", f"node {number!r} is not a number")
        member(self._nodes, number, "node")
        return number

    def children(self, node: int) -> list[tuple[int, Transform | None]]:
        """Each with its placement in the node."""
        numbers = items(member(self._nodes, node, "node"), "children")
        return [(child := self.number(n), self.matrix(child)) for n in numbers]

    def _name(self, number: int) -> str:
        """The name of a node, else of its mesh, else its number."""
        name = tidy_name(self._nodes[number].get("name"), "")
        mesh = self.mesh_of(number)
        if not name and mesh >= 0:
            name = tidy_name(member(self._meshes, mesh, "mesh").get("name"), "")
        return name or f"node{number}"

    def matrix(self, number: int) -> Transform | None:
        return placement_of(member(self._nodes, number, "node"), number)

    def mesh_of(self, number: int) -> int:
        """The number of a node's mesh, -1 for none."""
        mesh = integer(member(self._nodes, number, "node"), "mesh", -1)
        if mesh >= 0:
            member(self._meshes, mesh, "mesh")
        return mesh


def placement_of(node: dict[str, Any], number: int) -> Transform | None:
    """The placement of a node in its parent; None: the identity."""
    if "matrix" in node:
        return _from_columns(_numbers(node, "matrix", 16, number), f"node {number}")
    translation, rotation, scale = (
        _numbers(node, key, count, number) if key in node else None
        for key, count in (("translation", 3), ("rotation", 4), ("scale", 3))
    )
    return trs_placement(translation, rotation, scale)


def _numbers(node: dict[str, Any], key: str, count: int, number: int) -> list[float]:
    values = items(node, key)
    good = len(values) == count and all(
        type(value) in (int, float) and abs(value) <= sys.float_info.max for value in values
    )
    if not good:
        raise Refused("bad-record", f"node {number}: {key} needs {count} finite numbers")
    return [float(value) for value in values]


def _from_columns(columns: Sequence[float], where: str) -> Transform:
    if tuple(columns[3:16:4]) != (0.0, 0.0, 0.0, 1.0):
        raise Refused("bad-record", f"{where}: the matrix is not affine")
    return tuple(columns[4 * column + row] for row in range(4) for column in range(4))


def trs_placement(
    translation: Sequence[float] | None,
    rotation: Sequence[float] | None,
    scale: Sequence[float] | None,
) -> Transform | None:
    """Scales, then rotates by a quaternion x, y, z, w, then translates."""
    placement: Transform | None = None
    if translation is not None:
        x, y, z = translation
        placement = (1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1)
    if rotation is not None:
        placement = multiply(placement, _rotation(rotation))
    if scale is not None:
        x, y, z = scale
        placement = multiply(placement, (x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1))
    return placement


def _rotation(quaternion: Sequence[float]) -> Transform:
    if not any(quaternion):
        raise Refused("bad-record", "a rotation quaternion is zero")
    x, y, z, w = quaternion
    return placed(quaternion_matrix(x, y, z, w), (0.0, 0.0, 0.0))
