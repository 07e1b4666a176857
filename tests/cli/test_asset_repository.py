"""A repository of assets from its first check on, with the commands of a CI job."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from satcheck.scene.files.readers import readers
from tests.asset_repository import CONFIG, ON_TOP, commit, make, write_crate, write_shelf
from tests.cli.process import Ran, satcheck

TOP = Path(__file__).resolve().parents[2]
NEED_EXTRAS = {"step", "usd", "ifc", "mjcf", "3dxml", "xaml", "zae"}
GATED = f'{CONFIG}baseline = "known.json"\n'


def each(folder: Path, *more: str) -> Ran:
    return satcheck("batch", "assets", *more, cwd=folder)


def verdicts(folder: Path) -> dict[str, str]:
    document = json.loads((folder / "report.json").read_text())
    return {Path(asset["file"]).name: asset["verdict"] for asset in document["assets"]}


def results(sarif: str) -> list[Any]:
    (run,) = json.loads(sarif)["runs"]
    listed: list[Any] = run["results"]
    return listed


@pytest.fixture
def gated(tmp_path: Path) -> Path:
    """Its known overlap is in a baseline."""
    folder = make(tmp_path / "repository")
    each(folder, "-o", "report.json")
    reason = ("--reason", "the lid is modelled without a rim")
    satcheck("baseline", "write", "known.json", "report.json", *reason, cwd=folder)
    (folder / "satcheck.toml").write_text(GATED)
    (folder / "report.json").unlink()
    commit(folder, "Accept what is known")
    return folder


def test_the_first_run_finds_the_overlap(tmp_path: Path) -> None:
    folder = make(tmp_path / "repository")
    assert each(folder, "-o", "report.json").code == 1
    assert verdicts(folder) == {
        "bolt.obj": "pass", "crate.glb": "fail", "shelf.scene.toml": "pass"
    }  # fmt: skip


def test_with_a_baseline_it_passes(gated: Path) -> None:
    ran = each(gated)
    assert ran.code == 0, ran.out
    (known,) = results(each(gated, "--format", "sarif").out)[:1]
    assert (known["level"], known["baselineState"]) == ("note", "unchanged")
    assert each(gated, "--no-config", "--depth").code == 1


def test_a_new_overlap_fails_at_its_line_until_it_is_fixed(gated: Path) -> None:
    write_shelf(gated / "assets", 105)
    ran = each(gated, "--changed-since", "HEAD", "--format", "sarif")
    assert ran.code == 1
    new = [result for result in results(ran.out) if result["level"] == "error"]
    assert [result["baselineState"] for result in new] == ["new"]
    place = new[0]["locations"][0]["physicalLocation"]
    assert place == {
        "artifactLocation": {"uri": "assets/shelf.scene.toml"}, "region": {"startLine": 4}
    }  # fmt: skip
    assert each(gated).code == 1
    write_shelf(gated / "assets", 110)
    assert each(gated).code == 0
    assert "no asset changed" in each(gated, "--changed-since", "HEAD").err


def test_what_is_mended_is_pruned(gated: Path) -> None:
    write_crate(gated / "assets", ON_TOP)
    ran = each(gated, "-o", "report.json")
    assert ran.code == 0
    assert "prune" in ran.err
    pruned = satcheck("baseline", "prune", "known.json", "report.json", cwd=gated)
    assert "0 findings, 0 added, 0 changed, 1 removed" in pruned.out
    assert each(gated, "--no-config", "--depth").code == 0
    write_crate(gated / "assets", 0.9)
    assert each(gated).code == 1


def test_what_the_hook_gets_is_checked(gated: Path) -> None:
    """pre-commit calls the command with the names of staged files."""
    write_shelf(gated / "assets", 105)
    staged = ("assets/bolt.obj", "assets/shelf.scene.toml")
    assert satcheck("batch", *staged, cwd=gated).code == 1
    write_shelf(gated / "assets", 110)
    assert satcheck("batch", *staged, cwd=gated).code == 0


def test_the_hook_is_about_every_format_that_needs_no_option_and_no_extra() -> None:
    hooks = (TOP / ".pre-commit-hooks.yaml").read_text()
    assert hooks.count('args: ["--"]') == hooks.count("entry:")  # no name is an option
    pattern = next(line for line in hooks.splitlines() if "files:" in line)
    endings = pattern[pattern.index(r"\.(") + 3 : pattern.rindex(")")].split("|")
    assert {f".{ending}" for ending in endings} == {
        *(ending for ending, reader in readers().items() if reader.name not in NEED_EXTRAS),
        ".urdf",
    }
