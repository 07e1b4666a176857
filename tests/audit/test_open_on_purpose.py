"""A rule says which bodies are open on purpose: by their names, or by the files they are of."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit import Report, Settings, check
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.new_scene_file import new_scene_file
from satcheck.verify import verify
from tests.audit.shapes import open_box, unit_box, write
from tests.cli.process import satcheck

LID = 'bodies = "shell"\nopen = true\nreason = "the shell has no lid"'


def report(folder: Path, *rules: str, settings: Settings | None = None) -> Report:
    """Of a box in the mouth of an open shell: the fill of the hole decides, if it is one."""
    files = write(folder, shell=open_box(), part=unit_box(1, 1, 3.5))
    (folder / "rules.toml").write_text("".join(f"[[rules]]\n{rule}\n" for rule in rules))
    scene = load_scene(files, rules=[str(folder / "rules.toml")] if rules else [])
    return check(scene, settings or Settings())


def verdict(folder: Path, *rules: str) -> str:
    return report(folder, *rules).summary.verdict


def test_a_body_that_is_open_on_purpose_has_no_hole(tmp_path: Path) -> None:
    assert verdict(tmp_path) == "incomplete"
    opened = report(tmp_path, LID)
    everything = report(tmp_path, settings=Settings(allow_open=True))
    assert opened.summary == everything.summary
    assert opened.summary.verdict == "pass"
    assert [body.open for body in opened.bodies] == [True, False]


@pytest.mark.parametrize("form", ["table", "github", "sarif", "markdown", "json"])
def test_only_json_warns_of_what_is_open_on_purpose(form: str, tmp_path: Path) -> None:
    files = [*map(str, write(tmp_path, shell=open_box(), part=unit_box(1, 1, 3.5)))]
    (tmp_path / "rules.toml").write_text(f"[[rules]]\n{LID}\n")
    for option in (("--allow-open",), ("--rules", str(tmp_path / "rules.toml")), ()):
        told = satcheck(*files, *option, "--format", form).out
        assert ("open mesh" in told) == (form == "json" or not option)
    batch = satcheck("batch", files[0], "--allow-open", "-o", str(tmp_path / "out.md"))
    assert "open mesh" not in batch.err


@pytest.mark.parametrize(
    ("rule", "expected"),
    [
        ('bodies = "sh*"\nopen = true', "pass"),
        ('bodies = "part"\nopen = true', "incomplete"),
        ('bodies = "*"\nopen = true\nasset = "shell.obj"', "pass"),
        ('bodies = "*"\nopen = true\nasset = "*/shell.*"', "pass"),
        ('bodies = "*"\nopen = true\nasset = "part.obj"', "incomplete"),
        (f'{LID}\n[[rules]]\nbodies = "*"\nopen = false', "incomplete"),
    ],
)
def test_bodies_are_named_as_in_any_rule_or_by_their_file(
    rule: str, expected: str, tmp_path: Path
) -> None:
    assert verdict(tmp_path, rule) == expected


def test_evidence_counts_the_body_as_open(tmp_path: Path) -> None:
    stated = report(tmp_path, LID, settings=Settings(certificate=True)).to_dict()
    assert all(finding["certificate"] for finding in stated["findings"])
    assert verify(stated, Path(), allow_outside=True).accepted
    stated["bodies"][0]["open"] = False
    assert not verify(stated, Path(), allow_outside=True).accepted


def test_an_asset_without_other_keys_says_nothing(tmp_path: Path) -> None:
    with pytest.raises(SatcheckError, match="no effect"):
        report(tmp_path, 'bodies = "*"\nasset = "shell.obj"')


def test_the_folder_gate_takes_the_rules_file(tmp_path: Path) -> None:
    write(tmp_path, shell=open_box(), part=unit_box(1, 1, 3.5))
    (tmp_path / "pot.toml").write_text(
        'schema = "satcheck.scene/1"\nunits = "mm"\n'
        '[[bodies]]\nid = "pot"\nmesh = "shell.obj"\n[[bodies]]\nid = "lid"\nmesh = "part.obj"\n'
    )
    gate = ("batch", "pot.toml")
    assert satcheck(*gate, cwd=tmp_path).code == 3
    rules = tmp_path / "rules.toml"
    rules.write_text('[[rules]]\nbodies = "*"\nasset = "shell.obj"\nopen = true\n')
    assert satcheck(*gate, "--rules", "rules.toml", cwd=tmp_path).code == 0


def test_a_moved_scene_keeps_it(tmp_path: Path) -> None:
    report(tmp_path, LID)
    scene = load_scene(
        [str(tmp_path / "shell.obj"), str(tmp_path / "part.obj")],
        rules=[str(tmp_path / "rules.toml")],
    )
    moved = tmp_path / "moved.toml"
    moved.write_text(new_scene_file(moved, scene, MeshFiles()))
    assert [body.open for body in load_scene([str(moved)]).bodies] == [True, False]
