"""The sample pairs: their truth, stated by hand in index.json, and their golden reports here.

`python -m tests.golden` (or `make golden`) rewrites the golden reports; look at the difference
before it is committed. Truth is tested apart from them, so that a wrong golden cannot pass.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
SAMPLES = HERE.parent.parent / "sample_meshes"
INDEX: dict[str, Any] = json.loads((SAMPLES / "index.json").read_text(encoding="utf-8"))
PAIRS: dict[str, dict[str, Any]] = {pair["name"]: pair for pair in INDEX["pairs"]}
SECONDS = 300


def golden_file(name: str) -> Path:
    return HERE / f"{name}.json"


def report(name: str) -> tuple[int, bytes]:
    """Exit code and JSON document of the command for one sample pair, run in their folder."""
    pair = PAIRS[name]
    command = [sys.executable, "-m", "satcheck.cli", "--format", "json", "--no-timings"]
    done = subprocess.run(
        [*command, "--no-cache", *pair.get("options", []), *pair["inputs"]],
        cwd=SAMPLES,
        capture_output=True,
        timeout=SECONDS,
        check=False,
    )
    if done.stderr:
        raise AssertionError(f"{name}: {done.stderr.decode(errors='replace')}")
    return done.returncode, done.stdout
