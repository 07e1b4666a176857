"""core uses no library but numpy and msgspec; its two servers run a library in a child process."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

CORE = Path(__file__).resolve().parents[2] / "core"
ALLOWED = {"satcheck", "msgspec", "numpy", *sys.stdlib_module_names}
SERVERS = {"fcl_server.py": {"fcl"}, "manifold_server.py": {"manifold3d"}}


def imported(source: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(source.read_text())):
        if isinstance(node, ast.Import):
            yield from (name.name.partition(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module.partition(".")[0]


@pytest.mark.parametrize("source", sorted(CORE.rglob("*.py")), ids=lambda path: path.name)
def test_core_imports_only_what_it_may(source: Path) -> None:
    assert set(imported(source)) <= ALLOWED | SERVERS.get(source.name, set())
