"""XAML: the triangles of a WPF 3-D scene, as SolidWorks writes it.

Microsoft, "System.Windows.Media.Media3D": MeshGeometry3D, Transform3D. This reader is our own:
trimesh applies only MatrixTransform3D and ignores other transforms. XAML states no unit. Data
bindings, resources and other namespaces are refused, because their content is unknown.
"""

from __future__ import annotations

import math

from satcheck.core.transform import Transform, about, compose, cos_sin, placed, quaternion_matrix
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.flatten import concatenate
from satcheck.scene.loading.raw_mesh import RawMesh
from satcheck.scene.loading.written_mesh import WrittenMesh
from satcheck.scene.loading.xml_tree import Element, read_elements

_PRESENTATION = "http://schemas.microsoft.com/winfx/2006/xaml/presentation"
_GEOMETRY = "GeometryModel3D.Geometry"
_IDENTITY: Transform = (1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0)
_NO_TURN = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)


def read_xaml(data: memoryview) -> RawMesh:
    """All meshes of the scene, flattened; raises MeshFileError without a file name."""
    root = read_elements(data)
    meshes: list[tuple[WrittenMesh, Transform]] = []
    waiting = [(root, _IDENTITY)]
    while waiting:
        element, matrix = waiting.pop()
        _refuse_foreign(element)
        inside = compose(matrix, _transform_of(element))
        for child in reversed(element.children):
            if child.tag == "MeshGeometry3D":
                if element.tag != _GEOMETRY:
                    child.refuse("a mesh that no model shows is not read", "unsupported-feature")
                meshes.append((_mesh(child), inside))
            elif child.tag != f"{element.tag}.Transform":
                waiting.append((child, inside))
    if not meshes:
        raise MeshFileError("empty-mesh", "empty mesh: the scene has no triangles")
    return _flattened(meshes)


def _flattened(meshes: list[tuple[WrittenMesh, Transform]]) -> RawMesh:
    raws = [(mesh.raw(None), matrix) for mesh, matrix in meshes]
    vertices, triangles = concatenate(
        [
            (raw.vertices, raw.triangles, None if matrix == _IDENTITY else matrix)
            for raw, matrix in raws
        ]
    )
    return RawMesh(
        vertices=vertices,
        triangles=triangles,
        number_format="written-digits",
        decimals=max(raw.decimals for raw, _ in raws),
        significant=max(raw.significant for raw, _ in raws),
    )


def _refuse_foreign(element: Element) -> None:
    """Refuses models of other kinds, and values that come from bindings or resources."""
    if element.namespace != _PRESENTATION:
        element.refuse("is not an element of WPF: it could be geometry", "unsupported-feature")
    if element.tag.endswith(".Resources") and any(
        inside.tag.endswith("3D") for inside in element.below()
    ):
        element.refuse("geometry in resources is not read", "unsupported-feature")
    for name in ("Geometry", "Content", "Children"):
        if element.tag.endswith("3D") and name in element.attributes:
            element.refuse(
                f"{name}={element.attributes[name]!r} is not read", "unsupported-feature"
            )


def _mesh(element: Element) -> WrittenMesh:
    """Without TriangleIndices, every three positions form a triangle."""
    words = element.words(element.attribute("Positions"), 3)
    count = len(words) // 3
    indices = element.attributes.get("TriangleIndices", "")
    corners = element.indices(indices, count, 3) if indices.split() else list(range(count))
    if len(corners) % 3:
        element.refuse(f"{count} positions do not form whole triangles")
    if not corners:
        element.refuse("a mesh without triangles", "empty-mesh")
    mesh = WrittenMesh()
    mesh.add(words, element.floats(words), corners)
    return mesh


def _transform_of(element: Element) -> Transform:
    if not element.tag.endswith(("3D", "3DGroup")):
        return _IDENTITY
    given = element.attributes.get("Transform")
    if given is not None:
        return _matrix(element, given)
    inside = element.find(f"{element.tag}.Transform")
    if inside is None:
        return _IDENTITY
    if len(inside.children) != 1:
        inside.refuse(f"{len(inside.children)} transforms, not one")
    return _transform(inside.children[0])


def _transform(element: Element) -> Transform:
    match element.tag:
        case "MatrixTransform3D":
            return _matrix(element, element.attributes.get("Matrix", "Identity"))
        case "TranslateTransform3D":
            return placed(_NO_TURN, [_number(element, f"Offset{axis}") for axis in "XYZ"])
        case "ScaleTransform3D":
            x, y, z = (_number(element, f"Scale{axis}", 1.0) for axis in "XYZ")
            return _about_centre(element, (x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z))
        case "RotateTransform3D":
            return _about_centre(element, _rotation(element))
        case "Transform3DGroup":
            return _group(element)
    return element.refuse("a transform that is not read", "unsupported-feature")


def _group(element: Element) -> Transform:
    """Applies its transforms in the order of the file."""
    matrix = _IDENTITY
    holders = element.all("Transform3DGroup.Children") or [element]
    for holder in holders:
        for child in holder.children:
            matrix = compose(_transform(child), matrix)
    return matrix


def _matrix(element: Element, text: str) -> Transform:
    """WPF writes matrices for row vectors."""
    if text.strip() == "Identity":
        return _IDENTITY
    values = element.floats(element.words(text, 16))
    if len(values) != 16 or values[3::4] != [0.0, 0.0, 0.0, 1.0]:
        element.refuse("the matrix should be 16 numbers and affine", "singular-transform")
    return tuple(value for column in range(4) for value in values[column::4])


def _about_centre(element: Element, linear: tuple[float, ...]) -> Transform:
    centre = [_number(element, f"Center{axis}") for axis in "XYZ"]
    back = placed(_NO_TURN, [-c for c in centre])
    return compose(placed(_NO_TURN, centre), compose(placed(linear, (0.0, 0.0, 0.0)), back))


def _rotation(element: Element) -> tuple[float, ...]:
    holder = element.find("RotateTransform3D.Rotation")
    turn = holder.children[0] if holder and len(holder.children) == 1 else None
    if turn is not None and turn.tag == "AxisAngleRotation3D":
        x, y, z = _numbers(turn, "Axis", (0.0, 1.0, 0.0))
        length = math.hypot(x, y, z)
        if not length > 0.0:
            turn.refuse("an axis of length 0")
        return about((x / length, y / length, z / length), cos_sin(_number(turn, "Angle")))
    if turn is not None and turn.tag == "QuaternionRotation3D":
        x, y, z, w = _numbers(turn, "Quaternion", (0.0, 0.0, 0.0, 1.0))
        if math.hypot(x, y, z, w) == 0.0:
            turn.refuse("a quaternion of length 0")
        return quaternion_matrix(x, y, z, w)
    if element.children or "Rotation" in element.attributes:
        element.refuse("a rotation that is not read", "unsupported-feature")
    return _NO_TURN


def _number(element: Element, name: str, default: float = 0.0) -> float:
    return _numbers(element, name, (default,))[0]


def _numbers(element: Element, name: str, default: tuple[float, ...]) -> tuple[float, ...]:
    if f"{element.tag}.{name}" in (child.tag for child in element.children):
        element.refuse(f"{name} as an element is not read", "unsupported-feature")
    if name not in element.attributes:
        return default
    values = element.floats(element.words(element.attributes[name], 1))
    if len(values) != len(default):
        element.refuse(f"{name} should be {len(default)} numbers")
    return tuple(values)
