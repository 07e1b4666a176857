"""What moves the vertices of a COLLADA mesh: skins and morph targets, as the file stores them.

Khronos, "COLLADA 1.4.1 specification" (2008), chapter 4, skin: a vertex lies where its joints put
it, at the sum of weight * joint in the world * inverse bind matrix * bind shape matrix * vertex,
over the sum of weights. The node that holds the skin does not matter.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.collada_nodes import Floats, mirrors, placed, walk, world_of

Shape = Callable[[Floats], Floats]  # vertices as the file has them -> in the world
_NO_JOINT = -1  # in the place of a joint: the bind shape itself


def shaped(
    instance: Any, matrix: Floats, scene: Sequence[tuple[Any, Floats]]
) -> tuple[Any, Shape, bool]:
    """The geometry that an <instance_controller> shapes, how, and whether that mirrors it.

    matrix: of the node around. scene: its nodes, with matrices. Raises MeshFileError.
    """
    from collada.controller import Morph

    controller = instance.controller
    if isinstance(controller, Morph):
        return controller.source_geometry, _morphed(controller, matrix), mirrors(matrix)
    bind = np.asarray(controller.bind_shape_matrix, dtype=np.float64)
    worlds = _joints(instance, scene)
    matrices = {
        name: worlds[name] @ np.asarray(inverse, dtype=np.float64) @ bind
        for name, inverse in controller.joint_matrices.items()
    }
    mirrored = all(map(mirrors, matrices.values()))
    return controller.geometry, _skinned(controller, matrices, bind), mirrored


def _morphed(morph: Any, matrix: Floats) -> Shape:
    targets = [(_positions(target), float(weight)) for target, weight in morph.target_list]
    (element,) = [child for child in morph.xmlnode if child.tag.endswith("}morph")]
    relative = element.get("method") == "RELATIVE"

    def shape(points: Floats) -> Floats:
        total = sum(weight for _, weight in targets)
        result = points if relative else (1.0 - total) * points
        for target, weight in targets:
            if target.shape != points.shape:
                raise MeshFileError(
                    "count-mismatch", "a morph target has another number of vertices"
                )
            result = result + weight * target
        return placed(result, matrix)

    return shape


def _positions(geometry: Any) -> Floats:
    """What <vertices> names; all its groups of polygons share them."""
    for source in geometry.sourceById.values():
        if isinstance(source, dict) and "POSITION" in source:
            return np.asarray(source["POSITION"].data, dtype=np.float64)
    raise MeshFileError("bad-record", f"geometry {geometry.id!r} has no vertices")


def _joints(instance: Any, scene: Sequence[tuple[Any, Floats]]) -> dict[str, Floats]:
    """Where the joints of a skin stand in the world, by the names that the skin gives them.

    These are sids (ids in an <IDREF_array>) below the nodes that the instance calls its skeletons,
    else anywhere in the scene.
    """
    from collada.scene import Node
    from collada.source import IDRefSource

    skin = instance.controller
    source = skin.sourcebyid[skin.joint_source]
    if len(source) > len(skin.joint_matrices):
        raise MeshFileError("duplicate-id", "two joints of a skin have one name")
    attribute = "id" if isinstance(source, IDRefSource) else "sid"
    elements = [child for child in instance.xmlnode if child.tag.endswith("}skeleton")]
    skeletons = {(element.text or "").strip().lstrip("#") for element in elements}
    roots = [(node, matrix) for node, matrix in scene if getattr(node, "id", None) in skeletons]
    worlds: dict[str, Floats] = {}
    for node, matrix in walk(roots) if roots else scene:
        if isinstance(node, Node):
            name = getattr(node, "node", node).xmlnode.get(attribute)  # of an instance, its node
            if name in skin.joint_matrices:
                worlds.setdefault(name, world_of(node, matrix))
    missing = [name for name in skin.joint_matrices if name not in worlds]
    if missing:
        raise MeshFileError("index-out-of-range", f"the scene has no joint {str(missing[0])!r}")
    return worlds


def _skinned(skin: Any, matrices: Mapping[str, Floats], bind: Floats) -> Shape:
    """matrices: of each joint, from the vertices of the file to the world."""
    # The index _NO_JOINT, -1, takes the last matrix.
    of_joint = np.array([*(matrices[name] for name in skin.weight_joints), bind])
    weights = np.asarray(skin.weights.data, dtype=np.float64).ravel()
    counts = np.array([len(influences) for influences in skin.joint_index], dtype=np.int64)
    joints = np.concatenate([*skin.joint_index, np.empty(0)]).astype(np.int64)
    shares = weights[np.concatenate([*skin.weight_index, np.empty(0)]).astype(np.int64)]
    vertices = np.repeat(np.arange(len(counts)), counts)
    if joints.size and joints.min() < _NO_JOINT:
        raise MeshFileError("index-out-of-range", f"joint {joints.min()} of a skin")

    def shape(points: Floats) -> Floats:
        if len(counts) != len(points):
            raise MeshFileError(
                "count-mismatch", f"a skin of {len(counts)} vertices on a mesh of {len(points)}"
            )
        total = np.zeros(len(points))
        np.add.at(total, vertices, shares)
        if not (total > 0.0).all():
            raise MeshFileError("bad-record", "a vertex of a skin has no joint")
        blended = np.zeros((len(points), 4, 4))
        np.add.at(blended, vertices, shares[:, None, None] * of_joint[joints])
        blended /= total[:, None, None]
        turned: Floats = np.einsum("nij,nj->ni", blended[:, :3, :3], points)
        return turned + blended[:, :3, 3]

    return shape
