"""make installs anew when any source of the package changed, however deep it lies."""

from __future__ import annotations

import subprocess
from pathlib import Path

TOP = Path(__file__).resolve().parents[1]
ROOMS = (
    "api",
    "plugins",
    "cli",
    "audit",
    "verify",
    "report",
    "scene",
    "decompose",
    "core",
)
KINDS = (".py", ".pyi", ".json", ".cpp", ".hpp")


def sources_of_make() -> set[str]:
    show = "include Makefile\nshow: ; @echo $(SOURCES) $(CXX_TESTS)\n"
    command = ["make", "-s", "-f", "-", "show"]
    said = subprocess.run(command, cwd=TOP, input=show, capture_output=True, text=True, check=True)
    return set(said.stdout.split())


def test_every_source_is_known_to_make() -> None:
    on_disk = {
        str(path.relative_to(TOP))
        for room in ROOMS
        for path in (TOP / room).rglob("*")
        if path.suffix in KINDS
    }
    assert len(on_disk) > 100
    assert on_disk - sources_of_make() == set()
