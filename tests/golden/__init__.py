"""The sample pairs and scenes: their truth, by hand in index.json, and their golden reports here.

`python -m tests.golden` (or `make golden`) rewrites the golden reports; look at the difference
before it is committed. Truth is tested apart from them, so that a wrong golden cannot pass.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.cli.process import satcheck

HERE = Path(__file__).resolve().parent
SAMPLES = HERE.parent.parent / "sample_meshes"
INDEX: dict[str, Any] = json.loads((SAMPLES / "index.json").read_text(encoding="utf-8"))
PAIRS: dict[str, dict[str, Any]] = {pair["name"]: pair for pair in INDEX["pairs"]}
SCENES: dict[str, dict[str, Any]] = {scene["name"]: scene for scene in INDEX["scenes"]}
SAMPLE_CALLS = PAIRS | SCENES


def golden_file(name: str) -> Path:
    return HERE / f"{name}.json"


def report(name: str) -> tuple[int, bytes]:
    """Exit code and JSON document of the command for one pair or scene, run in their folder. It
    writes nothing to stderr, except what `told` says."""
    pair = SAMPLE_CALLS[name]
    options = ("--format", "json", "--no-timings", *pair.get("options", []))
    ran = satcheck(*options, *pair["inputs"], cwd=SAMPLES, env={"SATCHECK_CACHE": "off"})
    told = pair.get("told", "")
    if told not in ran.err or (ran.err and not told):
        raise AssertionError(f"{name}: {ran.err}")
    return ran.code, ran.out.encode()
