"""Looks at files before they are asked about. Runs in a child process.

`python -m bench.opinions.look SEED` reads a line `{"file", "other"}` and answers with what the two
readers say of the file, the state of its surface, and where a second body is put for each kind of
pair. `other` is the file that the kind of that name takes.
"""

from __future__ import annotations

import json
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from bench.opinions.meshes import extent, read, read_by_trimesh
from bench.opinions.placing import KINDS, placement
from bench.opinions.surface import rim_kind


def look(question: dict[str, Any], seed: int) -> dict[str, Any]:
    file = question["file"]
    mesh = read(file)
    found: dict[str, Any] = {"triangles": len(mesh.triangles), "rim": rim_kind(mesh), "pairs": {}}
    name = zlib.crc32(Path(file).name.encode())
    for index, kind in enumerate(KINDS):
        rng = np.random.default_rng([seed, name, index])
        try:
            other = read(question["other"]) if kind == "other" else mesh
        except ValueError:
            continue
        if other.size > 0 and mesh.size > 0:
            found["pairs"][kind] = placement(kind, mesh, other, rng).tolist()
    try:
        agree = extent(mesh).agrees(extent(read_by_trimesh(file)))
        found["trimesh"] = "agrees" if agree else "differs"
    except Exception as error:  # noqa: BLE001 whatever a library throws is its answer
        found["trimesh"] = f"no answer: {type(error).__name__}"
    return found


def main() -> None:
    for line in sys.stdin:
        try:
            given = look(json.loads(line), int(sys.argv[1]))
        except ValueError as error:
            given = {"refused": str(error)}
        sys.stdout.write(json.dumps(given) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
