"""The committed stub of the native readers names what the module has, no more and no less."""

from __future__ import annotations

import ast
from pathlib import Path

from satcheck.scene import _readers


def stub_names():
    stub = Path(_readers.__file__).parent / "_readers.pyi"
    names = {}
    for node in ast.parse(stub.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            names[node.name] = {
                item.name for item in node.body if isinstance(item, ast.FunctionDef)
            }
        elif isinstance(node, ast.FunctionDef):
            names[node.name] = None
    return names


def module_names():
    return {
        name: {member for member in vars(value) if not member.startswith("_")}
        if isinstance(value, type)
        else None
        for name, value in vars(_readers).items()
        if not name.startswith("_")
    }


def test_stub_and_module_agree():
    assert stub_names() == module_names()
