"""What becomes of IFC files that nobody prepared: which are read, and why the others are not.

    python -m bench.ifc_files FOLDER [-o files.json]

Reads and checks every IFC file below FOLDER. Prints a line for each file that is not wholly read,
and a table with a row for each folder.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

from msgspec import Struct, to_builtins

from satcheck.audit import Settings, check
from satcheck.scene import load_scene

ENDINGS = frozenset((".ifc", ".ifczip", ".ifcxml"))
SECONDS = 300.0  # for one file; the default is a minute
SETTINGS = Settings(depth=False, list_pruned=False)


class Outcome(Struct):
    """unreadable: the errors of bodies. refused: the error of the whole file. verdict: of the
    check; empty with fewer than two bodies."""

    file: str
    seconds: float
    bodies: int = 0
    unreadable: tuple[str, ...] = ()
    refused: str = ""
    verdict: str = ""

    @property
    def kind(self) -> str:
        if self.refused:
            return "refused"
        return "in part" if self.unreadable else "read"


def outcome(path: Path) -> Outcome:
    start = time.monotonic()
    scene = load_scene([path], seconds_per_file=SECONDS)
    reasons = tuple(f"{each.issue.code}: {each.issue.message}" for each in scene.unreadable)
    found = Outcome(path.name, time.monotonic() - start, len(scene.bodies), reasons)
    if not scene.bodies:
        found.refused, found.unreadable = reasons[0], ()
    elif len(scene.bodies) > 1:
        found.verdict = check(scene, SETTINGS).summary.verdict
    return found


def table(outcomes: dict[str, list[Outcome]]) -> Iterator[str]:
    yield "| files | read | in part | refused | bodies | unreadable bodies | median s | largest s |"
    yield "|---|---|---|---|---|---|---|---|"
    everything = [each for listed in outcomes.values() for each in listed]
    for name, listed in (*outcomes.items(), ("all", everything)):
        kinds = Counter(each.kind for each in listed)
        seconds = sorted(each.seconds for each in listed)
        bodies = sum(each.bodies for each in listed)
        lost = sum(len(each.unreadable) for each in listed)
        counts = [kinds[kind] for kind in ("read", "in part", "refused")]
        middle, most = seconds[len(seconds) // 2], seconds[-1]
        cells = [f"{name}: {len(listed)}", *counts, bodies, lost, f"{middle:.2f}", f"{most:.1f}"]
        yield f"| {' | '.join(map(str, cells))} |"


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path)
    options = parser.parse_args(arguments)
    outcomes: dict[str, list[Outcome]] = {}
    for path in sorted(p for p in options.folder.rglob("*") if p.suffix.lower() in ENDINGS):
        found = outcome(path)
        outcomes.setdefault(path.relative_to(options.folder).parts[0], []).append(found)
        for reason in (found.refused, *found.unreadable[:1]):
            if reason:
                say(f"{found.kind}: {found.file}: {reason}")
        if options.output:
            options.output.write_text(json.dumps(to_builtins(outcomes), indent=1))
    for line in table(outcomes):
        say(line)
    return 0


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
