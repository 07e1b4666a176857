"""Short names for files."""

from __future__ import annotations

import pytest

from satcheck.scene.document import UniqueNames, plain_ids


@pytest.mark.parametrize(
    ("paths", "ids"),
    [
        (["va/part.obj", "vb/other.stl"], ["part", "other"]),
        (["va/part.obj", "vb/part.obj"], ["va/part", "vb/part"]),
        (["vb/part.obj", "x.obj", "va/part.stl"], ["vb/part", "x", "va/part"]),
        (["1/a/p.obj", "2/a/p.obj"], ["1/a/p", "2/a/p"]),
        (["p.obj", "a/p.obj"], ["p", "a/p"]),
        (["p.obj", "p.stl"], ["p.obj", "p.stl"]),
        (["p.obj", "./p.obj", "a/../p.obj"], ["p", "p", "p"]),
        (["-", "p"], ["-", "p"]),
        (["a/..", "a/b/.."], [".", "a"]),
        ([], []),
    ],
)
def test_plain_ids(paths, ids):
    assert plain_ids(paths) == ids


def test_a_name_that_occurs_again_gets_the_next_free_number():
    names = UniqueNames()
    given = [names.unique(name) for name in ("a", "a-3", "a", "a", "a-2", "b", "a")]
    assert given == ["a", "a-3", "a-2", "a-4", "a-2-2", "b", "a-5"]


def test_many_equal_names_take_no_longer_each():
    """Looks, not seconds: each name is asked for a bounded number of times."""
    names = UniqueNames()
    looks = 0

    class Counted(dict):
        def __contains__(self, key):
            nonlocal looks
            looks += 1
            return super().__contains__(key)

    names._given = Counted()
    for _ in range(1000):
        names.unique("a")
    assert looks <= 2000
