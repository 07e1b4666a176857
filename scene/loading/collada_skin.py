"""Skins and morph targets, which move the vertices of a COLLADA mesh, as the file stores them.

Khronos, "COLLADA 1.4.1 specification" (2008), chapter 4, skin: the position of a vertex is the sum
of weight * world matrix of the joint * inverse bind matrix * bind shape matrix * vertex, divided by
the sum of weights. The node that holds the skin does not matter.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from satcheck.core.transform import Transform
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.xml_tree import Element

Floats = NDArray[np.float64]

_BIND_SHAPE = -1  # index of the bind shape among the joints


def morphed(morph: Element, points: Floats, target: Callable[[str], Floats | None]) -> Floats:
    """target: the vertices of a geometry by its id. Raises MeshFileError."""
    inputs = _inputs(morph.need("targets"))
    names = _names(_source(morph, inputs, "MORPH_TARGET"))[1]
    weights = _floats(_source(morph, inputs, "MORPH_WEIGHT"))
    if len(names) != len(weights):
        morph.refuse(f"{len(weights)} weights for {len(names)} targets", "count-mismatch")
    relative = morph.attributes.get("method") == "RELATIVE"
    result = points if relative else (1.0 - weights.sum()) * points
    for name, weight in zip(names, weights, strict=True):
        moved = target(name)
        if moved is None:
            morph.refuse(f"no geometry {name!r}, or several", "index-out-of-range")
        if moved.shape != points.shape:
            morph.refuse("a morph target has another number of vertices", "count-mismatch")
        result = result + weight * moved
    return result


def skinned(
    skin: Element, points: Floats, joints_by: Callable[[str, list[str]], dict[str, Transform]]
) -> tuple[Floats, bool]:
    """(the vertices in the world, whether the skin mirrors them). Raises MeshFileError.

    joints_by: an attribute, "sid" or "id", and names -> world matrices of the nodes.
    """
    shape = skin.find("bind_shape_matrix")
    bind = np.eye(4) if shape is None else _matrices(shape, np.array(shape.floats_of_text()))[0]
    inputs = _inputs(skin.need("joints"))
    attribute, names = _names(_source(skin, inputs, "JOINT"))
    source = _source(skin, inputs, "INV_BIND_MATRIX")
    inverses = _matrices(source, _floats(source))
    if len(set(names)) < len(names):
        skin.refuse("two joints of a skin have one name", "duplicate-id")
    if len(names) != len(inverses):
        skin.refuse(f"{len(inverses)} matrices for {len(names)} joints", "count-mismatch")
    joints = joints_by(attribute, names)
    missing = [name for name in names if name not in joints]
    if missing:
        raise MeshFileError("index-out-of-range", f"the scene has no joint {missing[0]!r}")
    matrices = {
        name: np.array(joints[name]).reshape(4, 4) @ inverse @ bind
        for name, inverse in zip(names, inverses, strict=True)
    }
    mirrored = all(np.linalg.det(matrix[:3, :3]) < 0 for matrix in matrices.values())
    return _blended(skin, points, matrices, bind), mirrored


def _blended(skin: Element, points: Floats, matrices: dict[str, Floats], bind: Floats) -> Floats:
    """matrices: of each joint, from the vertices of the file to the world."""
    table = skin.need("vertex_weights")
    inputs = _inputs(table)
    names = _names(_source(skin, inputs, "JOINT"))[1]
    if any(name not in matrices for name in names):
        table.refuse("a joint without a bind matrix", "index-out-of-range")
    of_joint = np.array([*(matrices[name] for name in names), bind])  # index -1 is the last
    weights = _floats(_source(skin, inputs, "WEIGHT"))
    stride = 1 + max(element.integer("offset") for element in inputs.values())
    counts = np.array(table.need("vcount").integers(), np.int64)
    numbers = np.array(table.need("v").integers(least=_BIND_SHAPE), np.int64)
    if len(counts) != len(points):
        raise MeshFileError(
            "count-mismatch", f"a skin of {len(counts)} vertices on a mesh of {len(points)}"
        )
    if counts.sum() * stride != len(numbers):
        table.refuse(f"{len(numbers)} numbers for {counts.sum()} influences", "count-mismatch")
    joints = numbers[inputs["JOINT"].integer("offset") :: stride]
    chosen = numbers[inputs["WEIGHT"].integer("offset") :: stride]
    fits = not len(joints) or (joints.max() < len(names) and chosen.max() < len(weights))
    if not fits or (chosen < 0).any():
        table.refuse("a joint or a weight that does not exist", "index-out-of-range")
    vertices = np.repeat(np.arange(len(counts)), counts)
    total = np.zeros(len(points))
    np.add.at(total, vertices, weights[chosen])
    if not (total > 0.0).all():
        raise MeshFileError("bad-record", "a vertex of a skin has no joint")
    blended = np.zeros((len(points), 4, 4))
    np.add.at(blended, vertices, weights[chosen][:, None, None] * of_joint[joints])
    blended /= total[:, None, None]
    turned: Floats = np.einsum("nij,nj->ni", blended[:, :3, :3], points)
    return turned + blended[:, :3, 3]


def _inputs(element: Element) -> dict[str, Element]:
    return {child.attribute("semantic"): child for child in element.all("input")}


def _source(owner: Element, inputs: dict[str, Element], semantic: str) -> Element:
    if semantic not in inputs:
        owner.refuse(f"no input {semantic}")
    wanted = inputs[semantic].attribute("source").lstrip("#")
    sources = [source for source in owner.all("source") if source.attributes.get("id") == wanted]
    return sources[0] if sources else owner.refuse(f"no source {wanted!r}", "index-out-of-range")


def _floats(source: Element) -> Floats:
    return source.need("float_array").counted_floats()


def _matrices(element: Element, numbers: Floats) -> Floats:
    if numbers.size % 16:
        element.refuse(f"{numbers.size} numbers do not form 4x4 matrices", "count-mismatch")
    return numbers.reshape(-1, 4, 4)


def _names(source: Element) -> tuple[str, list[str]]:
    """(the attribute that the names refer to, the names)."""
    array = source.find("IDREF_array")
    return (
        ("sid", source.need("Name_array").text.split())
        if array is None
        else (
            "id",
            array.text.split(),
        )
    )
