"""Which pairs a placed_bodies asks about, counted without going through them."""

from __future__ import annotations

from itertools import combinations

import pytest
from msgspec.structs import replace

from satcheck.audit.bodies import BodyCache, place
from satcheck.audit.settings import Settings
from satcheck.core.shapes import Box
from satcheck.scene import Body, Scene, Unreadable
from satcheck.scene.inspect import shape_file
from satcheck.scene.issue import issue

FILE = shape_file(Box((1.0, 1.0, 1.0)), "test.toml")
GROUPS = [(), ("a",), ("a",), ("a", "b"), ("b",), ("b", "c"), ("c",), ("d",), ("d",), ("c", "a")]


@pytest.mark.parametrize("ignored", ["", "a", "ab", "abc", "abcd", "x"])
def test_a_pair_is_ignored_when_both_are_in_one_ignored_group(ignored):
    bodies = tuple(Body(f"b{k}", "", FILE, groups=groups) for k, groups in enumerate(GROUPS))
    scene = Scene("", None, bodies, ignore_within_groups=frozenset(ignored))
    placed_bodies = place(scene, Settings())
    asked = {
        (i, j)
        for i, j in combinations(range(len(GROUPS)), 2)
        if not set(GROUPS[i]) & set(GROUPS[j]) & set(ignored)
    }
    assert set(placed_bodies.book.checked_pairs()) == asked
    assert placed_bodies.book.count() == (len(asked), 0)


def test_what_stays_where_it_is_is_placed_once():
    body = Body("a", "", FILE, transform=(1.0, 0, 0, 3.0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0))
    known = BodyCache()
    first = place(Scene("", None, (body,)), Settings(), known)
    again = place(Scene("", None, (body,)), Settings(), known)
    moved = place(Scene("", None, (replace(body, transform=None),)), Settings(), known)
    assert again.placed[0] is first.placed[0]
    assert moved.placed[0].bounds == ((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    assert moved.placed[0].shared is first.placed[0].shared


def test_bodies_share_a_mesh_that_was_not_hashed():
    plain = replace(FILE, sha256=None)
    other = replace(shape_file(Box((2.0, 1.0, 1.0)), "test.toml"), sha256=None)
    files = (plain, replace(plain, units="mm"), other)
    bodies = tuple(Body(f"b{k}", "", file) for k, file in enumerate(files))
    placed_bodies = place(Scene("", None, bodies), Settings())
    first, same, differs = (placed_bodies.placed[k].shared for k in range(3))
    assert first is same
    assert first is not differs


def test_an_unreadable_body_is_in_its_groups():
    lost = Unreadable("lost", "gone.obj", issue("file-not-found", "gone"), ("a",))
    bodies = tuple(Body(f"b{k}", "", FILE, groups=(group,)) for k, group in enumerate("ab"))
    scene = Scene("", None, bodies, (lost,), frozenset("a"), order=("b0", "lost", "b1"))
    placed_bodies = place(scene, Settings())
    assert [(i, j) for i, j, _ in placed_bodies.undecidable_pairs()] == [(1, 2)]
    assert placed_bodies.book.count() == (2, 0)
