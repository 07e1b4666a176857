"""Draw docs/tradeoff.svg: `python -m docs.tradeoff`. Takes minutes; times are of this machine."""

from __future__ import annotations

from pathlib import Path

from satcheck.cli.report.tradeoff_plot import svg
from satcheck.scene import load_scene
from satcheck.studies.tradeoff import tradeoff

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "sample_meshes"
# With the seconds that each may take.
PAIRS = (
    ("box.obj", "box_pushed.stl", 20.0),
    ("l_bracket.obj", "peg_in_notch.ply", 30.0),
    ("kettle.obj", "snowflake.obj", 110.0),
)


def main() -> None:
    runs = [
        tradeoff(load_scene([SAMPLES / a, SAMPLES / b]), budget=budget) for a, b, budget in PAIRS
    ]
    pairs = [pair for run in runs for pair in run.pairs]
    (HERE / "tradeoff.svg").write_text(svg(pairs), encoding="utf-8")


if __name__ == "__main__":
    main()
