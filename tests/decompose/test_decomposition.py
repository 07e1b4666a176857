"""decompose(): short cuts, CoACD, cache and failures, as one call."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from msgspec.structs import replace

from satcheck.core import Mesh, Polytope
from satcheck.core.errors import SatcheckError
from satcheck.core.worker import run_isolated
from satcheck.decompose import Cache, Decomposition, DecompositionError, computation, decompose
from satcheck.decompose import errors as codes
from satcheck.decompose.components import merged
from satcheck.decompose.computation import held_against
from satcheck.decompose.decomposition import cache_key
from satcheck.decompose.result import CACHE_UNAVAILABLE, NOT_SOLID, REMESHED, Stored, encode
from satcheck.decompose.settings import DecompositionSettings


class Calls:
    """Counts the children that are started, and starts them."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.count = 0
        monkeypatch.setattr(computation, "run_isolated", self)

    def __call__(self, module: str, request: bytes, *, seconds: float, megabytes: int) -> bytes:
        self.count += 1
        return run_isolated(module, request, seconds=seconds, megabytes=megabytes)


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> Calls:
    return Calls(monkeypatch)


def content(result: Decomposition) -> bytes:
    """All of it but the time it took."""
    return encode(replace(result, seconds=0.0))


def opened(mesh: Mesh) -> Mesh:
    """Less its last triangle."""
    return Mesh(np.asarray(mesh.vertices), np.ascontiguousarray(np.asarray(mesh.triangles)[:-1]))


@pytest.mark.parametrize(("name", "parts"), [("l_shape", 2), ("u_shape", 3)])
def test_simple_shapes_split_where_a_person_would(
    name: str, parts: int, request: pytest.FixtureRequest
) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    result = decompose(mesh)
    assert len(result.parts) == parts
    assert all(part.dimension == 3 for part in result.parts)
    volume = sum(part.to_mesh().topology().volume for part in result.parts)
    assert volume == pytest.approx(mesh.topology().volume, rel=1e-3)
    assert result.notes == ()
    assert not result.from_cache


def test_a_torus_is_many_parts_within_the_rule_of_thumb(torus: Mesh) -> None:
    result = decompose(torus)
    assert len(result.parts) >= 6
    diagonal = 2.0 * np.hypot(np.hypot(1.3, 1.3), 0.3)
    assert 0.0 < result.outside < 0.5 * 0.05 * diagonal
    assert result.missing < 1e-4 * diagonal


def test_a_convex_mesh_is_its_own_only_part(box: Mesh, cache: Cache, calls: Calls) -> None:
    result = decompose(box, cache=cache)
    assert len(result.parts) == 1
    assert result.inner == result.parts
    assert (result.outside, result.missing) == (0.0, 0.0)
    assert calls.count == 0
    assert not cache.path.exists()


def test_convex_components_need_no_child(box: Mesh, calls: Calls) -> None:
    result = decompose(merged([box, box.translated((3.0, 0.0, 0.0))]))
    assert len(result.parts) == 2
    assert calls.count == 0
    assert result.outside < 0.01


def test_a_shallow_dent_is_no_reason_to_split(box: Mesh, calls: Calls) -> None:
    corners = np.asarray(box.vertices)
    centre = np.array([[0.5, 0.5, 0.999]])  # in the place of the top's diagonal
    sides = [triangle for triangle in np.asarray(box.triangles).tolist() if min(triangle) < 4]
    top = [[4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]]
    dented = Mesh(np.concatenate([corners, centre]), np.array(sides + top, dtype=np.uint32))
    result = decompose(dented)
    assert len(result.parts) == 1
    assert calls.count == 0
    assert 0.00099 <= result.outside <= 0.002
    assert result.missing == 0.0
    (inner,) = result.inner
    assert inner is not None
    assert inner.to_mesh().topology().volume > 0.99


def test_components_are_split_one_by_one(l_shape: Mesh, box: Mesh, calls: Calls) -> None:
    beside, overlapping = box.translated((5.0, 0.0, 0.0)), box.translated((1.5, 0.25, 0.25))
    result = decompose(merged([l_shape, beside, overlapping]))
    assert len(result.parts) == 4
    assert calls.count == 1


