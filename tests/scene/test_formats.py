"""Each format gives the same cube; what naive loaders get wrong is right here."""

from __future__ import annotations

import base64
import json

import pytest

from tests.scene import files
from tests.scene.loading import loaded, warnings

CUBES = {
    "cube.obj": files.obj(),
    "quads.obj": files.obj(faces=files.CUBE_QUADS),
    "binary.stl": files.binary_stl(),
    "solid_binary.stl": files.binary_stl(header=b"solid but binary"),
    "ascii.stl": files.ascii_stl(),
    "shouting.STL": files.ascii_stl().upper().replace(b"SOLID CUBE", b"SOLID"),
    "ascii.ply": files.ascii_ply(),
    "little.ply": files.binary_ply(),
    "big.ply": files.binary_ply(big=True),
    "double.ply": files.binary_ply(double=True),
    "cube.off": files.off(),
    "cube.glb": files.glb(),
    "cube.3mf": files.threemf(),
    "cube.dae": files.collada(),
}


@pytest.mark.parametrize("name", CUBES)
def test_each_format_gives_the_unit_cube(tmp_path, name):
    file = loaded(tmp_path, name, CUBES[name])
    assert warnings(file) == {}
    assert file.mesh.triangle_count == 12
    assert file.mesh.vertex_count == 8
    assert file.mesh.bounds == ((0, 0, 0), (1, 1, 1))
    assert file.health.closed
    assert file.health.manifold
    assert file.health.oriented
    assert file.health.solid
    assert file.health.components == 1
    assert file.health.volume == 1.0


@pytest.mark.parametrize(
    "content",
    [
        files.obj().replace(b"\n", b"\r\n"),
        files.obj().replace(b"\n", b"\r"),
        files.obj().replace(b"f 1 2 4\n", b"f 1 \\\n 2 4\n"),
        files.obj().replace(b"f 1 2 4\n", b"f 1 \\\r\n 2 \\\r\n4\r\n"),
        b"# caf\xe9\n" + files.obj(),
        files.obj().replace(b"v 0 0 0\n", b"v 0 0 0 nan nan nan\n"),
        files.obj().replace(b"v 0 0 0\n", b"v +0e0 0.0 -0 1.0  # the origin\n"),
        files.obj().replace(b"f 1 2 4\n", b"f -8 -7 -5\n"),
        files.obj().replace(b"f 1 2 4\n", b"f 1/1/1 2//7 4/3\n"),
        b"f 1 2 4\n" + files.obj().replace(b"f 1 2 4\n", b""),
        files.obj() + b"vt 0 0\nvn 0 0 1\nusemtl x\ns off\ng a b\n",
        files.obj().rstrip(b"\n"),
    ],
    ids=[
        "crlf",
        "cr",
        "continued",
        "continued-crlf",
        "latin-1",
        "nan-colour",
        "signs-and-weight",
        "negative",
        "slashes",
        "face-first",
        "not-geometry",
        "no-last-line-end",
    ],
)
def test_legal_obj(tmp_path, content):
    file = loaded(tmp_path, "a.obj", content)
    assert warnings(file) == {}
    assert file.mesh.triangle_count == 12
    assert file.health.volume == 1.0


def test_obj_polygons_are_fans_from_the_first_vertex(tmp_path):
    points = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 1)]
    file = loaded(tmp_path, "fan.obj", files.obj(points, [(0, 1, 2, 3, 4)]))
    fan = [(0, 1, 2), (0, 2, 3), (0, 3, 4)]
    corners = [set(file.mesh.corners(k)) for k in range(file.mesh.triangle_count)]
    assert sorted(map(sorted, corners)) == sorted(sorted(points[v] for v in t) for t in fan)


def test_off_accepts_properties_and_counts_in_the_first_line(tmp_path):
    body = "\n".join(
        ["COFF 4 4", *("{} {} {} 255 0 0 255".format(*p) for p in files.TETRAHEDRON_POINTS)]
        + ["3 {} {} {} 0.5 0.5 0.5".format(*face) for face in files.TETRAHEDRON]
    )
    assert loaded(tmp_path, "a.off", body.encode()).mesh.triangle_count == 4


def test_ply_steps_over_other_elements_and_properties(tmp_path):
    text = (
        "ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement camera 1\r\nproperty float f\r\n"
        "element vertex 4\r\nproperty uchar red\r\nproperty double z\r\nproperty double y\r\n"
        "property double x\r\nelement face 4\r\nproperty list uchar float texcoord\r\n"
        "property list uint8 uint vertex_index\r\nproperty int flags\r\nend_header\r\n9.5\r\n"
    )
    text += "".join("7 {2} {1} {0}\r\n".format(*point) for point in files.TETRAHEDRON_POINTS)
    text += "".join("2 .5 .5 3 {} {} {} 1\r\n".format(*face) for face in files.TETRAHEDRON)
    file = loaded(tmp_path, "a.ply", text.encode())
    assert file.health.volume == pytest.approx(1 / 6, rel=1e-15)


