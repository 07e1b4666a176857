"""The stubs of the compiled module are installed, and each room imports only its own part of it.

import-linter sees no compiled module, so the arrows to it are checked here.
"""

from __future__ import annotations

import ast
import importlib
from pathlib import Path

import pytest

from tests.links import ROOMS, ROOT, STUBS, installed_package

PART_OF_ROOM = {"core": "core", "scene": "readers"}


@pytest.mark.parametrize("part", PART_OF_ROOM.values())
def test_a_stub_names_what_is_there(part: str) -> None:
    stub = (installed_package() / STUBS / f"{part}.pyi").read_text(encoding="utf-8")
    declared = ast.parse(stub).body
    named = {n.name for n in declared if isinstance(n, ast.ClassDef | ast.FunctionDef)}
    module = importlib.import_module(f"satcheck._native.{part}")
    assert named == {name for name in dir(module) if not name.startswith("_")}


def imported_parts(source: Path) -> set[str]:
    """What a file imports of satcheck._native, by full names; "satcheck._native" for the whole."""
    imported: set[str] = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            imported |= {name.name for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module == "satcheck._native":
            imported |= {f"satcheck._native.{name.name}" for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module == "satcheck":
            imported |= {f"satcheck.{name.name}" for name in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            imported.add(node.module)
    return {name for name in imported if name.startswith("satcheck._native")}


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_its_own_part(room: str) -> None:
    imported = {name for source in (ROOT / room).rglob("*.py") for name in imported_parts(source)}
    own = {f"satcheck._native.{PART_OF_ROOM[room]}"} if room in PART_OF_ROOM else set()
    assert imported == own
