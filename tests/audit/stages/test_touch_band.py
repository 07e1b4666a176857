"""The touch band: what it covers, what it does not, and that the exact relation stays beside it."""

from __future__ import annotations

import math

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


PEG = unit_box(1.5, 3, 1, edge=2.0)  # 0.5 deep in an arm of the bracket
SEED = unit_box(0.75, 4, 1)  # inside that arm, 1.25 deep


@pytest.mark.parametrize("depth", [True, False])
@pytest.mark.parametrize(
    ("meshes", "exact", "within", "beyond"),
    [
        ((bracket(), PEG), "penetrating", (0.6, 2.0, 9.0), (0.1, 0.4)),
        ((bracket(), SEED), "contains", (1.01, 1.5, 5.0), (0.1, 0.9)),
        ((bracket(), bracket()), "coincident", (3.0, 9.0), (0.5, 1.5)),
        ((unit_box(), unit_box()), "coincident", (1.0, 5.0), (0.5,)),
        ((unit_box(edge=4.0), unit_box(1, 1, 1)), "contains", (1.5, 2.0, 5.0), (0.9,)),
    ],
    ids=["crossing", "nested", "coincident", "convex coincident", "convex nested"],
)
def test_one_rule_for_every_overlap(tmp_path, meshes, exact, within, beyond, depth):
    scene = scene_of(tmp_path, a=meshes[0], b=meshes[1])
    for tolerance in (*within, *beyond):
        finding = only(check(scene, Settings(tolerance=tolerance, depth=depth)))
        assert finding.relation == ("touching" if tolerance in within else exact), tolerance
        assert finding.exact_relation == exact


@pytest.mark.parametrize("mesh", [PEG, SEED], ids=["crossing", "nested"])
def test_a_wide_band_does_not_make_the_figures_coarser(tmp_path, mesh):
    scene = scene_of(tmp_path, a=bracket(), b=mesh)
    plain = only(check(scene))
    for tolerance in (1.3, 2.0, 9.0):
        finding = only(check(scene, Settings(tolerance=tolerance)))
        assert finding.relation == "touching"
        assert finding.depth <= plain.depth
        assert finding.depth_bounds[0] <= plain.depth
        assert math.hypot(*finding.mtv) <= math.hypot(*plain.mtv)


@pytest.mark.parametrize("accuracy", ["aabb", "obb", "hull", "parts", "exact"])
def test_boxes_that_only_touch_have_no_depth_on_any_rung(tmp_path, accuracy):
    scene = scene_of(tmp_path, a=unit_box(), b=unit_box(1.0))
    finding = only(check(scene, Settings(accuracy=accuracy)))
    proven = accuracy not in ("aabb", "obb")
    assert finding.relation == "touching"
    assert (finding.depth, finding.mtv) == (None, None)
    assert finding.quality == ("exact" if proven else "estimate")
    assert (finding.reason is None) == proven


def test_the_band_is_named(tmp_path):
    scene = scene_of(tmp_path, a=bracket(), b=bracket())
    finding = only(check(scene, Settings(tolerance=1e-3, depth=False)))
    (stage,) = [stage for stage in finding.plan if stage.stage == "touch-band"]
    assert (stage.result, stage.detail) == (
        "deeper",
        "tolerance 0.001, as asked: a point lies deeper in both",
    )


def test_default_band_never_swallows_a_body(tmp_path):
    """Whole numbers far from the origin: half a unit of the last digit would be half a body."""
    far = 4_000_000.0
    a, b = unit_box(far, far), unit_box(far + 0.75, far)
    finding = only(check(scene_of(tmp_path, a=a, b=b)))
    assert finding.tolerance < 0.01
    assert finding.relation == "penetrating"


def test_without_a_band_nothing_below_the_noise_of_a_distance_is_swallowed(tmp_path):
    ulp = 2.0**-52
    cases = ((1 - ulp / 2, "penetrating"), (1.0, "touching"), (1 + ulp, "separated"))
    for shift, relation in cases:
        scene = scene_of(tmp_path, a=unit_box(), b=unit_box(shift, 0.25, 0.5))
        finding = only(check(scene, Settings(tolerance=0.0)))
        assert finding.exact_relation == relation
        assert finding.relation == relation
