"""Marks of tests that need a plug-in: without it they are skipped, and all others pass."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
_ENDINGS = {
    "usd": (".usd", ".usda", ".usdc", ".usdz"),
    "ifc": (".ifc", ".bcf"),
    "step": (".step", ".stp"),
    "sdf": (".sdf", ".world"),
    "mjcf": (".xml",),
}


def has(name: str) -> bool:
    return (ROOT / "plugins" / name).is_dir()


def needs(*names: str) -> pytest.MarkDecorator:
    """The mark of a test that needs these plug-ins."""
    lacking = [name for name in names if not has(name)]
    return pytest.mark.skipif(bool(lacking), reason=f"without the plug-ins {', '.join(lacking)}")


def plugins_of(words: Iterable[str]) -> list[str]:
    """The plug-ins that read the files and folders of formats among these words."""
    found = {
        name
        for word in words
        for name, endings in _ENDINGS.items()
        if word.endswith(endings) or word in (f"formats/{name}", f"features/{name}")
    }
    return sorted(found)


def skip_without(words: Iterable[str]) -> None:
    """Skip the test that runs if a plug-in that reads one of these words is lacking."""
    lacking = [name for name in plugins_of(words) if not has(name)]
    if lacking:
        pytest.skip(f"without the plug-ins {', '.join(lacking)}")
