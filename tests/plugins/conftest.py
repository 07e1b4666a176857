"""The tests of a plug-in that is not here are left out."""

from __future__ import annotations

from pathlib import Path

from tests.plugin_marks import has

HERE = Path(__file__).parent
collect_ignore = [
    str(folder)
    for folder in HERE.iterdir()
    if folder.is_dir() and folder.name != "outside" and not has(folder.name)
]