def test_gltf_applies_nested_transforms_and_turns_mirrored_meshes(tmp_path):
    document, buffer = files.gltf_document()
    document["nodes"] = [
        {"translation": [10, 0, 0], "children": [1, 2]},
        {"mesh": 0, "scale": [-2, 1, 1]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 5, 0, 1]},
        {"mesh": 0, "name": "not in the scene"},
    ]
    file = loaded(tmp_path, "a.glb", files.glb(document, buffer))
    assert file.mesh.bounds == ((8, 0, 0), (11, 6, 1))
    assert file.health.components == 2
    assert file.health.volume == 3.0


def test_gltf_rotation_is_a_quaternion_xyzw(tmp_path):
    document, buffer = files.gltf_document()
    document["nodes"] = [{"mesh": 0, "rotation": [0, 0, 1, 0], "translation": [0, 0, 3]}]
    file = loaded(tmp_path, "a.glb", files.glb(document, buffer))
    assert file.mesh.bounds == ((-1, -1, 3), (0, 0, 4))


def test_gltf_reads_embedded_and_neighbouring_buffers(tmp_path):
    document, buffer = files.gltf_document()
    text = base64.b64encode(buffer).decode()
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + text
    assert loaded(tmp_path, "a.gltf", json.dumps(document).encode()).health.volume == 1.0
    document["buffers"][0]["uri"] = "the%20buffer.bin"
    (tmp_path / "the buffer.bin").write_bytes(buffer)
    assert loaded(tmp_path, "b.gltf", json.dumps(document).encode()).health.volume == 1.0


def test_gltf_strided_positions_strips_and_fans(tmp_path):
    document, buffer = files.gltf_document(files.TETRAHEDRON_POINTS, [(0, 1, 2), (3, 0, 1)])
    strided = b"".join(buffer[12 * i : 12 * i + 12] + b"\xff" * 4 for i in range(4))
    document["bufferViews"][0] = {"buffer": 0, "byteLength": len(strided), "byteStride": 16}
    document["bufferViews"][1] = {"buffer": 0, "byteOffset": len(strided), "byteLength": 12}
    document["buffers"][0]["byteLength"] = len(strided) + 12
    document["meshes"][0]["primitives"][0]["mode"] = 5
    file = loaded(tmp_path, "a.glb", files.glb(document, strided + buffer[48:]))
    assert file.mesh.triangle_count == 4  # 012, 132, 230, 031
    assert file.health.closed
    assert file.health.oriented
    document["meshes"][0]["primitives"][0]["mode"] = 6
    file = loaded(tmp_path, "b.glb", files.glb(document, strided + buffer[48:]))
    assert file.mesh.triangle_count == 4


def test_gltf_says_what_it_leaves_out(tmp_path):
    document, buffer = files.gltf_document()
    document["meshes"][0]["primitives"].append({"attributes": {"POSITION": 0}, "mode": 1})
    document["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}]
    file = loaded(tmp_path, "a.glb", files.glb(document, buffer))
    assert set(warnings(file)) == {"ignored-geometry", "rest-shape"}


def test_3mf_applies_build_items_and_components_and_opens_no_other_part(tmp_path):
    resources = (
        files.object_3mf(1)
        + files.object_3mf(7)
        + files.components_3mf(
            2,
            '<component objectid="1" transform="-1 0 0 0 1 0 0 0 1 4 0 0"/>'
            '<component p:path="/3D/other.model" objectid="1"/>',
        )
    )
    model = files.model_3mf(resources, '<item objectid="2" transform="2 0 0 0 2 0 0 0 2 0 0 10"/>')
    other = files.model_3mf(files.object_3mf(1), "")
    parts = {"3D/root.model": model, "3D/other.model": other, "junk.bin": b"\0" * (32 << 20)}
    file = loaded(tmp_path, "a.3mf", files.package_3mf(parts, "/3D/root.model"))
    assert file.mesh.bounds == ((0, 0, 10), (8, 2, 12))
    assert file.health.volume == 16.0
    assert file.units == "inch"


def test_a_camera_may_look_at_something(tmp_path):
    nodes = (
        '<node id="n"><instance_geometry url="#g"/></node>'
        '<node id="camera"><lookat>5 0 0 5 0 -1 0 1 0</lookat></node>'
    )
    assert loaded(tmp_path, "a.dae", files.collada(nodes=nodes)).health.volume == 1.0


def test_collada_applies_nodes_and_library_nodes_without_unit_or_axis_conversion(tmp_path):
    nodes = (
        '<node id="n"><translate>10 0 0</translate><instance_geometry url="#g"/>'
        '<node id="m"><scale>-2 1 1</scale><instance_node url="#library"/></node></node>'
    )
    library = '<node id="library"><translate>0 0 5</translate><instance_geometry url="#g"/></node>'
    file = loaded(tmp_path, "a.dae", files.collada(nodes=nodes, library_nodes=library))
    assert file.mesh.bounds == ((8, 0, 0), (11, 1, 6))
    assert file.health.volume == 3.0
