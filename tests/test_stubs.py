"""The committed stubs name what the native module holds, and each room imports only its own part.

import-linter sees no compiled module, so the arrows to it are checked here.
"""

from __future__ import annotations

import ast
import builtins
import importlib
from pathlib import Path

import pytest

from tests.links import ROOMS

ROOT = Path(__file__).resolve().parent.parent
PART_OF_ROOM = {"core": "core", "scene": "readers"}
STUBS = {
    f"satcheck._native.{part}": ROOT / "api" / "satcheck" / "_native" / f"{part}.pyi"
    for part in PART_OF_ROOM.values()
}


def declared(body: list[ast.stmt]) -> set[str]:
    """Public names of a stub, or of a class in it; type aliases are the stub's own."""
    names = {node.name for node in body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    for node in body:
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names.add(node.target.id)
    return {name for name in names if not name.startswith("_")}


def public(thing: object) -> set[str]:
    return {name for name in dir(thing) if not name.startswith("_")}


def inherited(classes: dict[str, ast.ClassDef], name: str) -> set[str]:
    """Public attributes of a class of the stub, those of its bases included."""
    bases = [base.id for base in classes[name].bases if isinstance(base, ast.Name)]
    above = [
        inherited(classes, base) if base in classes else public(getattr(builtins, base))
        for base in bases
    ]
    return declared(classes[name].body).union(*above)


@pytest.mark.parametrize("name", STUBS)
def test_the_stub_names_what_is_there(name: str) -> None:
    module = importlib.import_module(name)
    stub = ast.parse(STUBS[name].read_text(encoding="utf-8")).body
    assert declared(stub) == public(module)
    classes = {node.name: node for node in stub if isinstance(node, ast.ClassDef)}
    for class_name in classes:
        there = public(getattr(module, class_name))
        assert inherited(classes, class_name) == there, class_name


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
