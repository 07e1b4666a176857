"""Rungs on pairs whose truth is known."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from satcheck.audit.tradeoff import RUNGS, Budget, PairTradeoff, Row, Rung, Tradeoff, tradeoff
from satcheck.audit.tradeoff import measure as measuring
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from tests.audit.shapes import open_box, unit_box, write

SAMPLES = Path(__file__).resolve().parents[3] / "sample_meshes"
LABELS = [rung.label for rung in RUNGS]


def found(*names: str, **options: float) -> Tradeoff:
    return tradeoff(load_scene([SAMPLES / name for name in names]), repeat=1, **options)  # type: ignore[arg-type]


def rows(pair: PairTradeoff) -> dict[str, Row]:
    return {row.rung.label: row for row in pair.rows}


def without_fine_parts(rungs: Sequence[Rung]) -> list[Rung]:
    """CoACD takes its seconds for each threshold."""
    return [rung for rung in rungs if rung.threshold in (None, 0.05)]


def test_boxes_are_exact_on_every_rung_from_oriented_boxes_on() -> None:
    run = found("box.obj", "box_pushed.stl")
    (pair,) = run.pairs
    assert run.complete
    assert pair.truth.relation == "penetrating"
    seen = rows(pair)
    assert list(seen) == LABELS
    for label, row in seen.items():
        assert row.right, label
        if label not in ("aabb", "boolean"):
            assert row.figure is not None
            assert row.error == 0.0, label
            assert row.figure.value == pytest.approx(-1.0, rel=1e-12)
    # Hulls settle it: what climbs higher is the same again, and no choice of its own.
    assert seen["parts 0.1"].settled_by == seen["exact"].settled_by == "hull"
    assert {label for label, row in seen.items() if row.on_front} <= {"aabb", "obb", "hull"}
    assert seen["hull"].on_front
    assert seen["boolean"].volume == pytest.approx(1.0 * 1.75 * 1.5, abs=1e-9)
    assert pair.default is not None
    assert (pair.default.rung, pair.default.settled) == ("hull", True)
    assert "both convex" in pair.default.why


def test_a_peg_in_a_notch_is_apart_for_the_finer_rungs_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(measuring, "RUNGS", without_fine_parts(RUNGS))
    (pair,) = found("l_bracket.obj", "peg_in_notch.ply").pairs
    seen = rows(pair)
    assert pair.truth.relation == "separated"
    assert pair.truth.figure is not None
    assert pair.truth.figure.value == 1.0
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
    assert seen["exact"].on_front
    assert pair.default is not None
    assert pair.default.rung == "exact"


def test_a_spent_budget_is_said_of_every_rung() -> None:
    run = found("box.obj", "box_pushed.stl", budget=1e-9)
    assert not run.complete
    (pair,) = run.pairs
    for row in rows(pair).values():
        assert (row.state, row.reason) == ("not run", "budget")
    assert pair.truth.relation is None
    assert pair.truth.reason == "the exact rung was not run: budget"


def test_a_rung_that_is_stopped_is_not_begun_with_finer_parts() -> None:
    a, b = load_scene([SAMPLES / "l_bracket.obj", SAMPLES / "peg_in_notch.ply"]).bodies
    seen = rows(measuring.measure_pair((a, b), 2, Budget(60.0, per_rung=1e-3)))
    stopped = "stopped after 0.001 s"
    assert {label: row.reason for label, row in seen.items() if row.state == "not run"} == {
        "parts 0.5": f"budget: {stopped}",
        **{
            row.rung.label: f"budget: parts 0.5 was {stopped}"
            for row in seen.values()
            if (row.rung.threshold or 1.0) < 0.5
        },
        "boolean": f"budget: {stopped}",
    }
    for label in ("aabb", "obb", "hull", "exact"):
        cold, cpu = seen[label].cold, seen[label].cpu
        assert cold is not None
        assert cpu is not None
        assert len(cold.runs) == len(cpu.runs) >= 1


def test_a_failing_rung_is_a_row_and_the_others_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> object:
        raise RuntimeError("made up")

    monkeypatch.setattr(measuring, "ask_volume", broken)
    monkeypatch.setattr(measuring, "ask_parts", broken)
    run = found("box.obj", "box_pushed.stl")
    assert not run.complete
    for label, row in rows(run.pairs[0]).items():
        if label == "boolean" or label.startswith("parts"):
            assert row.state == "failed"
            assert row.reason == "internal error: RuntimeError: made up"
        else:
            assert row.state == "answered", label


def test_what_is_no_solid_has_no_volume() -> None:
    (pair,) = found("open_box.off", "cube.off", budget=20.0).pairs
    boolean = rows(pair)["boolean"]
    assert boolean.state == "failed"
    assert "no solid" in (boolean.reason or "")
    # The cube lies in a box without a lid: inside, whatever fills the hole.
    assert pair.truth.relation == "contains"
    assert rows(pair)["hull"].right is True


def test_what_a_hole_leaves_open_is_no_verdict(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(measuring, "RUNGS", [*RUNGS[:3], measuring.EXACT])
    files = write(tmp_path, a=open_box(), b=unit_box(1, 1, 3.5))
    (pair,) = tradeoff(load_scene(files)).pairs
    exact = rows(pair)["exact"]
    assert exact.relation == "indeterminate"
    assert (exact.overlap, exact.proven, exact.right, exact.figure) == (None, False, None, None)
    assert "the hole of a" in (exact.reason or "")


def test_of_a_scene_the_pairs_whose_boxes_meet(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measuring, "RUNGS", (measuring.EXACT,))
    run = found("box.obj", "box_pushed.stl", "inside_out.stl", "far_a.obj", pairs=1)
    assert [(pair.a, pair.b) for pair in run.pairs] == [("box", "box_pushed")]
    assert run.left_out == 1
    with pytest.raises(SatcheckError, match="boxes that meet"):
        found("box.obj", "far_a.obj", "peg_in_notch.ply")
