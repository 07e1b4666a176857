"""The touch band: what it covers, what it does not, and that the exact relation stays beside it."""

from __future__ import annotations

import pytest

from satcheck.audit import Settings, check
from tests.audit.shapes import bracket, scene_of, unit_box

SLIP = 1e-9


def only(report):
    (finding,) = report.findings
    return finding


@pytest.mark.parametrize(
    ("shift", "exact"),
    [(1.0, "touching"), (1.0 - SLIP, "penetrating"), (1.0 + SLIP, "separated")],
)
def test_convex(tmp_path, shift, exact):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(shift))
    finding = only(check(scene, Settings(tolerance=1e-6)))
    assert (finding.relation, finding.exact_relation) == ("touching", exact)
    assert (finding.severity, finding.tolerance) == ("note", 1e-6)


@pytest.mark.parametrize("shift", [1.0 - SLIP, 1.0 + SLIP])
def test_without_a_band_the_exact_relation_stands(tmp_path, shift):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(shift))
    finding = only(check(scene, Settings(tolerance=0.0)))
    assert finding.relation == finding.exact_relation != "touching"


def test_real_gaps_and_depths_are_not_swallowed_by_default(tmp_path):
    for shift, relation in ((1 + 1e-5, "separated"), (1 - 1e-5, "penetrating")):
        scene = scene_of(tmp_path, a=unit_box(), b=unit_box(shift))
        assert only(check(scene)).relation == relation


@pytest.mark.parametrize(
    ("x", "y", "exact"),
    [
        (2.0, 3.0, "touching"),
        (2.0 - SLIP, 3.0, "penetrating"),
        (2.0 + SLIP, 3.0, "separated"),
        (2.0 - SLIP, 2.0 - SLIP, "penetrating"),
    ],
    ids=["flush", "pushed in", "pulled off", "pushed into the corner"],
)
def test_in_the_notch_of_a_concave_body(tmp_path, x, y, exact):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(x, y, 1))
    finding = only(check(scene, Settings(tolerance=1e-6)))
    assert (finding.relation, finding.exact_relation) == ("touching", exact)
    if exact == "penetrating":
        assert finding.mtv_verified
        assert finding.depth <= 1e-6
    else:
        assert finding.depth is None


def test_a_deep_concave_pair_is_not_nudged(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=unit_box(1.5, 3, 1))
    finding = only(check(scene, Settings(tolerance=1e-6, depth=False)))
    assert finding.relation == "penetrating"
    assert [s.result for s in finding.plan if s.stage == "touch-band"] == ["deeper"]


def test_default_band_never_swallows_a_body(tmp_path):
    """Whole numbers far from the origin: half a unit of the last digit would be half a body."""
    far = 4_000_000.0
    a, b = unit_box(far, far), unit_box(far + 0.75, far)
    finding = only(check(scene_of(tmp_path, a=a, b=b)))
    assert finding.tolerance < 0.01
    assert finding.relation == "penetrating"
