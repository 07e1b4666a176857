"""ASCII STL as exporters write it, and that no facet is lost on the way."""

from __future__ import annotations

import pytest

from satcheck.scene import load_scene
from tests.scene import files
from tests.scene.loading import loaded, refusal

CUBE = files.ascii_stl()
SPELLINGS = {
    "numbered": CUBE.replace(b"endfacet", b"endfacet 7"),
    "coloured": CUBE.replace(b"endfacet", b"endfacet color 0.5 0.5 1"),
    "remarks": CUBE.replace(b"endloop", b"endloop foo ").replace(b"endfacet", b"endfacet bar"),
    "apart": CUBE.replace(b"endloop", b"end loop").replace(b"endfacet", b"end facet"),
    "end-solid": CUBE.replace(b"endsolid cube", b"end solid cube"),
    "nameless": CUBE.replace(b"solid cube", b"solid"),
    "one-line": CUBE.replace(b"\n", b" "),
    "facet-follows": CUBE.replace(b"endfacet\n", b"endfacet 3 "),
    "facet-in-name": CUBE.replace(b"solid cube", b"solid facet of normal form"),
    "upper-case": CUBE.upper(),
    "blank-lines": CUBE.replace(b"\n", b"\n\n"),
}


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_usual_spellings_of_ascii_stl(tmp_path, spelling):
    file = loaded(tmp_path, "a.stl", SPELLINGS[spelling])
    assert file.mesh.triangle_count == 12
    assert file.health.volume == 1.0


@pytest.mark.parametrize("suffix", [".stla", ".STLA", ".stlb"])
def test_other_suffixes(tmp_path, suffix):
    content = files.binary_stl() if suffix == ".stlb" else CUBE
    assert loaded(tmp_path, f"a{suffix}", content).health.volume == 1.0


def test_several_solids_are_one_mesh(tmp_path):
    points = [(x + 3, y, z) for x, y, z in files.CUBE_POINTS]
    content = CUBE + files.ascii_stl(points).replace(b"solid cube", b"solid")
    assert loaded(tmp_path, "a.stl", content).health.volume == 2.0


@pytest.mark.parametrize(
    "content",
    [
        CUBE.replace(b"endfacet", b"endfacet vertex 0 0 0", 1),
        CUBE.replace(b"endfacet", b"endfacet outer loop", 1),
        CUBE.replace(b"endfacet", b"endfacets", 1),
        CUBE.replace(b"endloop", b"endloop x vertex 0 0 0", 1),
        CUBE.replace(b"endsolid cube", b"endsolid cube facet normal 0 0 1"),
        CUBE.replace(b"endloop", b"vertex 1 1 1\nendloop", 1),
    ],
)
def test_no_facet_is_lost(tmp_path, content):
    code, _ = refusal(tmp_path, "a.stl", content)
    assert code in {"bad-record", "trailing-data"}


def test_solids_are_no_bodies_and_a_file_of_several_says_so(tmp_path):
    empty = b"solid a\nendsolid a\n"
    for content, codes in (
        (files.ascii_stl() * 2, ["left-out"]),
        (empty + files.ascii_stl() + empty, []),
    ):
        (tmp_path / "a.stl").write_bytes(content)
        issues = load_scene([tmp_path / "a.stl"]).issues
        assert [each.code for each in issues if each.code == "left-out"] == codes
