"""XAML: meshes of a WPF scene, every transform, and what could be geometry and is not read."""

from __future__ import annotations

import pytest

from tests.scene import files
from tests.scene.loading import loaded, refusal

POSITIONS = " ".join("{},{},{}".format(*point) for point in files.CUBE_POINTS)
INDICES = " ".join(str(i) for face in files.CUBE for i in face)
MESH = f'<MeshGeometry3D Positions="{POSITIONS}" TriangleIndices="{INDICES}"/>'
HELIX = 'xmlns:h="http://helix-toolkit.org/wpf"'


def model(mesh: str = MESH, transform: str = "") -> str:
    moved = f"<GeometryModel3D.Transform>{transform}</GeometryModel3D.Transform>"
    return (
        f"<GeometryModel3D><GeometryModel3D.Geometry>{mesh}</GeometryModel3D.Geometry>"
        f"{moved if transform else ''}</GeometryModel3D>"
    )


def xaml(content: str, transform: str = "", attributes: str = "") -> bytes:
    moved = f"<ModelVisual3D.Transform>{transform}</ModelVisual3D.Transform>"
    return (
        '<Viewport3D xmlns="http://schemas.microsoft.com/winfx/2006/xaml/presentation">'
        f"<ModelVisual3D{attributes}>{moved if transform else ''}<ModelVisual3D.Content>"
        f"{content}</ModelVisual3D.Content></ModelVisual3D></Viewport3D>"
    ).encode()


def test_the_cube(tmp_path):
    for k, content in enumerate((xaml(model()), xaml(model()).decode().encode("utf-16"))):
        file = loaded(tmp_path, f"{k}.xaml", content)
        assert file.health.volume == 1.0
        assert file.units is None


def test_positions_without_indices_are_triangles(tmp_path):
    points = [files.CUBE_POINTS[i] for face in files.CUBE for i in face]
    text = " ".join("{} {} {}".format(*point) for point in points)
    file = loaded(tmp_path, "a.xaml", xaml(model(f'<MeshGeometry3D Positions="{text}"/>')))
    assert file.health.closed
    assert file.health.volume == 1.0


ROTATE = "<RotateTransform3D{}><RotateTransform3D.Rotation>{}</RotateTransform3D.Rotation>{}"
ROTATE = ROTATE.format("{}", "{}", "</RotateTransform3D>")
QUARTER = '<AxisAngleRotation3D Axis="0,0,2" Angle="90"/>'
MOVE = '<TranslateTransform3D OffsetX="5"/>'


@pytest.mark.parametrize(
    ("transform", "low"),
    [
        ('<MatrixTransform3D Matrix="1,0,0,0 0,1,0,0 0,0,1,0 5,6,7,1"/>', (5, 6, 7)),
        ('<MatrixTransform3D Matrix="0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1"/>', (-1, 0, 0)),
        ("<MatrixTransform3D/>", (0, 0, 0)),
        ('<TranslateTransform3D OffsetX="5" OffsetZ="-1"/>', (5, 0, -1)),
        ('<ScaleTransform3D ScaleX="-1"/>', (-1, 0, 0)),
        ('<ScaleTransform3D ScaleX="-1" CenterX="1"/>', (1, 0, 0)),
        (ROTATE.format("", QUARTER), (-1, 0, 0)),
        (ROTATE.format(' CenterX="1"', QUARTER), (0, -1, 0)),
        (ROTATE.format("", '<QuaternionRotation3D Quaternion="0,0,1,1"/>'), (-1, 0, 0)),
        ("<RotateTransform3D/>", (0, 0, 0)),
        (f"<Transform3DGroup>{MOVE}{ROTATE.format('', QUARTER)}</Transform3DGroup>", (-1, 5, 0)),
        (
            "<Transform3DGroup><Transform3DGroup.Children>"
            f"{ROTATE.format('', QUARTER)}{MOVE}</Transform3DGroup.Children></Transform3DGroup>",
            (4, 0, 0),
        ),
    ],
)
def test_transforms(tmp_path, transform, low):
    x, y, z = low
    high = (x + 1, y + 1, z + 1)
    assert loaded(tmp_path, "a.xaml", xaml(model(), transform)).mesh.bounds == (low, high)
    file = loaded(tmp_path, "b.xaml", xaml(model(transform=transform)))
    assert file.mesh.bounds == (low, high)
    assert file.health.volume == 1.0


def test_what_is_inside_is_moved_first(tmp_path):
    group = (
        '<Model3DGroup Transform="1,0,0,0 0,1,0,0 0,0,1,0 0,0,3,1"><Model3DGroup.Children>'
        f"{model(transform=MOVE)}</Model3DGroup.Children></Model3DGroup>"
    )
    file = loaded(tmp_path, "a.xaml", xaml(group, ROTATE.format("", QUARTER)))
    assert file.mesh.bounds == ((-1, 5, 3), (0, 6, 4))


@pytest.mark.parametrize(
    ("content", "code", "said"),
    [
        (xaml(model(), "<SpinTransform3D/>"), "unsupported-feature", "SpinTransform3D"),
        (xaml(model(), MOVE + MOVE), "bad-record", "2 transforms, not one"),
        (xaml(model(), attributes=' Transform="{StaticResource t}"'), "bad-record", "numbers"),
        (xaml(model(), '<TranslateTransform3D OffsetX="{Binding x}"/>'), "bad-record", "x"),
        (
            xaml(model(), '<MatrixTransform3D Matrix="1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1"/>'),
            "singular-transform",
            "affine",
        ),
        (xaml(f"<h:BoxVisual3D {HELIX}/>"), "unsupported-feature", "could be geometry"),
        (xaml(MESH), "unsupported-feature", "no model shows"),
        (
            xaml('<GeometryModel3D Geometry="{StaticResource g}"/>'),
            "unsupported-feature",
            "not read",
        ),
        (xaml(""), "empty-mesh", "no triangles"),
        (
            xaml(model(MESH.replace(INDICES, INDICES.replace("7", "8")))),
            "index-out-of-range",
            "vertex 8 of 8",
        ),
        (xaml(model(MESH.replace("0,0,0", "0,0,inf"))), "non-finite", "not finite"),
        (b"<Page/>", "unsupported-feature", "not an element of WPF"),
    ],
)
def test_what_is_refused(tmp_path, content, code, said):
    found, message = refusal(tmp_path, "a.xaml", content)
    assert found == code
    assert said in message