@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (2.0, 1.0, 1.0)])
def test_components_that_share_a_face_an_edge_or_a_vertex_do_not_crash(
    l_shape: Mesh, box: Mesh, offset: tuple[float, float, float]
) -> None:
    result = decompose(merged([l_shape, box.translated(offset)]), threshold=0.5)
    assert result.parts


def test_twice_the_same_bytes(torus: Mesh) -> None:
    assert content(decompose(torus)) == content(decompose(torus))


@pytest.mark.parametrize("exponent", [-30, 30])
def test_parts_scale_exactly_with_the_mesh(u_shape: Mesh, exponent: int) -> None:
    scaled = Mesh(np.ldexp(np.asarray(u_shape.vertices), exponent), np.asarray(u_shape.triangles))
    here, there = decompose(u_shape), decompose(scaled)
    for mine, theirs in zip(here.parts, there.parts, strict=True):
        expected = np.ldexp(np.asarray(mine.vertices), exponent)
        np.testing.assert_array_equal(np.asarray(theirs.vertices), expected)


def test_split_vertices_are_welded_first(l_shape: Mesh) -> None:
    corners = np.asarray(l_shape.vertices)[np.asarray(l_shape.triangles)].reshape(-1, 3)
    soup = Mesh(corners, np.arange(len(corners), dtype=np.uint32).reshape(-1, 3))
    assert len(decompose(soup).parts) == 2


def test_a_mesh_turned_inside_out_is_turned_back(l_shape: Mesh) -> None:
    inverted = np.ascontiguousarray(np.asarray(l_shape.triangles)[:, ::-1])
    result = decompose(Mesh(np.asarray(l_shape.vertices), inverted))
    assert len(result.parts) == 2
    assert result.outside < 0.01
    assert None not in result.inner


def test_an_open_mesh_is_decomposed_and_said_to_be_open(l_shape: Mesh) -> None:
    result = decompose(opened(l_shape), threshold=0.5)
    assert [note.code for note in result.notes] == [NOT_SOLID, REMESHED]
    assert result.inner == (None,) * len(result.parts)
    assert result.parts


@pytest.mark.parametrize(
    ("vertices", "triangles", "code"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), np.uint32), codes.EMPTY),
        (np.eye(3), np.zeros((0, 3), np.uint32), codes.EMPTY),
        (np.eye(3), np.array([[0, 1, 2]], np.uint32), codes.FLAT),
        (np.zeros((3, 3)), np.array([[0, 1, 2]], np.uint32), codes.FLAT),
    ],
)
def test_what_has_no_volume_is_refused(
    vertices: np.ndarray, triangles: np.ndarray, code: str
) -> None:
    with pytest.raises(DecompositionError) as caught:
        decompose(Mesh(vertices, triangles))
    assert caught.value.code == code


def test_a_bad_threshold_is_refused(l_shape: Mesh) -> None:
    with pytest.raises(DecompositionError) as caught:
        decompose(l_shape, threshold=0.0)
    assert caught.value.code == codes.BAD_SETTING


def test_the_time_limit_is_kept(torus: Mesh) -> None:
    with pytest.raises(DecompositionError) as caught:
        decompose(torus, seconds=0.05)
    assert caught.value.code == codes.TIMEOUT


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux is known to limit address space")
def test_the_memory_limit_is_kept(torus: Mesh) -> None:
    with pytest.raises(DecompositionError) as caught:
        decompose(torus, megabytes=64)
    assert caught.value.code == codes.OUT_OF_MEMORY


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("import os; os.abort()", codes.CRASHED),
        ("raise RuntimeError('no')", codes.FAILED),
        ("return b'no blocks'", codes.BAD_OUTPUT),
        (
            "import msgspec; return msgspec.msgpack.encode([])",
            codes.BAD_OUTPUT,
        ),
        (
            "import msgspec, struct; nan = struct.pack('<9d', *[float('nan')] * 9); "
            "return msgspec.msgpack.encode([(nan, b'')])",
            codes.BAD_OUTPUT,
        ),
    ],
)
def test_whatever_the_child_does_is_a_code(
    l_shape: Mesh, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, body: str, code: str
) -> None:
    head = "def serve(request):\n    "
    (tmp_path / "bad_server.py").write_text(head + body)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    monkeypatch.setattr(computation, "_SERVER", "bad_server")
    with pytest.raises(DecompositionError) as caught:
        decompose(l_shape)
    assert caught.value.code == code


