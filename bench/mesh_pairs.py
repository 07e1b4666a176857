"""The mesh tier beside BVH libraries: two meshes of 70,000 triangles, two trees and one question.

    python bench/mesh_pairs.py [A.obj B.obj ...] [--rounds 7] [--json FILE]

Without files the pairs are made here: two bumpy rings, placed in five ways. Files are taken in
twos, at the place they have. satcheck decides the exact relation of two solids (of two surfaces
where one is not closed); python-fcl and coal, where they are installed, say whether two triangles
meet and stop at the first contact: an enclosed body is "apart" to them. The libraries take turns in
every round; printed is the fastest wall time in milliseconds to build both trees, and to ask.
coal: BVHModelOBBRSS in double.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.metadata
import json
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satcheck import core
from satcheck.scene import load_scene

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Soup:
    """vertices (n, 3), triangles (m, 3) uint32; solid: closed, with an inside."""

    vertices: Floats
    triangles: NDArray[np.uint32]
    solid: bool = True


Pair = tuple[Soup, Soup]


@dataclass(frozen=True, slots=True)
class Library:
    """build(mesh) makes what is asked about; ask(a, b) gives the answer in words."""

    name: str
    build: Callable[[Soup], Any]
    ask: Callable[[Any, Any], str]


def ring(
    minor: float, seed: int, around: int = 250, across: int = 140, *, shuffled: bool = True
) -> Soup:
    """A torus of major radius 2 about z with bumps, its vertices and triangles in random order;
    not shuffled: in the order of the surface."""
    rng = np.random.default_rng(seed)
    u, v = np.meshgrid(
        2 * np.pi * np.arange(around) / around,
        2 * np.pi * np.arange(across) / across,
        indexing="ij",
    )
    bumps = np.sin(5 * u + 3 * v) + np.cos(7 * v - 4 * u) + 0.2 * rng.normal(size=u.shape)
    radius = minor * (1 + 0.03 * bumps)
    out = 2 + radius * np.cos(v)
    points = np.stack([out * np.cos(u), out * np.sin(u), radius * np.sin(v)], axis=-1)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    i2, j2 = (i + 1) % around, (j + 1) % across
    p, q, r, s = i * across + j, i2 * across + j, i2 * across + j2, i * across + j2
    faces = [np.stack(t, axis=-1).reshape(-1, 3) for t in ((p, q, r), (p, r, s))]
    if not shuffled:
        in_turn = np.stack(faces, axis=1).reshape(-1, 3)
        return Soup(points.reshape(-1, 3), in_turn.astype(np.uint32))
    place = rng.permutation(points.size // 3)
    vertices = np.empty((len(place), 3))
    vertices[place] = points.reshape(-1, 3)
    return Soup(vertices, place[rng.permutation(np.concatenate(faces))].astype(np.uint32))


def made_pairs() -> dict[str, Pair]:
    """ "shells" run side by side a thousandth of their size apart, all the way round."""
    upright = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    other = ring(0.7, 2)

    def linked(gap: float) -> Soup:
        return Soup(other.vertices @ upright.T + np.array([2 + gap, 0, 0]), other.triangles)

    return {
        "linked": (ring(0.7, 1), linked(0.0)),
        "near miss": (ring(0.7, 1), linked(0.53)),
        "crossing": (ring(0.7, 1), linked(0.9)),
        "enclosed": (ring(0.7, 1), ring(0.3, 2)),
        "shells": (ring(0.7, 1), ring(0.6993, 1)),
    }


def read_pairs(paths: list[Path]) -> dict[str, Pair]:
    bodies = load_scene([str(p) for p in paths]).bodies
    soups = [
        Soup(np.array(b.file.mesh.vertices), np.array(b.file.mesh.triangles), b.file.health.solid)
        for b in bodies
    ]
    twos = zip(paths[::2], paths[1::2], soups[::2], soups[1::2], strict=True)
    return {f"{p.stem} x {q.stem}": (a, b) for p, q, a, b in twos}


def satcheck_library() -> Library:
    def build(soup: Soup) -> core.Surface:
        return core.Surface(core.Mesh(soup.vertices, soup.triangles), soup.solid)

    def ask(a: core.Surface, b: core.Surface) -> str:
        return core.mesh_relation(a, b).relation

    return Library("satcheck", build, ask)


def coal_library(coal: Any) -> Library:
    here, request = coal.Transform3s(), coal.CollisionRequest()
    request.num_max_contacts = 1

    def build(soup: Soup) -> Any:
        model = coal.BVHModelOBBRSS()
        model.beginModel(len(soup.triangles), len(soup.vertices))
        model.addVertices(soup.vertices)
        model.addTriangles(soup.triangles.astype(np.int64))
        model.endModel()
        model.computeLocalAABB()
        return model

    def ask(a: Any, b: Any) -> str:
        result = coal.CollisionResult()
        coal.collide(a, here, b, here, request, result)
        return "meet" if result.isCollision() else "apart"

    return Library("coal", build, ask)


def fcl_library(fcl: Any) -> Library:
    def build(soup: Soup) -> Any:
        model = fcl.BVHModel()
        model.beginModel(len(soup.vertices), len(soup.triangles))
        model.addSubModel(soup.vertices, soup.triangles)
        model.endModel()
        return fcl.CollisionObject(model)

    def ask(a: Any, b: Any) -> str:
        request = fcl.CollisionRequest(num_max_contacts=1)
        return "meet" if fcl.collide(a, b, request, fcl.CollisionResult()) else "apart"

    return Library("python-fcl", build, ask)


def libraries() -> tuple[list[Library], list[str]]:
    """Those that are installed, satcheck first, and a line on each with its version."""
    found, notes = [satcheck_library()], [f"satcheck {importlib.metadata.version('satcheck')}"]
    others = (("coal", "coal", coal_library), ("python-fcl", "fcl", fcl_library))
    for package, module, make in others:
        try:
            found.append(make(importlib.import_module(module)))
            notes.append(f"{package} {importlib.metadata.version(package)}")
        except ImportError:
            notes.append(f"{package} is not installed")
    return found, notes


def measure(pair: Pair, peers: list[Library], rounds: int) -> dict[str, dict[str, Any]]:
    """Per library its answer and the fastest build and question, milliseconds."""
    best: dict[str, dict[str, Any]] = {
        p.name: {"answer": "", "build": np.inf, "ask": np.inf} for p in peers
    }
    for _ in range(rounds):
        for peer in peers:
            mine = best[peer.name]
            start = time.perf_counter()
            a, b = (peer.build(soup) for soup in pair)
            built = time.perf_counter()
            mine["answer"] = peer.ask(a, b)
            asked = time.perf_counter()
            mine["build"] = min(mine["build"], 1e3 * (built - start))
            mine["ask"] = min(mine["ask"], 1e3 * (asked - built))
    return best


def main() -> None:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    pairs = read_pairs(options.meshes) if options.meshes else made_pairs()
    peers, notes = libraries()
    lines = [", ".join(notes)]
    results = {}
    for name, pair in pairs.items():
        results[name] = measure(pair, peers, options.rounds)
        ours = results[name]["satcheck"]
        for library, one in results[name].items():
            ratio = (one["build"] + one["ask"]) / (ours["build"] + ours["ask"])
            lines.append(
                f"{name:12} {library:11} {one['answer']:12} build {one['build']:8.1f}  "
                f"ask {one['ask']:8.3f}  in all {ratio:5.1f} x satcheck"
            )
    sys.stdout.write("\n".join(lines) + "\n")
    if options.json:
        options.json.write_text(json.dumps({"versions": notes, "pairs": results}, indent=1))


if __name__ == "__main__":
    main()
