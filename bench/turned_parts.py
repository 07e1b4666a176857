"""How far CoACD's parts of a mesh depend on how it is turned.

    python -m bench.turned_parts MESH ... [--rotations 4] [--threshold 0.05]

Each mesh is split as it stands and in random rotations, always the same ones. CoACD cuts along the
axes of the file, so the parts differ. A row has the smallest and the largest number of parts, and
of each proven error in percent of the diagonal of the mesh as it stands; the last line, by how much
they differ in the median and at most. Nothing is cached.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterator
from statistics import median

import numpy as np

from satcheck.core import Mesh
from satcheck.decompose import DecompositionError, decompose
from satcheck.decompose.components import diagonal
from satcheck.scene import load_scene

SEED = 20
SECONDS = 120.0


def rotations(count: int) -> Iterator[np.ndarray]:
    """Yield the identity, and uniform random rotations (3, 3)."""
    random = np.random.default_rng(SEED)
    yield np.eye(3)
    for _ in range(count):
        basis, triangle = np.linalg.qr(random.normal(size=(3, 3)))
        basis = basis * np.sign(np.diag(triangle))
        yield basis * np.linalg.det(basis)


def measured(mesh: Mesh, count: int, threshold: float) -> np.ndarray:
    """(rotations, 3): the number of parts, and both errors in percent of the diagonal."""
    rows = []
    for rotation in rotations(count):
        turned = Mesh(np.asarray(mesh.vertices) @ rotation.T, mesh.triangles)
        made = decompose(turned, threshold=threshold, seconds=SECONDS)
        percent = 100.0 / diagonal(mesh)
        rows.append((len(made.parts), made.outside * percent, made.missing * percent))
    return np.array(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("meshes", nargs="+", metavar="MESH")
    parser.add_argument("--rotations", type=int, default=4)
    parser.add_argument("--threshold", type=float, default=0.05)
    given = parser.parse_args()
    ratios = []
    for path in given.meshes:
        mesh = load_scene([path], split="none").bodies[0].world_mesh()
        try:
            rows = measured(mesh, given.rotations, given.threshold)
        except DecompositionError as error:
            tell(f"{path}: {error}")
            continue
        low, high = rows.min(axis=0), rows.max(axis=0)
        tell(
            f"{path}: {low[0]:.0f} to {high[0]:.0f} parts ({rows[0, 0]:.0f} as it stands), "
            f"they stick out {low[1]:.2g} to {high[1]:.2g} %, the mesh {low[2]:.2g} to "
            f"{high[2]:.2g} %"
        )
        ratios.append(
            [most / least if least else math.inf for least, most in zip(low, high, strict=True)]
        )
    for name, values in zip(
        ("parts", "sticks out", "missing"), zip(*ratios, strict=True), strict=True
    ):
        finite = [value for value in values if math.isfinite(value)]
        tell(f"{name}: largest / smallest {median(finite):.2f}, at most {max(finite):.2f}")


def tell(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
