"""What a person who waits for one pair reads."""

from __future__ import annotations

import numpy as np

from satcheck import core
from satcheck.audit import Settings, check
from satcheck.core.steps import current
from tests.audit.shapes import scene_of
from tests.audit.stages.test_concave_depth import SHIFT, crumpled_ring, faces_of_ring, mesh


def test_long_searches_name_the_pair_and_their_interval(tmp_path, monkeypatch):
    """The core reports here before each search begins, as it does later while one takes long."""
    seen = []

    def reporting(search):
        def replaced(*bodies, progress, **goal):
            progress(-0.25, 0.123456, 0.25)
            seen.append(current())
            return search(*bodies, progress=progress, **goal)

        return replaced

    for name in ("search_depth", "search_thickness"):
        monkeypatch.setattr(core, name, reporting(getattr(core, name)))
    rng = np.random.default_rng(0)
    scene = scene_of(
        tmp_path,
        ring=mesh(crumpled_ring(rng, 12, 5), faces_of_ring(12, 5)),
        nut=mesh(crumpled_ring(rng, 5, 4) + SHIFT, faces_of_ring(5, 4)),
    )
    (finding,) = check(scene, Settings(depth=True)).findings
    assert finding.relation == "penetrating"
    pair = f"{finding.a} and {finding.b}"
    assert f"depth of {pair}: 0 to 0.123, 25 % of the budget" in seen
    assert f"thickness of {pair}: 0 to 0.123, 25 % of the budget" in seen
    assert current() == ""
