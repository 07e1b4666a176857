"""Rungs on pairs whose truth is known."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import tradeoff as study
from satcheck.audit.studied_pair import two_of
from satcheck.audit.tradeoff import (
    EXACT,
    RUNGS,
    Rung,
    error_of,
    is_right,
    last_rung,
    tradeoff,
)
from satcheck.core.errors import SatcheckError
from satcheck.report.report import Finding, Stage
from satcheck.report.tradeoff import Row, TradeoffReport, Truth
from satcheck.report.values import Relation
from satcheck.scene import load_scene
from tests.audit.shapes import open_box, unit_box, write

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
# CoACD takes its seconds for each threshold.
FEW = tuple(rung for rung in RUNGS if rung.threshold in (None, 0.05))


def found(*names: str, rungs: tuple[Rung, ...] = RUNGS, budget: float = 60.0) -> TradeoffReport:
    bodies = two_of(load_scene([SAMPLES / name for name in names]), None)
    return tradeoff(bodies, repeat=1, rungs=rungs, budget=budget)


def rows(report: TradeoffReport) -> dict[str, Row]:
    return {row.label: row for row in report.rungs}


def test_boxes_are_exact_on_every_rung_from_oriented_boxes_on() -> None:
    report = found("box.obj", "box_pushed.stl")
    assert report.complete
    assert report.truth.relation == "penetrating"
    seen = rows(report)
    assert list(seen) == [name if size is None else f"{name} {size:g}" for name, size in RUNGS]
    for label, row in seen.items():
        assert row.right, label
        if label not in ("aabb", "boolean"):
            assert row.signed_distance == pytest.approx(-1.0, rel=1e-12)
            assert row.error == 0.0, label
    # Hulls settle it: what climbs higher is the same again, and no choice of its own.
    assert seen["parts 0.1"].settled_by == seen["exact"].settled_by == "hull"
    assert seen["boolean"].volume == pytest.approx(1.0 * 1.75 * 1.5, abs=1e-9)
    assert report.default == "hull"


def test_a_peg_in_a_notch_is_apart_for_the_finer_rungs_only() -> None:
    report = found("l_bracket.obj", "peg_in_notch.ply", rungs=FEW)
    seen = rows(report)
    assert report.truth == Truth("separated", (1.0, 1.0), None)
    for label in ("aabb", "obb", "hull"):
        assert seen[label].relation == "penetrating"
        assert seen[label].right is False
        assert not seen[label].proven
        assert (seen[label].error or 0.0) < -1.0
    # Out of the hull of the L by sqrt(2), and truly 1 apart.
    assert seen["hull"].error == pytest.approx(-1.0 - 2.0**0.5)
    for label in ("parts 0.05", "exact", "boolean"):
        assert seen[label].right, label
    part = seen["parts 0.05"]
    assert part.proven
    assert part.cached is not None
    assert -0.1 < (part.error or 0.0) <= 0.0
    assert seen["exact"].error == 0.0
    assert report.default == "exact"


def test_a_spent_budget_is_said_of_every_rung() -> None:
    report = found("box.obj", "box_pushed.stl", budget=1e-9)
    assert not report.complete
    for row in report.rungs:
        assert (row.state, row.reason) == ("not run", "budget")
    assert report.default is None
    assert report.truth == Truth(None, None, "the exact rung was not run: budget")


def test_a_rung_that_has_no_more_time_is_not_run_and_no_failure() -> None:
    bodies = two_of(load_scene([SAMPLES / "l_bracket.obj", SAMPLES / "peg_in_notch.ply"]), None)
    seen = rows(tradeoff(bodies, repeat=2, rung_seconds=1e-3))
    silent = {label: (row.state, row.reason) for label, row in seen.items() if row.cold is None}
    dear = [label for label in seen if label.startswith("parts") or label == "boolean"]
    assert silent == dict.fromkeys(dear, ("not run", "budget"))
    for label in ("aabb", "obb", "hull", "exact"):
        cold, cpu = seen[label].cold, seen[label].cpu
        assert cold is not None
        assert cpu is not None
        assert cold.low <= cold.median <= cold.high
        assert cold.runs == cpu.runs >= 1


def test_a_failing_rung_is_a_row_and_the_others_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = study.run

    def broken(rung: Rung, *given: object) -> object:
        if rung.name in ("parts", "boolean"):
            raise RuntimeError("made up")
        return whole(rung, *given)  # type: ignore[arg-type]

    monkeypatch.setattr(study, "run", broken)
    report = found("box.obj", "box_pushed.stl")
    assert not report.complete
    for label, row in rows(report).items():
        if label == "boolean" or label.startswith("parts"):
            assert row.state == "failed"
            assert row.reason == "internal error: RuntimeError: made up"
        else:
            assert row.state == "answered", label


def test_what_is_no_solid_has_no_volume() -> None:
    report = found("open_box.off", "cube.off", rungs=FEW, budget=20.0)
    boolean = rows(report)["boolean"]
    assert boolean.state == "failed"
    assert "no solid" in (boolean.reason or "")
    # The cube lies in a box without a lid: inside, whatever fills the hole.
    assert report.truth.relation == "contains"
    assert rows(report)["hull"].right is True
    # A body without an inside has no convex parts.
    assert rows(report)["parts 0.05"].settled_by == "hull"


def test_what_a_hole_leaves_open_is_no_verdict(tmp_path: Path) -> None:
    files = write(tmp_path, a=open_box(), b=unit_box(1, 1, 3.5))
    report = tradeoff(two_of(load_scene(files), None), rungs=[*RUNGS[:3], EXACT])
    exact = rows(report)["exact"]
    assert exact.relation == "indeterminate"
    assert (exact.overlap, exact.proven, exact.right, exact.bounds) == (None, False, None, None)
    assert "the hole of a" in (exact.reason or "")
    assert report.truth.reason == exact.reason
    assert report.default is None


def test_a_pair_of_a_scene_is_named() -> None:
    scene = load_scene([SAMPLES / name for name in ("box.obj", "cube.off", "far_a.obj")])
    assert [body.id for body in two_of(scene, ("far_a", "box"))] == ["far_a", "box"]
    for ids, code in (
        (None, "not-a-pair"),
        (("box", "box"), "not-a-pair"),
        (("box", "x"), "no-such-body"),
    ):
        with pytest.raises(SatcheckError) as raised:
            two_of(scene, ids)
        assert raised.value.code == code


@pytest.mark.parametrize(
    ("value", "error"),
    [(-3.0, -1.0), (-2.0, 0.0), (-1.75, 0.0), (-1.0, 0.5), (0.5, 2.0), (-2.0 - 1e-10, 0.0)],
)
def test_the_error_is_to_the_nearest_value_that_is_possible(value: float, error: float) -> None:
    assert error_of(value, Truth("penetrating", (-2.0, -1.5), None), pad=1e-9) == error


def test_without_bounds_there_is_no_error() -> None:
    assert error_of(-1.0, Truth("separated", None, None), 0.0) is None
    assert error_of(None, Truth("separated", (1.0, 1.0), None), 0.0) is None


@pytest.mark.parametrize(
    ("truth", "overlap", "relation", "right"),
    [
        ("penetrating", True, "penetrating", True),
        ("inside", True, "penetrating", True),
        ("separated", True, "penetrating", False),
        ("touching", True, "penetrating", False),
        ("separated", False, "separated", True),
        ("touching", False, "separated", False),
        ("touching", False, None, True),
        ("penetrating", False, None, False),
        ("penetrating", None, "indeterminate", None),
        (None, True, "penetrating", None),
    ],
)
def test_right_is_what_agrees_about_the_overlap_and_else_about_the_relation(
    truth: Relation | None, overlap: bool | None, relation: Relation | None, right: bool | None
) -> None:
    row = Row(rung="hull", state="answered", overlap=overlap, relation=relation)
    assert is_right(row, Truth(truth, None, None)) is right


MEET = Stage("aabb", "meet", 1.0, "world boxes meet")
UNTURNED = Stage("obb", "skipped", 1.0, "not turned")
APART = Stage("hull", "separated", 1.0, "")
TRIANGLES = Stage("triangles", "separated", 1.0, "")
VERIFIED = Stage("verify", "separated", 1.0, "moved")


def finding(*plan: Stage) -> Finding:
    return Finding(id="f", a="a", b="b", severity="none", relation="separated", plan=plan)


def test_the_last_rung_that_ran_ends_the_climb() -> None:
    assert last_rung(finding(MEET, UNTURNED, APART, VERIFIED)) == "hull"
    assert last_rung(finding(MEET, UNTURNED, TRIANGLES)) == "exact"


def test_what_was_skipped_ended_nothing() -> None:
    assert last_rung(finding(MEET, UNTURNED)) == "aabb"
    assert last_rung(finding()) is None
