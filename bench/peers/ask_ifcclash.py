"""Asks ifcclash about one IFC file, as its command does: python ask_ifcclash.py FILE MODE.

MODE is `collision` (triangles cross; touching is none) or `intersection` (elements pierce or
protrude by more than a tolerance of 0). Prints the pairs of GlobalIds as JSON.
"""

from __future__ import annotations

import json
import logging
import sys
from typing import Any

from ifcclash.ifcclash import Clasher, ClashSettings

SETTINGS: dict[str, dict[str, Any]] = {
    "collision": {"allow_touching": False},
    "intersection": {"tolerance": 0.0, "check_all": False},
}


def main(file: str, mode: str) -> None:
    settings = ClashSettings()
    settings.logger = logging.getLogger("ifcclash")
    clasher = Clasher(settings)
    asked: dict[str, Any] = {"name": mode, "a": [{"file": file}], "mode": mode, **SETTINGS[mode]}
    clasher.clash_sets = [asked]
    clasher.clash()
    pairs = [[each["a_global_id"], each["b_global_id"]] for each in asked["clashes"].values()]
    json.dump(pairs, sys.stdout)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
