"""Limits of the settings are those of rules, for pairs to which rules give none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from satcheck.audit import Settings, check
from satcheck.core.errors import SatcheckError
from satcheck.report.report import Finding
from satcheck.scene import Rule, Selector
from tests.audit.shapes import bracket, moved, placed_scene, pose, scene_of, unit_box, write
from tests.cli.process import satcheck

# A plate 4 long that a cube of edge 1 enters by 0.25: as thick, and as far to pull apart.
THIN = {"max_thickness": 0.25, "max_depth": 0.25}


def found(folder: Path, *rules: Rule, **settings: Any) -> Finding:
    write(folder, box=unit_box())
    scene = placed_scene(folder, [("a", "box.obj", pose()), ("b", "box.obj", pose(0.75))])
    (finding,) = check(replace(scene, rules=rules), Settings(**settings)).findings
    return finding


def rule(**keys: Any) -> Rule:
    return Rule(a=Selector("a"), b=Selector("b"), where="cell.toml:5", **keys)


@pytest.mark.parametrize("key", ["max_thickness", "max_depth"])
def test_an_overlap_within_a_limit_passes_and_one_beyond_it_fails(key: str, tmp_path: Path) -> None:
    option = f"--{key.replace('_', '-')}"
    within, beyond = (found(tmp_path, **{key: limit}) for limit in (0.25, 0.24))
    assert (within.severity, within.rule) == ("note", option)
    assert (beyond.severity, beyond.rule) == ("error", option)
    assert f"{key} 0.24" in beyond.message
    assert beyond.undecided is None


def test_of_two_limits_both_count(tmp_path: Path) -> None:
    assert found(tmp_path, **THIN).rule == "--max-depth, --max-thickness"
    thick = found(tmp_path, **{**THIN, "max_thickness": 0.1})
    assert (thick.severity, thick.rule) == ("error", "--max-thickness")


def test_what_a_rule_says_of_a_pair_comes_first(tmp_path: Path) -> None:
    strict = found(tmp_path, rule(max_depth=0.1), max_thickness=1.0)
    assert (strict.severity, strict.rule) == ("error", "cell.toml:5")
    kept_apart = found(tmp_path, rule(clearance=0.1), max_thickness=1.0)
    assert kept_apart.severity == "error"
    mild = found(tmp_path, rule(severity="warning"), max_thickness=0.1)
    assert (mild.severity, mild.rule) == ("warning", "cell.toml:5")


def test_a_limit_between_the_bounds_leaves_the_pair_undecided(tmp_path: Path) -> None:
    scene = scene_of(tmp_path, a=bracket(), b=moved(bracket(), 0.3, 0.2, 0.1))
    (wide,) = check(scene, Settings(budget=1e-7)).findings
    assert wide.depth_bounds is not None
    low, high = wide.depth_bounds
    assert low < high
    limit = (low + high) / 2
    (finding,) = check(scene, Settings(budget=1e-7, max_depth=limit)).findings
    assert (finding.severity, finding.undecided) == ("warning", "limit")
    assert "--max-depth" in (finding.reason or "")


def test_limits_and_a_clearance_contradict_each_other() -> None:
    with pytest.raises(SatcheckError, match="clearance contradicts"):
        Settings(clearance=1.0, max_depth=1.0)


def test_the_command_takes_limits_in_units_and_proves_them(tmp_path: Path) -> None:
    write(tmp_path, a=unit_box(), b=unit_box(0.75))
    files = ("a.obj", "b.obj", "--units", "cm", "--certificate", "-o", "r.json")
    assert satcheck(*files, "--max-thickness", "2.4mm", cwd=tmp_path).code == 1
    assert satcheck(*files, "--max-thickness", "2.5mm", cwd=tmp_path).code == 0
    verified = satcheck("verify", "r.json", cwd=tmp_path)
    assert verified.code == 0, verified.out
    (tmp_path / "satcheck.toml").write_text('max-thickness = "2.5mm"\n')
    plain = satcheck("a.obj", "b.obj", "--units", "cm", cwd=tmp_path)
    assert (plain.code, "beyond what --max-thickness allows" in plain.out) == (0, True)


def test_what_has_no_thickness_is_said_to_need_a_limit_of_depth() -> None:
    ran = satcheck("gripper.glb", "--max-thickness", "0.1m")
    assert (ran.code, "--max-depth, or max_depth of a rule" in ran.out) == (3, True)
