"""What answers depend on beside satcheck itself."""

from __future__ import annotations

from importlib import metadata

import pytest

from satcheck.core import plugins


def test_the_versions_are_those_that_the_packages_state() -> None:
    plugins.versions.cache_clear()
    found = dict(text.split(" ", 1) for text in plugins.versions() if text.count(" ") == 1)
    assert {name: metadata.version(name) for name in found} == found
    assert {"msgspec", "numpy", "click"} <= found.keys()


def test_the_versions_parse_no_description(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each process of a batch asks for them, of dozens of packages."""
    named = {name.split(" ")[0] for name in plugins.versions()}
    parsed: list[str] = []

    def version(installed: metadata.Distribution) -> str:
        parsed.append(installed.metadata["Name"])
        return "0"

    monkeypatch.setattr(metadata.Distribution, "version", property(version))
    plugins.versions.cache_clear()
    plugins.versions()
    plugins.versions.cache_clear()
    assert named.isdisjoint(parsed)
