"""What is repaired, what is only reported, and what has an inside afterwards."""

from __future__ import annotations

import pytest

from tests.scene import files
from tests.scene.loading import loaded


def shifted(points, x):
    return [(a + x, b, c) for a, b, c in points]


def joined(*parts):
    points, faces = [], []
    for part_points, part_faces in parts:
        faces += [tuple(i + len(points) for i in face) for face in part_faces]
        points += part_points
    return files.obj(points, faces)


def reverse(faces):
    return [face[::-1] for face in faces]


def test_an_inside_out_mesh_is_turned_and_solid(tmp_path):
    file = loaded(tmp_path, "a.obj", files.obj(faces=reverse(files.CUBE)))
    assert file.health.inside_out
    assert file.health.volume == -1.0
    assert not file.health.plain_solid
    assert file.health.solid
    assert file.mesh.topology().volume == 1.0


def test_one_inside_out_part_is_turned(tmp_path):
    parts = joined(
        (files.CUBE_POINTS, files.CUBE), (shifted(files.CUBE_POINTS, 5), reverse(files.CUBE))
    )
    file = loaded(tmp_path, "a.obj", parts)
    assert file.health.inside_out
    assert file.mesh.topology().volume == 2.0
    assert "part" in file.issues[0].message


def test_a_cavity_stays_a_cavity(tmp_path):
    inner = [(1 + x, 1 + y, 1 + z) for x, y, z in files.CUBE_POINTS]
    outer = [(3 * x, 3 * y, 3 * z) for x, y, z in files.CUBE_POINTS]
    file = loaded(tmp_path, "a.obj", joined((outer, files.CUBE), (inner, reverse(files.CUBE))))
    assert not file.health.inside_out
    assert file.health.solid
    assert file.issues == ()
    assert file.mesh.topology().volume == 26.0


@pytest.mark.parametrize(
    ("outer", "inner", "volume"),
    [
        (files.CUBE, reverse(files.CUBE), 26.0),
        (files.CUBE, files.CUBE, 28.0),
        (reverse(files.CUBE), reverse(files.CUBE), 28.0),
        (reverse(files.CUBE), files.CUBE, None),  # a cavity, or solid
    ],
)
def test_a_large_part_inside_out_changes_no_part_beside_it(tmp_path, outer, inner, volume):
    within = [(1 + x, 1 + y, 1 + z) for x, y, z in files.CUBE_POINTS]
    around = [(3 * x, 3 * y, 3 * z) for x, y, z in files.CUBE_POINTS]
    beside = [(10 + 9 * x, 9 * y, 9 * z) for x, y, z in files.CUBE_POINTS]
    for large in (files.CUBE, reverse(files.CUBE)):
        parts = joined((around, outer), (within, inner), (beside, large))
        file = loaded(tmp_path, "a.obj", parts)
        assert file.health.solid == (not file.health.doubtful) == (volume is not None)
        if volume is not None:
            assert file.mesh.topology().volume == 729.0 + volume
        else:
            assert (file.health.holes, file.health.inside_out) == (1, False)
            assert [issue.code for issue in file.issues] == ["doubtful-cavity"]


def test_one_turned_triangle_is_repaired(tmp_path):
    faces = [files.CUBE[0][::-1], *files.CUBE[1:]]
    file = loaded(tmp_path, "a.obj", files.obj(faces=faces))
    assert not file.health.oriented
    assert file.health.misoriented_edges == 3
    assert file.health.solid
    assert file.mesh.topology().volume == 1.0


def test_an_open_mesh_has_no_inside(tmp_path):
    file = loaded(tmp_path, "a.obj", files.obj(faces=files.CUBE[1:]))
    assert not file.health.closed
    assert file.health.boundary_edges == 3
    assert not file.health.solid


def test_a_double_sided_mesh_has_no_inside(tmp_path):
    faces = [*files.CUBE, *reverse(files.CUBE)]
    health = loaded(tmp_path, "a.obj", files.obj(faces=faces)).health
    assert health.double_sided
    assert not health.solid
    assert not health.flat


def test_a_solid_with_each_face_twice_is_no_sheet(tmp_path):
    file = loaded(tmp_path, "a.obj", files.obj(faces=[*files.CUBE, *files.CUBE]))
    assert not file.health.double_sided
    assert file.health.solid
    assert {issue.code for issue in file.issues} == {"duplicate-triangles", "not-manifold"}


def test_a_solid_with_one_triangle_twice_did_not_face_inward(tmp_path):
    file = loaded(tmp_path, "a.obj", files.obj(faces=[*files.CUBE, files.CUBE[0]]))
    assert file.health.solid
    assert {issue.code for issue in file.issues} == {"duplicate-triangles", "not-manifold"}


def test_a_tilted_sheet_is_flat(tmp_path):
    points = [(0, 0, 0), (1, 0, 1), (0, 1, 1), (1, 1, 2)]
    health = loaded(tmp_path, "a.obj", files.obj(points, [(0, 1, 2), (1, 3, 2)])).health
    assert health.flat
    assert not health.solid
