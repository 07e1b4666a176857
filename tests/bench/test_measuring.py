"""One pair, measured as it is in a run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from bench.accuracy.case import Effort
from bench.accuracy.corpus import given
from bench.accuracy.measuring import measured
from bench.accuracy.page import Run, page
from satcheck.core.errors import SatcheckError
from tests.bench.made import HEADER, LABELS

SAMPLES = Path(__file__).resolve().parents[2] / "sample_meshes"
EFFORT = Effort(repeat=1, rung_seconds=20.0, pair_seconds=40.0, part_triangles=23)


def test_a_record_has_every_rung_and_makes_a_page() -> None:
    case = given((SAMPLES / "box.obj", SAMPLES / "box_pushed.stl"))
    record = json.loads(json.dumps(measured(case, EFFORT)))
    assert record["triangles"] == [12, 12]
    assert record["size"] == pytest.approx(12**0.5)
    assert record["pair"]["truth"]["relation"] == "penetrating"
    states = {
        row["rung"] if row["threshold"] is None else f"parts {row['threshold']:g}": row["state"]
        for row in record["pair"]["rungs"]
    }
    assert list(states) == LABELS
    assert {label for label, state in states.items() if state != "answered"} == {
        label for label in LABELS if label.startswith("parts")
    }
    (spent,) = record["stages"]
    assert {"reading", "hull", "verify", "placing", "writing"} <= set(spent)
    # The page of a corpus without a pair that hulls leave open.
    process = [{"wall": 0.2, "cpu": 0.1, "megabytes": 25.0}]
    record |= {"case": case.to_dict(), "seconds": 1.0, "process": process}
    made = page(Run(HEADER, [record], ["1 pair"], "", "make", "folder"))
    assert "too many triangles" in made.text


def test_a_file_that_is_no_mesh_is_said(tmp_path: Path) -> None:
    (tmp_path / "x.obj").write_text("v what\n", encoding="utf-8")
    with pytest.raises(SatcheckError, match="1 readable bod"):
        measured(given((SAMPLES / "box.obj", tmp_path / "x.obj")), EFFORT)
