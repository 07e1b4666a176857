"""What shapes, packs and repeats the meshes of glTF."""

from __future__ import annotations

import math
import struct
from typing import Any

import pytest

from satcheck._native.readers import ReadError, unpack_meshopt
from satcheck.scene import load_scene
from tests.scene import files, meshopt
from tests.scene.loading import loaded, refusal, warnings

FLOAT, BYTE, SHORT, USHORT = 5126, 5120, 5122, 5123
HALF_DIAGONAL = math.sqrt(3) / 2  # of the unit cube


class Document:
    """The unit cube in one node, to which buffers are added."""

    def __init__(self) -> None:
        self.json, self.buffer = files.gltf_document()

    def view(self, data: bytes, **keys: Any) -> int:
        view = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data), **keys}
        self.json["bufferViews"].append(view)
        self.buffer += data
        self.json["buffers"][0]["byteLength"] = len(self.buffer)
        return len(self.json["bufferViews"]) - 1

    def accessor(
        self, data: bytes | None, type_: str, count: int, component: int = FLOAT, **keys: Any
    ) -> int:
        view = {} if data is None else {"bufferView": self.view(data)}
        accessor = {**view, "componentType": component, "count": count, "type": type_, **keys}
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def floats(self, rows: list[tuple[float, ...]], type_: str) -> int:
        data = b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows)
        return self.accessor(data, type_, len(rows))

    @property
    def primitive(self) -> dict[str, Any]:
        return self.json["meshes"][0]["primitives"][0]

    def glb(self) -> bytes:
        return files.glb(self.json, self.buffer)


def scene_of(folder, content):
    path = folder / "a.glb"
    path.write_bytes(content)
    return load_scene([path], split="nodes")


def test_sparse_positions_replace_those_of_a_view(tmp_path):
    document = Document()
    places = document.view(struct.pack("<2H", 0, 1))
    values = document.view(struct.pack("<6f", -1, 0, 0, -1, 0, 1))
    document.json["accessors"][0]["sparse"] = {
        "count": 2,
        "indices": {"bufferView": places, "componentType": USHORT},
        "values": {"bufferView": values},
    }
    file = loaded(tmp_path, "a.glb", document.glb())
    assert file.mesh.bounds == ((-1, 0, 0), (1, 1, 1))


def test_sparse_positions_without_a_view_start_at_zero(tmp_path):
    document = Document()
    moved = [i for i, point in enumerate(files.CUBE_POINTS) if any(point)]
    places = document.view(bytes(moved))
    rows = b"".join(struct.pack("<3f", *files.CUBE_POINTS[i]) for i in moved)
    values = document.view(rows)
    del document.json["accessors"][0]["bufferView"]
    document.json["accessors"][0]["sparse"] = {
        "count": len(moved),
        "indices": {"bufferView": places, "componentType": 5121},
        "values": {"bufferView": values},
    }
    assert loaded(tmp_path, "a.glb", document.glb()).health.volume == 1.0


def test_few_bytes_do_not_make_a_mesh_of_millions_of_vertices(tmp_path):
    document = Document()
    accessor = document.json["accessors"][0]
    del accessor["bufferView"]
    accessor["count"] = 1_000_001
    accessor["sparse"] = {
        "count": 1,
        "indices": {"bufferView": document.view(bytes(1)), "componentType": 5121},
        "values": {"bufferView": document.view(bytes(12))},
    }
    assert refusal(tmp_path, "a.glb", document.glb())[0] == "too-large"


@pytest.mark.parametrize(
    ("place", "code"), [(8, "index-out-of-range"), (2**16 - 1, "index-out-of-range")]
)
def test_sparse_data_names_no_element_that_is_not_there(tmp_path, place, code):
    document = Document()
    document.json["accessors"][0]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": document.view(struct.pack("<H", place)), "componentType": USHORT},
        "values": {"bufferView": document.view(bytes(12))},
    }
    assert refusal(tmp_path, "a.glb", document.glb())[0] == code


@pytest.mark.parametrize("accessor", [0, 1])
def test_what_an_unknown_extension_holds_is_not_taken_for_zeros(tmp_path, accessor):
    """Beside a primitive that is all there: what is missing would not be noticed."""
    document = Document()
    (whole,) = document.json["meshes"][0]["primitives"]
    accessors = document.json["accessors"]
    accessors.append({k: v for k, v in accessors[accessor].items() if k != "bufferView"})
    key = {"attributes": {"POSITION": 2}} if accessor == 0 else {"indices": 2}
    document.json["meshes"][0]["primitives"].append(whole | key)
    assert refusal(tmp_path, "a.glb", document.glb())[0] == "unsupported-feature"