def test_a_second_call_comes_from_the_cache(u_shape: Mesh, cache: Cache, calls: Calls) -> None:
    first, second = decompose(u_shape, cache=cache), decompose(u_shape, cache=cache)
    assert (first.from_cache, second.from_cache) == (False, True)
    assert encode(second) == encode(first)
    assert calls.count == 1
    decompose(u_shape, cache=cache, threshold=0.2)
    decompose(u_shape, cache=cache, seed=1)
    decompose(u_shape.translated((1.0, 0.0, 0.0)), cache=cache)
    assert calls.count == 4


def test_the_key_depends_on_the_version_of_coacd(
    u_shape: Mesh, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = DecompositionSettings()
    before = cache_key(u_shape, settings)
    assert cache_key(u_shape, settings) == before
    monkeypatch.setattr("importlib.metadata.version", lambda _name: "0.0.0")
    assert cache_key(u_shape, settings) != before


@pytest.mark.parametrize("damage", [b"", b"garbage", None])
def test_a_damaged_entry_is_computed_again_and_replaced(
    l_shape: Mesh, cache: Cache, calls: Calls, damage: bytes | None
) -> None:
    first = decompose(l_shape, cache=cache)
    (entry,) = cache.path.glob("*.parts")
    whole = entry.read_bytes()
    entry.write_bytes(whole[:-5] if damage is None else damage)
    again = decompose(l_shape, cache=cache)
    assert not again.from_cache
    assert calls.count == 2
    assert content(again) == content(first)
    assert decompose(l_shape, cache=cache).from_cache


def test_an_entry_of_another_layout_is_a_miss(l_shape: Mesh, cache: Cache, calls: Calls) -> None:
    key = cache_key(l_shape.welded(), DecompositionSettings())
    cache.store(key, b"a payload of some other program")
    assert not decompose(l_shape, cache=cache).from_cache
    assert calls.count == 1


def _moved(part: Polytope) -> Polytope:
    return part.to_mesh().translated((5.0, 0.0, 0.0)).convex_hull()


def _with_a_part_less(good: Decomposition) -> Decomposition:
    return replace(good, parts=good.parts[1:], inner=good.inner[1:])


def _with_a_part_elsewhere(good: Decomposition) -> Decomposition:
    return replace(good, parts=(_moved(good.parts[0]), *good.parts[1:]))


def _with_an_inner_part_elsewhere(good: Decomposition) -> Decomposition:
    assert good.inner[0] is not None
    return replace(good, inner=(_moved(good.inner[0]), *good.inner[1:]))


def _with_the_part_as_inner_part(good: Decomposition) -> Decomposition:
    return replace(good, inner=good.parts)


@pytest.mark.parametrize(
    "poisoned",
    [
        _with_a_part_less,
        _with_a_part_elsewhere,
        _with_an_inner_part_elsewhere,
        _with_the_part_as_inner_part,
    ],
)
def test_an_entry_that_is_not_of_its_mesh_is_computed_again_and_replaced(
    poisoned: Callable[[Decomposition], Decomposition],
    u_shape: Mesh,
    cache: Cache,
    calls: Calls,
) -> None:
    """Its key and its checksum are right: whoever may write the folder can make such a file."""
    good = decompose(u_shape, cache=cache)
    key = cache_key(u_shape.welded().oriented(), good.settings)
    assert cache.load(key) == encode(good)
    cache.store(key, encode(poisoned(good)))
    again = decompose(u_shape, cache=cache)
    assert not again.from_cache
    assert calls.count == 2
    assert content(again) == content(good)
    assert decompose(u_shape, cache=cache).from_cache


def test_the_errors_of_cached_parts_are_measured_and_not_believed(
    u_shape: Mesh, cache: Cache
) -> None:
    """A smaller part explains the mesh less well, and says so."""
    good = decompose(u_shape, cache=cache, threshold=1.0)
    part = max(good.parts, key=lambda each: each.to_mesh().topology().volume).to_mesh()
    matrix = [0.95 if k in (0, 5, 10) else float(k == 15) for k in range(16)]
    smaller = part.transformed(matrix).convex_hull()
    key = cache_key(u_shape.welded().oriented(), good.settings)
    cache.store(key, encode(replace(good, parts=(smaller,), inner=(None,))))
    again = decompose(u_shape, cache=cache, threshold=1.0)
    assert again.from_cache
    assert again.missing > 0.05 > good.missing


def test_an_open_mesh_has_no_stored_inner_parts(l_shape: Mesh, box: Mesh) -> None:
    hull, settings = box.convex_hull(), DecompositionSettings()
    stored = Stored((hull,), (None,), 1.0, ())
    assert held_against(opened(l_shape), stored, settings, 60.0) is not None
    stored = replace(stored, inner=(hull,))
    assert held_against(opened(l_shape), stored, settings, 60.0) is None


def test_a_cache_that_cannot_be_written_costs_only_a_note(l_shape: Mesh, tmp_path: Path) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.write_text("not a directory")
    result = decompose(l_shape, cache=Cache(in_the_way))
    assert len(result.parts) == 2
    assert [note.code for note in result.notes] == [CACHE_UNAVAILABLE]


@pytest.mark.skipif(
    os.name != "posix" or os.geteuid() == 0, reason="root writes to read-only directories"
)
def test_a_read_only_cache_still_answers_from_what_it_holds(
    l_shape: Mesh, u_shape: Mesh, cache: Cache
) -> None:
    decompose(l_shape, cache=cache)
    cache.path.chmod(stat.S_IRUSR | stat.S_IXUSR)
    try:
        assert decompose(l_shape, cache=cache).from_cache
        result = decompose(u_shape, cache=cache)
    finally:
        cache.path.chmod(stat.S_IRWXU)
    assert [note.code for note in result.notes] == [CACHE_UNAVAILABLE]


def test_a_full_disk_computes_once_and_says_so(
    l_shape: Mesh, cache: Cache, calls: Calls, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full_disk(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    result = decompose(l_shape, cache=cache)
    assert calls.count == 1
    assert "No space left" in result.notes[-1].message


def test_a_lock_that_is_never_released_does_not_stop_the_work(l_shape: Mesh, cache: Cache) -> None:
    key = cache_key(l_shape.welded(), DecompositionSettings())
    with cache.single_flight(key, 1.0):
        results: list[Decomposition] = []
        thread = threading.Thread(
            target=lambda: results.append(decompose(l_shape, cache=cache, seconds=5.0))
        )
        thread.start()
        thread.join()
    assert [note.code for note in results[0].notes] == [CACHE_UNAVAILABLE]


ONE_RUN = """
import sys
from pathlib import Path
from satcheck.core import Mesh
from satcheck.decompose import Cache, decompose
folder = Path(sys.argv[1])
mesh = Mesh.from_bytes((folder / "v").read_bytes(), (folder / "t").read_bytes())
result = decompose(mesh, cache=Cache(folder))
heavy = {"coacd", "filelock"} & sys.modules.keys()
print(result.from_cache, len(result.parts), *sorted(heavy))
"""


@pytest.fixture
def u_shape_on_disk(u_shape: Mesh, tmp_path: Path) -> Path:
    for name, data in zip("vt", u_shape.to_bytes(), strict=True):
        (tmp_path / name).write_bytes(data)
    return tmp_path


def start(folder: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", ONE_RUN, str(folder)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def test_processes_at_once_compute_once(u_shape_on_disk: Path) -> None:
    processes = [start(u_shape_on_disk) for _ in range(3)]
    answers = [process.communicate()[0].split()[:2] for process in processes]
    assert sorted(answers) == [["False", "3"], ["True", "3"], ["True", "3"]]


def test_a_hit_imports_no_coacd(u_shape_on_disk: Path) -> None:
    assert start(u_shape_on_disk).communicate()[0].split()[0] == "False"
    assert start(u_shape_on_disk).communicate()[0].split() == ["True", "3"]


def test_meshes_of_trimesh_go_in_and_come_out() -> None:
    far = trimesh.creation.box((1, 1, 1))
    far.apply_translation((4, 0, 0))
    both: trimesh.Trimesh = trimesh.creation.box((2, 1, 1)) + far
    result = decompose(both)
    parts = result.to_trimesh()
    assert sorted(part.volume for part in parts) == pytest.approx([1.0, 2.0])
    assert all(part.is_watertight for part in parts)
    with pytest.raises(SatcheckError, match="index 9"):
        decompose(([[0, 0, 0]], [[0, 0, 9]]))
