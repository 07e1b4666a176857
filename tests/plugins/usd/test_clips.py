"""Value clips that are not applied block a pass, where they would move, hide or shape a body."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.scene import Scene
from satcheck.scene.access import files_read
from tests.plugins.usd.files import cube, load, said, stage, unread

_CLIP = """#usda 1.0
def "A" {
    token visibility.timeSamples = { 1: "invisible" }
    double weight.timeSamples = { 1: 3 }
}
def "B" {
    double weight.timeSamples = { 1: 3 }
}
"""
_LINES = {
    "assetPaths": "asset[] assetPaths = [@clip.1.usda@]",
    "primPath": 'string primPath = "/A"',
    "active": "double2[] active = [(0, 0)]",
}
_TEMPLATE = {
    "templateAssetPath": 'string templateAssetPath = "clip.#.usda"',
    "primPath": 'string primPath = "/A"',
    "templateStride": "double templateStride = 1",
    "templateStartTime": "double templateStartTime = 1",
    "templateEndTime": "double templateEndTime = 2",
}


def with_clips(lines: dict[str, str], more: str = "", *, body: bool = True) -> str:
    head = "clips = {{\n dictionary default = {{\n{}\n}}\n}}\n{}".format(
        "\n".join(lines.values()), more
    )
    top = cube("A", head=head) if body else f'def Xform "A" (\n{head}) {{\n}}\n'
    return stage(top, cube("B"))


def scene_of(folder: Path, text: str) -> Scene:
    (folder / "clip.1.usda").write_text(_CLIP)
    return load(folder, text)


@pytest.mark.parametrize("lines", [_LINES, _TEMPLATE])
def test_clips_that_are_applied_pass(tmp_path: Path, lines: dict[str, str]) -> None:
    scene = scene_of(tmp_path, with_clips(lines))
    assert not unread(scene)
    assert [body.id for body in scene.bodies] == ["/B"]
    assert "time-sampled" in said(scene)


@pytest.mark.parametrize("lost", _LINES)
def test_a_set_that_is_not_whole_blocks_a_pass(tmp_path: Path, lost: str) -> None:
    lines = {name: line for name, line in _LINES.items() if name != lost}
    (message,) = unread(scene_of(tmp_path, with_clips(lines)))
    assert "'default'" in message


@pytest.mark.parametrize("lost", _TEMPLATE)
def test_a_template_that_is_not_whole_blocks_a_pass(tmp_path: Path, lost: str) -> None:
    lines = {name: line for name, line in _TEMPLATE.items() if name != lost}
    (message,) = unread(scene_of(tmp_path, with_clips(lines)))
    assert "'default'" in message


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ({"active": "double2[] active = [(0, 1)]"}, "visibility does not come from clip.1.usda"),
        ({"active": "double2[] active = [(0, -1)]"}, "visibility does not come"),
        ({"active": "float2[] active = [(0, 0)]"}, "visibility does not come"),
        ({"times": "double2[] times = [(0, 0), (0, 1), (0, 2)]"}, "does not come"),
        ({"primPath": 'token primPath = "/A"'}, "visibility does not come"),
        ({"primPath": 'string primPath = "/C"'}, "clip.1.usda has no prim /C"),
        ({"primPath": 'string primPath = "no path"'}, "has no prim no path"),
        ({"primPath": 'string primPath = "A"'}, "A"),
        ({"manifest": "asset manifestAssetPath = @empty.usda@"}, "visibility does not come"),
        ({"manifest": "asset manifestAssetPath = @gone.usda@"}, "visibility does not come"),
    ],
)
def test_clips_that_usd_does_not_apply_block_a_pass(
    tmp_path: Path, lines: dict[str, str], words: str
) -> None:
    (tmp_path / "empty.usda").write_text("#usda 1.0\n")
    (message,) = unread(scene_of(tmp_path, with_clips(_LINES | lines)))
    assert words in message


@pytest.mark.parametrize(
    "line", ["asset[] assetPaths = [@bad.usda@]", "asset assetPaths = @clip.1.usda@"]
)
def test_clips_that_cannot_be_opened_refuse_the_file(tmp_path: Path, line: str) -> None:
    (tmp_path / "bad.usda").write_text("no layer")
    (lost,) = scene_of(tmp_path, with_clips(_LINES | {"assetPaths": line})).unreadable
    assert lost.issue.code == "bad-record"


@pytest.mark.parametrize(
    "lines",
    [
        {"templateStartTime": "double templateStartTime = 2"},
        {"templateStride": "double templateStride = 0"},
        {"templateStride": "int templateStride = 1"},
        {"templateAssetPath": 'string templateAssetPath = "clop.#.usda"'},
        {"templateEndTime": "double templateEndTime = 0"},
        {"offset": "double templateActiveOffset = 9"},
    ],
)
def test_a_template_that_finds_no_file_blocks_a_pass(tmp_path: Path, lines: dict[str, str]) -> None:
    (message,) = unread(scene_of(tmp_path, with_clips(_TEMPLATE | lines)))
    assert "there is no file" in message


@pytest.mark.parametrize("sets", ['clipSets = ["lost"]', 'prepend clipSets = ["lost"]'])
def test_a_set_that_is_nowhere_defined_blocks_a_pass(tmp_path: Path, sets: str) -> None:
    (message,) = unread(scene_of(tmp_path, with_clips(_LINES, sets)))
    assert "'lost'" in message


@pytest.mark.parametrize(
    ("lines", "more"),
    [
        ({"active": "double2[] active = []"}, ""),
        ({"assetPaths": "asset[] assetPaths = []"}, ""),
        ({"primPath": 'string primPath = "/B"'}, ""),
        ({}, 'delete clipSets = ["default"]'),
    ],
)
def test_clips_that_are_off_or_give_nothing_are_harmless(
    tmp_path: Path, lines: dict[str, str], more: str
) -> None:
    assert not unread(scene_of(tmp_path, with_clips(_LINES | lines, more)))


def test_clips_of_a_prim_without_bodies_are_harmless(tmp_path: Path) -> None:
    lines = _LINES | {"primPath": 'string primPath = "/C"'}
    assert not unread(scene_of(tmp_path, with_clips(lines, body=False)))


def test_a_clip_for_other_prims_blocks_a_pass(tmp_path: Path) -> None:
    """The names below the prim and in the clip differ."""
    clip = '#usda 1.0\ndef "A" {\n def "Bdoy" {\n token visibility.timeSamples = { 1: "x" }\n}\n}\n'
    (tmp_path / "other.usda").write_text(clip)
    lines = _LINES | {"assetPaths": "asset[] assetPaths = [@other.usda@]"}
    (message,) = unread(scene_of(tmp_path, with_clips(lines)))
    assert "/A/Bdoy" in message


@pytest.mark.parametrize("lines", [_LINES, _TEMPLATE])
def test_the_files_of_clips_are_noted(tmp_path: Path, lines: dict[str, str]) -> None:
    with files_read() as files:
        scene_of(tmp_path, with_clips(lines))
    assert str(tmp_path / "clip.1.usda") in list(files)


def test_a_clip_outside_that_a_template_finds_is_not_opened(tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    (tmp_path / "secret.usda").write_text("swordfish")
    (folder / "clip.2.usda").symlink_to(tmp_path / "secret.usda")
    (lost,) = scene_of(folder, with_clips(_TEMPLATE)).unreadable
    assert lost.issue.code == "outside-path"


def test_clips_of_a_variant_outside_are_not_opened(tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    (tmp_path / "clip.1.usda").write_text(_CLIP)
    lines = _LINES | {"assetPaths": "asset[] assetPaths = [@../clip.1.usda@]"}
    clips = "clips = {{\n dictionary default = {{\n{}\n}}\n}}".format("\n".join(lines.values()))
    head = 'variants = {\n string v = "a"\n}\nprepend variantSets = "v"'
    body = cube("A", f'variantSet "v" = {{\n "a" (\n{clips}\n) {{\n}}\n}}', head=head)
    (lost,) = load(folder, stage(body)).unreadable
    assert lost.issue.code == "outside-path"
