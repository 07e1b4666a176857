"""The committed stubs name what the native modules hold: a stub that drifts lies to mypy."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
STUBS = {
    "satcheck.core._native": ROOT / "core" / "_native.pyi",
    "satcheck.scene._readers": ROOT / "scene" / "_readers.pyi",
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
    above = [inherited(classes, base) for base in bases if base in classes]
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
