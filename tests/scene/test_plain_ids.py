"""Short names for files."""

from __future__ import annotations

import pytest

from satcheck.scene.plain_ids import plain_ids


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
