"""Compares satcheck with stated truth about files: bodies, world boxes, relations and host rules.

    python -m bench.format_truth FOLDER [ifc step ...]

FOLDER/formats.json states, for each file, the bodies with their world boxes, and the relation of
each pair whose boxes come close (overlap, touch, apart; surfaces_meet: a body is open). All other
pairs are apart. A pair that it calls doubtful counts neither way, nor does one of an open body that
satcheck leaves undecided. Prints a line for each file, and
one for each difference.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, product
from pathlib import Path
from typing import Any

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.audit import Report, Settings, check
from satcheck.core.conventions import Bounds
from satcheck.core.curved.placed import curved_shape
from satcheck.core.shapes import is_curved
from satcheck.scene import Body, Scene, load_scene
from satcheck.scene.units import ratio, stated_unit

BOX_TOLERANCE = 1e-6  # of the size of the scene: the digits that the truth states
# Of the extent of a curved body: how far its box may be off, because the truth, or satcheck, has
# the box of facets.
FACETS = 0.0015
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

_WORST_FIRST = ("overlap", "touch", "indeterminate", "apart")
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
    models = {place.parent.name: place.parent for place in path.parent.rglob("model.config")}
    scene = load_scene([path], packages=models, allow_outside=True)
    metres = ratio(stated_unit(scene.units) or "m", "m")
    pieces = _pieces(scene, truth["bodies"])
    yield from _compare_boxes(pieces, truth, metres, seen)
    known = {_pair(each): each for each in truth["pairs_whose_boxes_come_within_10mm"]}
    if len(scene.bodies) + len(scene.unreadable) > 1:
        yield from _compare_relations(scene, truth, known, pieces, metres, seen)
    yield from _compare_hosts(scene, known, pieces, seen)
    named = {id(piece) for each in pieces.values() for piece in each}
    for body in scene.bodies:
        if id(body) not in named:
            yield f"{body.id}: a body that the truth lacks"


def _pieces(scene: Scene, stated: Sequence[Mapping[str, Any]]) -> dict[str, list[Body]]:
    """The bodies that together are one of the truth: a link may have several collisions."""
    if len(stated) == len(scene.bodies) == 1:  # which may lack a name
        return {stated[0]["name"]: list(scene.bodies)}
    return {
        body["name"]: [b for b in scene.bodies if _is_named(b.id, body["name"], body)]
        for body in stated
    }


def _is_named(id_: str, name: str, stated: Mapping[str, Any]) -> bool:
    """Occurrences in STEP files may have the names of their products, with the same number."""
    number = name.rpartition("#")[2] if "#" in name else ""
    products = "/".join(product for _, product in stated.get("instance_and_product_names", ()))
    names = (name, products + (f"-{number}" if number else ""))
    return id_ in names or id_.startswith(f"{name}/")


def _compare_relations(
    scene: Scene,
    truth: Mapping[str, Any],
    known: Mapping[Pair, Mapping[str, Any]],
    pieces: Mapping[str, list[Body]],
    metres: float,
    seen: Compared,
) -> Iterator[str]:
    bare = replace(scene, rules=(), ignore_within_groups=frozenset(), check_static=True)
    # The truth about IFC is that of the facets, and the truth about STEP that of the solids.
    facets = 0.0 if "mesher_linear_deflection_m" in truth["facts"] else None
    settings = Settings(tolerance=TOUCH / metres, surface_tolerance=facets, list_pruned=True)
    relations = _relations(check(bare, settings))
    is_open = {body["name"] for body in truth["bodies"] if body.get("closed") is False}
    for a, b in combinations(pieces, 2):
        stated = known.get(frozenset((a, b)), {"relation": "apart"})
        found = [
            relations.get(frozenset((one.id, other.id)), "apart")
            for one, other in product(pieces[a], pieces[b])
        ]
        relation = min(found, key=_WORST_FIRST.index, default="no body")
        if "doubtful" in stated or (relation == "indeterminate" and {a, b} & is_open):
            seen.doubtful += 1
            continue
        seen.of_pairs += 1
        if relation in _meant(stated["relation"]):
            seen.pairs += 1
        else:
            yield f"{a} and {b}: {relation}, not {stated['relation']}"


def _meant(stated: str) -> tuple[str, ...]:
    return ("overlap", "touch") if stated == "surfaces_meet" else (stated,)


def _pair(stated: Mapping[str, Any]) -> Pair:
    return frozenset((stated["a"], stated["b"]))


def _relations(report: Report) -> dict[Pair, str]:
    return {
        frozenset((finding.a, finding.b)): WORDS.get(finding.relation, finding.relation)
        for finding in report.findings
    }


def _compare_boxes(
    pieces: Mapping[str, list[Body]], truth: Mapping[str, Any], metres: float, seen: Compared
) -> Iterator[str]:
    corners = [corner for body in truth["bodies"] for corner in body["box"]]
    size = max(max(axis) - min(axis) for axis in zip(*corners, strict=True))
    seen.of_bodies += len(truth["bodies"])
    for stated in truth["bodies"]:
        name = stated["name"]
        if not pieces[name]:
            yield f"{name}: no such body"
            continue
        seen.bodies += 1
        boxes = np.array([_bounds(piece) for piece in pieces[name]]) * metres
        box = np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
        true = np.array(stated["box"])
        error = np.abs(box - true).max()
        facets = FACETS if stated.get("curved") or stated.get("planar") is False else 0.0
        if error <= BOX_TOLERANCE * size + facets * (true[1] - true[0]).max():
            seen.boxes += 1
        else:
            yield f"{name}: its box is {error:.3g} m off"


def _bounds(body: Body) -> Bounds:
    if is_curved(body.shape):
        return curved_shape(body.shape, body.transform).bounds()
    return body.world_mesh().bounds


def _compare_hosts(
    scene: Scene,
    known: Mapping[Pair, Mapping[str, Any]],
    pieces: Mapping[str, list[Body]],
    seen: Compared,
) -> Iterator[str]:
    """Pairs with a stated host relation or exclusion and no rule of the file, and the reverse."""
    covered: set[Pair] = set()
    for rule in scene.rules:
        change = covered.difference_update if rule.allowed is False else covered.update
        change(_pairs_of(rule, scene))
    for pair, stated in known.items():
        why = stated.get("host_relation") or stated.get("excluded_by_default")
        seen.of_hosts += bool(why)
        a, b = (pieces[name] for name in pair)
        is_covered = bool(a and b) and all(
            frozenset((x.id, y.id)) in covered for x, y in product(a, b)
        )
        if bool(why) == is_covered:
            seen.hosts += bool(why)
        else:
            missing = "no rule covers" if why else "a rule covers"
            yield f"{' and '.join(sorted(pair))}: {missing} {why or ''}".rstrip()


def _pairs_of(rule: Any, scene: Scene) -> Iterator[Pair]:
    for a in rule.a.select(scene.bodies):
        for b in rule.b.select(scene.bodies):
            if a.id != b.id:
                yield frozenset((a.id, b.id))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
