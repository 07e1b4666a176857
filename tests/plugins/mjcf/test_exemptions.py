"""The pairs that MuJoCo does not check, against the contacts that MuJoCo itself finds."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import mujoco
import pytest

from satcheck.scene import Scene
from tests.plugins.mjcf.files import allowed, body, geom, load, model

HINGE = '<joint type="hinge"/>'
FREE = "<freejoint/>"


def contacts(folder: Path) -> set[tuple[str, str]]:
    """Pairs of geoms that MuJoCo finds in contact in the file."""
    compiled = mujoco.MjModel.from_xml_path(str(folder / "m.xml"))
    data = mujoco.MjData(compiled)
    mujoco.mj_forward(compiled, data)
    names = [compiled.geom(k).name for k in range(compiled.ngeom)]
    pairs = {(names[c.geom1], names[c.geom2]) for c in data.contact}
    return {(min(pair), max(pair)) for pair in pairs}


def checked(scene: Scene) -> set[tuple[str, str]]:
    ids = [each.id for each in scene.bodies]
    left_out = allowed(scene)
    pairs = {pair for pair in combinations(ids, 2) if pair not in left_out}
    return {(min(pair), max(pair)) for pair in pairs}


# Each body has one geom of its name, and all overlap, so MuJoCo finds a contact for each pair that
# it checks.
CASES = {
    "welded": model(body("a", geom("a"), FREE, body("b", geom("b"))), body("c", geom("c"))),
    "static": model(geom("world"), body("a", geom("a")), body("b", geom("b"), HINGE)),
    "parent": model(
        body("a", geom("a"), FREE, body("b", geom("b"), HINGE, body("c", geom("c"), HINGE)))
    ),
    "parent is static": model(body("a", geom("a"), body("b", geom("b"), HINGE))),
    "welded parent": model(
        body(
            "a", geom("a"), FREE,
            body("b", geom("b")), body("c", geom("c"), HINGE, body("d", geom("d"))),
        ),
    ),
    "parents are checked": model(
        body("a", geom("a"), FREE, body("b", geom("b"), HINGE)),
        before='<option><flag filterparent="disable"/></option>',
    ),
    "exclude": model(
        body("a", geom("a"), FREE), body("b", geom("b"), FREE), body("c", geom("c"), FREE),
        after='<contact><exclude body1="a" body2="c"/></contact>',
    ),
    "bits": model(
        body("a", geom("a", 'contype="1" conaffinity="2"'), FREE),
        body("b", geom("b", 'contype="2" conaffinity="4"'), FREE),
        body("c", geom("c", 'contype="4" conaffinity="8"'), FREE),
        body("d", geom("d", 'contype="1" conaffinity="2"'), FREE),
    ),
    "mocap": model(
        geom("world"),
        body("m", geom("m"), more='mocap="true"'),
        body(
            "n", geom("n"), body("k", geom("k")), body("j", geom("j"), HINGE), more='mocap="true"'
        ),
        body("f", geom("f"), FREE),
    ),
    "pair": model(
        body("a", geom("a", 'contype="0" conaffinity="0"'), FREE, body("b", geom("b"), HINGE)),
        body("c", geom("c"), FREE),
        after='<contact><exclude body1="b" body2="c"/><pair geom1="a" geom2="b"/>'
        '<pair geom1="c" geom2="b"/></contact>',
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_the_pairs_of_mujoco_are_checked(tmp_path: Path, name: str) -> None:
    scene = load(tmp_path, CASES[name])
    assert checked(scene) == contacts(tmp_path)


def test_a_pair_with_a_plane_is_a_rule(tmp_path: Path) -> None:
    text = model(
        geom("floor", kind="plane", size="1 1 1"),
        body("a", geom("a"), FREE),
        after='<contact><pair geom1="a" geom2="floor"/></contact>',
    )
    scene = load(tmp_path, text)
    assert [each.id for each in scene.bodies] == ["world", "a"]
    assert checked(scene) == {("a", "world")}


def test_each_permission_names_its_reason(tmp_path: Path) -> None:
    inner = body("b", geom("g"), HINGE, body("c", geom("h"), body("d", geom("i"))))
    bits = geom("z", 'contype="2" conaffinity="4"')
    text = model(
        body("a", geom("f"), geom("e"), FREE, inner),
        body("x", bits, FREE),
        after='<contact><exclude body1="a" body2="d"/></contact>',
    )
    reasons = allowed(load(tmp_path, text))
    assert reasons["a/f", "a/e"] == "one rigid link"
    assert reasons["a/f", "b"] == "MJCF: parent and child"
    assert reasons["b", "c"] == "MJCF: welded together, no joint between"
    assert reasons["a/e", "d"] == "MJCF: exclude"
    assert reasons["b", "x"] == (
        "MJCF: contype 1, conaffinity 1 and contype 2, conaffinity 4 share no bit"
    )
