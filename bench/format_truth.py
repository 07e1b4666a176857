"""Compares satcheck with stated truth about files: bodies, world boxes, relations and host rules.

    python -m bench.format_truth FOLDER [ifc step ...]

FOLDER/formats.json states, for each file, the bodies with their world boxes, and the relation of
each pair whose boxes come close (overlap, touch, apart; surfaces_meet: a body is open). All other
pairs are apart. A pair that it calls doubtful counts neither way. Prints a line for each file, and
one for each difference.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit import Report, Settings, check
from satcheck.scene import Scene, load_scene

BOX_TOLERANCE = 1e-6  # of the size of the scene: the digits that the truth states
TOUCH = 1e-6  # metres: up to this gap, the truth calls a pair touching
WORDS = {
    "penetrating": "overlap",
    "contains": "overlap",
    "inside": "overlap",
    "coincident": "overlap",
    "touching": "touch",
    "near": "apart",
    "separated": "apart",
}

Pair = frozenset[str]


class Compared(Struct):
    """right, of: numbers of bodies, boxes and pairs; hosts: pairs with a relation that a rule of
    the file covers. doubtful: pairs that do not count."""

    bodies: int = 0
    boxes: int = 0
    pairs: int = 0
    of_bodies: int = 0
    of_pairs: int = 0
    hosts: int = 0
    of_hosts: int = 0
    doubtful: int = 0


def main(arguments: Sequence[str]) -> int:
    folder, wanted = Path(arguments[0]), arguments[1:]
    files = json.loads((folder / "formats.json").read_text())["files"]
    wrong = 0
    for name, truth in files.items():
        if wanted and name.partition("/")[0] not in wanted:
            continue
        seen = Compared()
        differences = list(compare(folder / name, truth, seen))
        wrong += len(differences)
        say(
            f"{name}: bodies {seen.bodies}/{seen.of_bodies}, boxes {seen.boxes}/{seen.of_bodies}, "
            f"pairs {seen.pairs}/{seen.of_pairs}, hosts {seen.hosts}/{seen.of_hosts}, "
            f"doubtful {seen.doubtful}"
        )
        for line in differences:
            say(f"  {line}")
    say(f"{wrong} differences")
    return 1 if wrong else 0


def say(line: str) -> None:
    sys.stdout.write(line + "\n")


def compare(path: Path, truth: Mapping[str, Any], seen: Compared) -> Iterator[str]:
    """The differences, one a line; counts what is right."""
    scene = load_scene([path])
    yield from _compare_boxes(scene, truth, seen)
    known = {_pair(each): each for each in truth["pairs_whose_boxes_come_within_10mm"]}
    bare = replace(scene, rules=(), ignore_within_groups=frozenset())
    relations = _relations(check(bare, Settings(tolerance=TOUCH, list_pruned=True)))
    for a, b in combinations((body["name"] for body in truth["bodies"]), 2):
        pair = frozenset((a, b))
        stated = known.get(pair, {"relation": "apart"})
        if "doubtful" in stated:
            seen.doubtful += 1
            continue
        seen.of_pairs += 1
        relation = relations.get(pair, "apart")
        if relation in _meant(stated["relation"]):
            seen.pairs += 1
        else:
            yield f"{a} and {b}: {relation}, not {stated['relation']}"
    yield from _compare_hosts(scene, known, seen)


def _meant(stated: str) -> tuple[str, ...]:
    return ("overlap", "touch") if stated == "surfaces_meet" else (stated,)


def _pair(stated: Mapping[str, Any]) -> Pair:
    return frozenset((stated["a"], stated["b"]))


def _relations(report: Report) -> dict[Pair, str]:
    return {
        frozenset((finding.a, finding.b)): WORDS.get(finding.relation, finding.relation)
        for finding in report.findings
    }


def _compare_boxes(scene: Scene, truth: Mapping[str, Any], seen: Compared) -> Iterator[str]:
    bodies = {body.id: body for body in scene.bodies}
    corners = [corner for body in truth["bodies"] for corner in body["box"]]
    size = max(max(axis) - min(axis) for axis in zip(*corners, strict=True))
    seen.of_bodies += len(truth["bodies"])
    for stated in truth["bodies"]:
        name = stated["name"]
        if name not in bodies:
            yield f"{name}: no such body"
            continue
        seen.bodies += 1
        box = bodies[name].world_mesh().bounds
        pairs = zip(sum(map(tuple, box), ()), sum(map(tuple, stated["box"]), ()), strict=True)
        error = max(abs(own - true) for own, true in pairs)
        if error <= BOX_TOLERANCE * size:
            seen.boxes += 1
        else:
            yield f"{name}: its box is {error:.3g} off"
    stated_names = {body["name"] for body in truth["bodies"]}
    for name in bodies:
        if name not in stated_names:
            yield f"{name}: a body that the truth lacks"


def _compare_hosts(
    scene: Scene, known: Mapping[Pair, Mapping[str, Any]], seen: Compared
) -> Iterator[str]:
    """Pairs with a stated host relation and no rule of the file, and the reverse."""
    covered = {pair for rule in scene.rules for pair in _pairs_of(rule, scene)}
    for pair, stated in known.items():
        has_host = bool(stated.get("host_relation"))
        seen.of_hosts += has_host
        if has_host == (pair in covered):
            seen.hosts += has_host
        else:
            missing = "no rule covers" if has_host else "a rule covers"
            yield f"{' and '.join(sorted(pair))}: {missing} {stated.get('host_relation')}"


def _pairs_of(rule: Any, scene: Scene) -> Iterator[Pair]:
    for a in rule.a.select(scene.bodies):
        for b in rule.b.select(scene.bodies):
            if a.id != b.id:
                yield frozenset((a.id, b.id))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
