"""What the benches of bench/compare.py ask is what their names say."""

from __future__ import annotations

from pathlib import Path

import pytest

import satcheck
from bench.comparison import ask, benches, inputs

# The least and the largest share of pairs that overlap.
SHARES = {"overlap": (0.1, 0.9), "depth": (0.95, 1.0), "distance": (0.0, 0.0)}


@pytest.mark.parametrize("query", benches.CONVEX_QUERIES)
@pytest.mark.parametrize("kind", benches.CONVEX_KINDS)
def test_convex_pairs(kind: str, query: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ask, "SPENT", 0.0)
    monkeypatch.setattr(ask, "FEWEST", 1)
    record = ask.convex(kind, query)
    pairs = len(record["facts"])
    overlaps = record["facts"].count("penetrating")
    others = record["facts"].count("touching" if kind == ask.FLUSH else "separated")
    assert overlaps + others == pairs
    low, high = (0.0, 0.0) if kind == ask.FLUSH else SHARES[query]
    assert low * pairs <= overlaps <= high * pairs
    assert len(record["bounds"]) == (query != "overlap")


@pytest.mark.parametrize("ending", inputs.WRITERS)
def test_every_format_holds_the_whole_ring(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"ring.{ending}"
    path.write_bytes(inputs.WRITERS[ending](inputs.ring(16, 8)))
    (body,) = satcheck.load_scene([path]).bodies
    assert body.file.mesh.triangle_count == 2 * 16 * 8
    assert body.file.health.solid


@pytest.mark.parametrize("query", ["depth", "thickness"])
def test_concave_pairs_overlap(query: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ask, "SPENT", 0.0)
    monkeypatch.setattr(ask, "FEWEST", 1)
    for pair in benches.concave_pairs(tmp_path).values():
        record = ask.concave(query, *pair)
        ((lower, upper),) = record["bounds"]
        assert record["facts"] == ["penetrating"]
        assert 0 < lower <= upper <= 1.02 * lower


def test_nodes_of_a_glb_are_many_and_some_overlap(tmp_path: Path) -> None:
    path = tmp_path / "nodes.glb"
    path.write_bytes(inputs.glb_of_nodes(100))
    report = satcheck.check([path], satcheck.Settings(depth=False))
    assert len(report.bodies) == 71
    assert report.summary.by_relation["penetrating"] > 5