def test_zeros_cost_no_more_than_the_limit(tmp_path):
    document = Document()
    del document.json["accessors"][0]["bufferView"]
    document.json["accessors"][0]["count"] = 10**12
    document.json["accessors"][0]["sparse"] = {
        "count": 0,
        "indices": {"bufferView": 0, "componentType": 5121},
        "values": {"bufferView": 0},
    }
    assert refusal(tmp_path, "a.glb", document.glb())[0] == "too-large"


def test_each_instance_is_a_body(tmp_path):
    document = Document()
    quarter = 0.5**0.5
    attributes = {
        "TRANSLATION": document.floats([(0, 0, 0), (10, 0, 0)], "VEC3"),
        "ROTATION": document.floats([(0, 0, 0, 1), (0, 0, quarter, quarter)], "VEC4"),
        "SCALE": document.floats([(1, 1, 1), (2, 1, 1)], "VEC3"),
    }
    document.json["nodes"][0] |= {
        "name": "bricks",
        "translation": [0, 0, 5],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}},
    }
    document.json["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]
    scene = scene_of(tmp_path, document.glb())
    bounds = {body.id: body.world_mesh().bounds for body in scene.bodies}
    assert list(bounds) == ["bricks[0]", "bricks[1]"]
    assert bounds["bricks[0]"] == ((0, 0, 5), (1, 1, 6))
    low, high = bounds["bricks[1]"]  # turned from x to y, where it is twice as long
    assert low == pytest.approx((9, 0, 5), abs=1e-6)
    assert high == pytest.approx((10, 2, 6), abs=1e-6)


def test_normalized_rotations_of_instances(tmp_path):
    document = Document()
    half_turn = document.accessor(
        struct.pack("<4h", 0, 0, 32767, 0), "VEC4", 1, SHORT, normalized=True
    )
    document.json["nodes"][0]["extensions"] = {
        "EXT_mesh_gpu_instancing": {"attributes": {"ROTATION": half_turn}}
    }
    (body,) = scene_of(tmp_path, document.glb()).bodies
    assert body.world_mesh().bounds == ((-1, -1, 0), (0, 0, 1))


def test_a_node_that_draws_no_instance_is_refused(tmp_path):
    document = Document()
    empty = document.accessor(b"", "VEC3", 0)
    instancing = {"attributes": {"TRANSLATION": empty}}
    document.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": instancing}
    assert refusal(tmp_path, "a.glb", document.glb())[0] == "count-mismatch"


def test_instances_that_disagree_on_their_number_are_refused(tmp_path):
    document = Document()
    attributes = {
        "TRANSLATION": document.floats([(0, 0, 0), (10, 0, 0)], "VEC3"),
        "SCALE": document.floats([(1, 1, 1)], "VEC3"),
    }
    document.json["nodes"][0]["extensions"] = {
        "EXT_mesh_gpu_instancing": {"attributes": attributes}
    }
    assert refusal(tmp_path, "a.glb", document.glb())[0] == "count-mismatch"


@pytest.mark.parametrize(
    ("mesh_weights", "node_weights", "top"),
    [(None, None, 1), ([0], None, 1), ([0.5], None, 2), ([0.5], [1], 3), ([1], [0], 1)],
)
def test_morph_targets_have_the_weights_of_the_node_or_of_the_mesh(
    tmp_path, mesh_weights, node_weights, top
):
    document = Document()
    moves = [(0, 0, 2.0 * z) for _, _, z in files.CUBE_POINTS]
    document.primitive["targets"] = [{"POSITION": document.floats(moves, "VEC3")}]
    if mesh_weights is not None:
        document.json["meshes"][0]["weights"] = mesh_weights
    if node_weights is not None:
        document.json["nodes"][0]["weights"] = node_weights
    file = loaded(tmp_path, "a.glb", document.glb())
    assert set(warnings(file)) == {"rest-shape"}
    assert file.mesh.bounds == ((0, 0, 0), (1, 1, top))


def test_the_joints_of_a_skin_place_it_and_not_its_node(tmp_path):
    document = Document()
    count = len(files.CUBE_POINTS)
    joints = b"".join(bytes([point[0], 0, 0, 0]) for point in files.CUBE_POINTS)
    document.primitive["attributes"] |= {
        "JOINTS_0": document.accessor(joints, "VEC4", count, 5121),
        "WEIGHTS_0": document.floats([(1, 0, 0, 0)] * count, "VEC4"),
    }
    bound = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 4, 1]  # column-major: z + 4
    document.json["skins"] = [
        {"joints": [2, 3], "inverseBindMatrices": document.floats([tuple(bound)] * 2, "MAT4")}
    ]
    document.json["nodes"] = [
        {"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
        {"translation": [0, 7, 0], "children": [2, 3]},
        {},
        {"translation": [3, 0, 0]},
    ]
    document.json["scenes"] = [{"nodes": [0, 1]}]
    file = loaded(tmp_path, "a.glb", document.glb())
    assert set(warnings(file)) == {"rest-shape"}
    assert file.mesh.bounds == ((0, 7, 4), (4, 8, 5))


def packed_with_meshopt(name: str, version: int, triangles: bool) -> Document:
    document = Document()
    views, data = document.json["bufferViews"], document.buffer
    size = views[0]["byteLength"]
    corners = [corner for face in files.CUBE for corner in face]
    streams = (
        (meshopt.attributes(data[:size], 12, version), "ATTRIBUTES", 8, 12),
        (meshopt.triangles(files.CUBE), "TRIANGLES", 36, 2)
        if triangles
        else (meshopt.indices(corners), "INDICES", 36, 2),
    )
    document.buffer = b""
    for view, (stream, mode, count, stride) in zip(views, streams, strict=True):
        packed = {"buffer": 0, "byteOffset": len(document.buffer), "byteLength": len(stream)}
        packed |= {"mode": mode, "count": count, "byteStride": stride}
        view |= {"buffer": 1, "extensions": {name: packed}}
        document.buffer += stream
    document.json["buffers"] = [{"byteLength": len(document.buffer)}, {"byteLength": len(data)}]
    document.json["extensionsRequired"] = [name]
    return document


@pytest.mark.parametrize("version", [0, 1])
@pytest.mark.parametrize("triangles", [False, True])
@pytest.mark.parametrize("name", ["EXT_meshopt_compression", "KHR_meshopt_compression"])
def test_meshopt(tmp_path, name, version, triangles):
    document = packed_with_meshopt(name, version, triangles)
    file = loaded(tmp_path, "a.glb", document.glb())
    assert file.mesh.triangle_count == 12
    assert file.health.volume == 1.0


def test_meshopt_data_that_is_cut_or_too_long_is_refused():
    stream = meshopt.attributes(bytes(range(240)), 12)
    assert unpack_meshopt(stream, "ATTRIBUTES", 20, 12, "NONE") == bytes(range(240))
    for damaged in (stream[:-1], stream + b"\0", stream[:1], b"", b"\xa2" + stream[1:]):
        assert isinstance(unpack_meshopt(damaged, "ATTRIBUTES", 20, 12, "NONE"), ReadError)
    assert isinstance(unpack_meshopt(stream, "ATTRIBUTES", 16, 12, "NONE"), ReadError)


def test_meshopt_triangles_refer_only_to_what_was_there():
    stream = b"\xe1\x10" + bytes(16)
    found = unpack_meshopt(stream, "TRIANGLES", 3, 4, "NONE")
    assert isinstance(found, ReadError)
    assert "not there" in found.message


def test_the_deltas_of_the_specification():
    """The example of 16 deltas in 4 bits each, two of them in full, behind a baseline of zeros."""
    deltas = bytes.fromhex("175ff0bc77a9210034b5")
    stream = b"\xa0\x02" + deltas + b"\0\0\0" + bytes(32)
    found = unpack_meshopt(stream, "ATTRIBUTES", 16, 4, "NONE")
    steps = [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]
    sums = [sum(steps[: k + 1]) % 256 for k in range(16)]
    assert list(found[::4]) == sums


def test_meshopt_filters():
    words = struct.pack("<3i", (2 << 24) | 5, (-1 << 24) | 3, ((-1 << 24) | (1 << 24) - 1))
    stream = meshopt.attributes(words, 12)
    found = unpack_meshopt(stream, "ATTRIBUTES", 1, 12, "EXPONENTIAL")
    assert struct.unpack("<3f", found) == (20.0, 1.5, -0.5)
    # x = y = z = 0, and the largest component, w, is number 3.
    stream = meshopt.attributes(struct.pack("<4h", 0, 0, 0, 32767), 8)
    found = unpack_meshopt(stream, "ATTRIBUTES", 1, 8, "QUATERNION")
    assert struct.unpack("<4h", found) == (0, 0, 0, 32767)


def test_integer_positions_are_off_by_half_the_diagonal_of_a_step(tmp_path):
    document = Document()
    positions = document.json["accessors"][document.primitive["attributes"]["POSITION"]]
    rows = b"".join(struct.pack("<3h2x", *(127 * c for c in point)) for point in files.CUBE_POINTS)
    positions |= {"bufferView": document.view(rows, byteStride=8), "componentType": SHORT}
    assert loaded(tmp_path, "a.glb", document.glb()).resolution == HALF_DIAGONAL
    positions["normalized"] = True
    step = pytest.approx(HALF_DIAGONAL / 32767, rel=1e-15)
    assert loaded(tmp_path, "b.glb", document.glb()).resolution == step
    document.json["nodes"] = [{"mesh": 0, "scale": [5, 5, 5], "translation": [1, 0, 0]}]
    (flat,) = load_scene([tmp_path / "b.glb"]).bodies
    assert flat.file.resolution == step
    (tmp_path / "c.glb").write_bytes(document.glb())
    (node,) = load_scene([tmp_path / "c.glb"], split="nodes").bodies
    assert node.resolution_world == pytest.approx(5 * HALF_DIAGONAL / 32767, rel=1e-2)
    (flat,) = load_scene([tmp_path / "c.glb"], split="none").bodies
    assert flat.resolution_world == pytest.approx(5 * HALF_DIAGONAL / 32767, rel=1e-9)


def test_integer_targets_add_their_step(tmp_path):
    document = Document()
    rows = b"".join(struct.pack("<3b", *point) for point in files.CUBE_POINTS)
    target = document.accessor(rows, "VEC3", 8, BYTE)
    document.primitive["targets"] = [{"POSITION": target}]
    document.json["meshes"][0]["weights"] = [0.25]
    assert loaded(tmp_path, "a.glb", document.glb()).resolution == 0.25 * HALF_DIAGONAL


def test_joints_stretch_the_step(tmp_path):
    document = Document()
    positions = document.json["accessors"][document.primitive["attributes"]["POSITION"]]
    rows = b"".join(struct.pack("<3b", *point) for point in files.CUBE_POINTS)
    positions |= {"bufferView": document.view(rows), "componentType": BYTE}
    ones = [(1.0, 0.0, 0.0, 0.0)] * 8
    joints = struct.pack("<4H", 0, 1, 0, 0) * 8  # the second joint moves nothing
    document.primitive["attributes"] |= {
        "JOINTS_0": document.accessor(joints, "VEC4", 8, USHORT),
        "WEIGHTS_0": document.floats(ones, "VEC4"),
    }
    document.json["skins"] = [{"joints": [1, 2]}]
    document.json["nodes"] = [{"mesh": 0, "skin": 0}, {"scale": [3, 3, 3]}, {"scale": [9, 9, 9]}]
    document.json["scenes"] = [{"nodes": [0, 1, 2]}]
    step = pytest.approx(3 * HALF_DIAGONAL, rel=1e-15)
    assert loaded(tmp_path, "a.glb", document.glb()).resolution == step


def test_the_exponential_filter_of_meshopt_leaves_its_step(tmp_path):
    document = Document()
    positions = document.json["accessors"][document.primitive["attributes"]["POSITION"]]
    exponent = -6
    words = b"".join(
        struct.pack("<3i", *((exponent << 24) | (64 * c) for c in point))
        for point in files.CUBE_POINTS
    )
    stream = meshopt.attributes(words, 12)
    packed = {
        "buffer": 0,
        "byteOffset": len(document.buffer),
        "byteLength": len(stream),
        "byteStride": 12,
        "count": 8,
        "mode": "ATTRIBUTES",
        "filter": "EXPONENTIAL",
    }
    extensions = {"EXT_meshopt_compression": packed}
    number = document.view(stream)
    document.json["bufferViews"][number] |= {"byteLength": 96, "extensions": extensions}
    positions["bufferView"] = number
    file = loaded(tmp_path, "a.glb", document.glb())
    assert file.mesh.bounds == ((0, 0, 0), (1, 1, 1))
    assert file.resolution == 2.0**exponent * HALF_DIAGONAL


def test_meshopt_does_not_unpack_more_than_the_limit(tmp_path):
    document = packed_with_meshopt("EXT_meshopt_compression", 0, True)
    view = document.json["bufferViews"][0]
    view["byteLength"] = 12 * 10**9
    view["extensions"]["EXT_meshopt_compression"]["count"] = 10**9
    assert refusal(tmp_path, "a.glb", document.glb())[0] == "too-large"


def packed_with_draco(required: bool = True, bits: int = 14, **options: Any) -> Document:
    draco = pytest.importorskip("DracoPy")
    document = Document()
    points = [(x - 0.5, y - 0.5, z - 0.5) for x, y, z in files.CUBE_POINTS]
    data = draco.encode(points, files.CUBE, quantization_bits=bits, **options)
    packed = {"bufferView": document.view(data), "attributes": {"POSITION": 0}}
    document.primitive["extensions"] = {"KHR_draco_mesh_compression": packed}
    document.json["extensionsUsed"] = ["KHR_draco_mesh_compression"]
    if required:
        document.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
        for accessor in document.json["accessors"]:
            del accessor["bufferView"]
    return document


def test_draco(tmp_path):
    file = loaded(tmp_path, "a.glb", packed_with_draco().glb())
    assert file.mesh.triangle_count == 12
    assert file.mesh.bounds == ((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))


@pytest.mark.parametrize("bits", [6, 11, 16])
@pytest.mark.parametrize("box", [{}, {"quantization_range": 8.0, "quantization_origin": [-4] * 3}])
def test_draco_leaves_its_step(tmp_path, bits, box):
    document = packed_with_draco(bits=bits, **box)
    step = box.get("quantization_range", 1.0) / (2**bits - 1)
    expected = HALF_DIAGONAL * (step + 2.0**-24)  # and the decoder rounds to float32
    file = loaded(tmp_path, "a.glb", document.glb())
    assert file.resolution == pytest.approx(expected, rel=1e-2)


def test_draco_with_about_the_bits_of_float32_is_as_precise(tmp_path):
    file = loaded(tmp_path, "a.glb", packed_with_draco(bits=25).glb())
    assert file.resolution == pytest.approx(HALF_DIAGONAL * (2.0**-25 + 2.0**-24), rel=1e-6)


def test_what_is_there_unpacked_as_well_needs_no_draco(tmp_path):
    file = loaded(tmp_path, "a.glb", packed_with_draco(required=False).glb())
    assert file.mesh.bounds == ((0, 0, 0), (1, 1, 1))


@pytest.mark.parametrize("materials", [5, "steel", {}])
def test_materials_are_a_list(tmp_path, materials):
    """A number ended the run, and other files had no answer."""
    document = packed_with_draco(required=False)
    document.json["materials"] = materials
    code, message = refusal(tmp_path, "a.glb", document.glb())
    assert (code, "materials" in message) == ("bad-record", True)


def test_damaged_draco_data_loses_its_mesh(tmp_path):
    document = packed_with_draco()
    view = document.json["bufferViews"][-1]
    start, size = view["byteOffset"], view["byteLength"]
    damaged = document.buffer[: start + size // 2] + b"\xff" * (size - size // 2)
    document.buffer = damaged
    assert refusal(tmp_path, "a.glb", document.glb())[0] in {"bad-record", "reader-failed"}


def test_an_animated_file_is_checked_as_stored(tmp_path):
    document = Document()
    document.json["nodes"] = [{"mesh": 0}, {"mesh": 0, "translation": [3, 0, 0]}]
    document.json["scenes"] = [{"nodes": [0, 1]}]
    times = document.floats([(0,), (1,)], "SCALAR")
    moves = document.floats([(0, 9, 0), (0, 5, 0)], "VEC3")
    target = {"node": 1, "path": "translation"}
    document.json["animations"] = [
        {
            "samplers": [{"input": times, "output": moves}],
            "channels": [{"sampler": 0, "target": target}],
        }
    ] * 2
    (tmp_path / "a.glb").write_bytes(document.glb())
    scene = load_scene([tmp_path / "a.glb"])
    assert scene.bodies[1].world_mesh().bounds == ((3, 0, 0), (4, 1, 1))
    (issue,) = scene.issues
    assert (issue.code, issue.severity) == ("time-sampled", "note")
    assert issue.message == "the file is animated; checked as stored"
