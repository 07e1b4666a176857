"""The hard cases through other libraries: `python -m bench.hard_cases [--only fcl coal ...]`.

Each peer runs in a child process (bench/peers); what is not installed is left out and said so:
`pip install '.[peers]'`, and for parry `cargo build --release` in bench/peers/parry, which puts its
program where CARGO_TARGET_DIR says.

Judged by the same exact truth as satcheck, but with every allowance: touching pairs have no right
yes or no and are left out, and a distance counts as off only beyond 1e-6 of the size of the pair.
Prints markdown: per category and peer `wrong / none / off` of the pairs it takes.
"""

from __future__ import annotations

import argparse
import importlib.util
import math
import os
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np

from bench.peers.child import answers
from bench.peers.protocol import Answer, Body, line_of
from satcheck import core
from tests.hard_cases import mesh_families
from tests.hard_cases.case import Vertices
from tests.hard_cases.families import FAMILIES
from tests.hard_cases.mesh_case import MeshData

# What a peer's distance may be off by, as a part of the size of the pair: a hundred times what
# float32 costs, a million times what float64 does.
ALLOWED = 1e-6
PARRY = Path(__file__).parent / "peers" / "parry"


@dataclass(frozen=True, slots=True)
class Question:
    """overlap: the right answer, None where the two touch. distance: None where not asked."""

    category: str
    name: str
    line: str
    overlap: bool | None
    distance: float | None
    size: float


@dataclass(slots=True)
class Tally:
    """wrong: yes or no. none: crash, hang, exception, NaN. off: the distance."""

    pairs: int = 0
    unsupported: int = 0
    wrong: int = 0
    none: int = 0
    off: int = 0
    worst: float = 0.0

    def text(self) -> str:
        taken = f"{self.wrong} / {self.none} / {self.off}"
        return f"{taken} of {self.pairs - self.unsupported}" if self.unsupported else taken


def convex_questions() -> Iterator[Question]:
    for family in FAMILIES:
        for pair in family.cases(0):
            truth = pair.truth()
            overlap = None if truth.outcome == "touching" else truth.outcome == "penetrating"
            line = line_of(hull(pair.a), hull(pair.b))
            distance = float(truth.low)
            yield Question(family.CATEGORY, pair.name, line, overlap, distance, pair.size or 1.0)


def mesh_questions() -> Iterator[Question]:
    for family in mesh_families.FAMILIES:
        for pair in family.cases(0):
            touching = pair.relation == "touching"
            overlap = None if touching else pair.relation != "separated"
            yield Question(
                family.CATEGORY, pair.name, line_of(mesh(pair.a), mesh(pair.b)), overlap, None, 1.0
            )


def hull(points: Vertices) -> Body:
    """The exact hull; without triangles where it is flat."""
    polytope = core.Mesh(np.array(points), np.zeros((0, 3), np.int64)).convex_hull()
    if polytope.dimension < 3:
        return Body(np.array(polytope.vertices), np.zeros((0, 3), np.int64))
    return Body(np.array(polytope.vertices), np.array(polytope.triangles, np.int64))


def mesh(data: MeshData) -> Body:
    return Body(np.array(data.vertices), np.array(data.triangles, np.int64))


def tally(question: Question, answer: Answer, into: Tally) -> None:
    into.pairs += 1
    if answer.status == "unsupported":
        into.unsupported += 1
    elif answer.status != "ok":
        into.none += 1
    elif question.distance is None:
        into.wrong += question.overlap is not None and answer.overlap != question.overlap
    elif not math.isfinite(answer.distance):
        into.none += 1
    elif question.overlap is not None and answer.overlap != question.overlap:
        into.wrong += 1
    else:
        error = abs(answer.distance - question.distance) / question.size
        into.worst = max(into.worst, error)
        into.off += error > ALLOWED


def peers() -> dict[str, tuple[str, list[str], bool]]:
    """Name: its version, its command, whether it answers for meshes. Only what is installed."""
    found: dict[str, tuple[str, list[str], bool]] = {}
    for name, module, package, meshes in (
        ("FCL", "fcl", "python-fcl", False),
        ("coal", "coal", "coal", False),
        ("MuJoCo", "mujoco", "mujoco", False),
        ("FCL (triangles)", "fcl", "python-fcl", True),
        ("manifold3d", "manifold3d", "manifold3d", True),
    ):
        if importlib.util.find_spec(module) is None:
            sys.stderr.write(f"{name}: not installed, left out\n")
            continue
        script = {"FCL (triangles)": "fcl_mesh", "manifold3d": "manifold"}.get(name, module)
        command = [sys.executable, "-m", f"bench.peers.ask_{script}"]
        found[name] = (version(package), command, meshes)
    target = Path(os.environ.get("CARGO_TARGET_DIR", PARRY / "target"))
    program = target / "release" / "parry-peer"
    if program.exists():
        found["parry (f64)"] = ("0.31.1", [str(program)], False)
    else:
        sys.stderr.write("parry: not built, left out\n")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m bench.hard_cases", description=__doc__)
    parser.add_argument("--only", nargs="*", metavar="PEER", help="words of the names of peers")
    wanted = parser.parse_args().only
    chosen = {
        name: peer
        for name, peer in peers().items()
        if not wanted or any(word.lower() in name.lower() for word in wanted)
    }
    for meshes, questions in ((False, list(convex_questions())), (True, list(mesh_questions()))):
        columns = {}
        for name, (release, command, takes_meshes) in chosen.items():
            if takes_meshes == meshes:
                columns[f"{name} {release}"] = column(questions, command)
        sys.stdout.write(table(questions, columns) + "\n\n")
    return 0


def column(questions: list[Question], command: list[str]) -> dict[str, Tally]:
    tallies: dict[str, Tally] = {}
    given = answers(command, (question.line for question in questions))
    for question, answer in zip(questions, given, strict=True):
        tally(question, answer, tallies.setdefault(question.category, Tally()))
    return tallies


def table(questions: list[Question], columns: dict[str, dict[str, Tally]]) -> str:
    pairs: dict[str, int] = {}
    for question in questions:
        pairs[question.category] = pairs.get(question.category, 0) + 1
    rows = [["category", "pairs", *columns], ["---"] * (2 + len(columns))]
    for category, count in pairs.items():
        rows.append([category, str(count), *(c[category].text() for c in columns.values())])
    worst = (max(tally.worst for tally in c.values()) for c in columns.values())
    rows.append(
        [
            "worst distance / size",
            "",
            *("-" if w == 0 else f"{w:.0e}" if w < 1 else "over 1" for w in worst),
        ]
    )
    return "\n".join(f"| {' | '.join(cells)} |" for cells in rows)


if __name__ == "__main__":
    sys.exit(main())
