"""Draw docs/tradeoff.svg and its dark twin: `python -m docs.tradeoff`.

Takes minutes; times are of the machine that runs it.
"""

from __future__ import annotations

from pathlib import Path

from bench.drawing import write_both
from satcheck.audit.studied_pair import two_of
from satcheck.audit.tradeoff import tradeoff
from satcheck.cli.formats.tradeoff_plot import draw
from satcheck.scene import load_scene

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "sample_meshes"
# With the seconds that each may take.
PAIRS = (
    ("box.obj", "box_pushed.stl", 20.0),
    ("l_bracket.obj", "peg_in_notch.ply", 30.0),
    ("kettle.obj", "snowflake.obj", 110.0),
)


def main() -> None:
    results = []
    for a, b, budget in PAIRS:
        scene = load_scene([SAMPLES / a, SAMPLES / b])
        results.append(tradeoff(two_of(scene, None), budget=budget))
    write_both(HERE / "tradeoff.svg", lambda dark: draw(results, dark=dark))


if __name__ == "__main__":
    main()
