"""What answers depend on beside satcheck itself."""

from __future__ import annotations

import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

from satcheck.core import plugins


def test_the_versions_are_those_that_the_packages_state() -> None:
    plugins.versions.cache_clear()
    stated = [text for text in plugins.versions() if " " not in text]
    found = dict(text.split("-", 1) for text in stated)
    assert {name: metadata.version(name) for name in found} == found
    assert {"msgspec", "numpy", "click"} <= found.keys()


def test_the_first_package_on_the_path_counts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in ("1/satcheck-9", "1/Some_need-1.0", "2/some_need-2.0", "2/another-3.0"):
        (tmp_path / f"{folder}.dist-info").mkdir(parents=True)
    about = tmp_path / "1" / "satcheck-9.dist-info" / "METADATA"
    about.write_text(
        'Name: satcheck\nRequires-Dist: some-need>=1\nRequires-Dist: absent ; x == "y"\n'
    )
    monkeypatch.setattr(
        sys, "path", [str(tmp_path / "none"), str(tmp_path / "1"), str(tmp_path / "2")]
    )
    plugins.versions.cache_clear()
    found = plugins.versions()
    plugins.versions.cache_clear()
    assert found == ("Some_need-1.0",)


def test_a_working_tree_states_its_version_in_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in ("satcheck-9.dist-info", "need.egg-info"):
        (tmp_path / folder).mkdir()
    (tmp_path / "satcheck-9.dist-info" / "METADATA").write_text("Requires-Dist: need\n")
    (tmp_path / "need.egg-info" / "PKG-INFO").write_text("Name: need\nVersion: 3.1\n")
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    plugins.versions.cache_clear()
    found = plugins.versions()
    plugins.versions.cache_clear()
    assert found == ("need-3.1",)


def test_the_versions_import_no_library() -> None:
    """Each process of a batch asks for them. Without plug-ins of others, nothing is parsed."""
    code = (
        "import sys; from satcheck.core import plugins\n"
        "plugins._stated = lambda *_: ''\n"
        "plugins.versions()\n"
        "assert 'importlib.metadata' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
