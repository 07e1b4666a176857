"""The worst findings of a batch: their page and their pictures."""

from __future__ import annotations

import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit.batch.stored import Stored
from satcheck.cli.formats.assets import overview
from satcheck.cli.formats.worst_page import render
from satcheck.cli.worst_findings import Worst, file_name
from satcheck.report.assets import Asset, asset
from tests.cli.process import SAMPLES, Ran, satcheck
from tests.cli.reports import BLOCK, PENETRATING, report

PNG = b"\x89PNG\r\n\x1a\n"
EVIL = "<script>alert(1)</script>\"'&\u202e.obj"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Results of two scenes that fail, the second one by a deeper overlap."""
    for name in ("box.obj", "box_pushed.stl"):
        shutil.copy(SAMPLES / name, tmp_path)
    for name, x in (("a", 0.5), ("b", 0.0)):
        (tmp_path / f"{name}.toml").write_text(
            'schema = "satcheck.scene/1"\n'
            '[[bodies]]\nid = "one"\nmesh = "box.obj"\n'
            f'[[bodies]]\nid = "two"\nmesh = "box_pushed.stl"\nposition = [{x}, 0, 0]\n'
        )
    satcheck("batch", "a.toml", "b.toml", "--depth", "-o", "all.jsonl", cwd=tmp_path)
    return tmp_path


def ask(folder: Path, *arguments: str) -> Ran:
    return satcheck("view", "all.jsonl", *arguments, cwd=folder)


class Page(HTMLParser):
    """What a browser makes of a page: its tags, the links in them, its text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.links: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.links += [value or "" for name, value in attrs if name in ("src", "href", "action")]

    def handle_data(self, data: str) -> None:
        self.text += data


def test_the_page_shows_the_worst_finding_first(folder: Path) -> None:
    ran = ask(folder, "-o", "worst.html")
    assert ran.code == 1
    page = Page((folder / "worst.html").read_text())
    assert re.findall(r"\d\. [ab]\.toml", page.text) == ["1. b.toml", "2. a.toml"]
    assert page.tags.count("img") == 2
    assert all(link.startswith("data:image/png;base64,") for link in page.links)
    assert "FAIL: 2 assets: 2 fail" in page.text
    assert "overlap (thickness 1, 1 to pull apart); moving" in page.text


def test_top_limits_the_pictures(folder: Path) -> None:
    page = Page(ask(folder, "--format", "html", "--top", "1").out)
    assert page.tags.count("img") == 1


def test_pictures_go_to_a_folder(folder: Path) -> None:
    ran = ask(folder, "--pictures", "new/images")
    assert "─────" in ran.out
    made = sorted((folder / "new" / "images").iterdir())
    assert [path.name for path in made] == ["001-b-one-two.png", "002-a-one-two.png"]
    assert all(path.read_bytes().startswith(PNG) for path in made)


@pytest.mark.parametrize(
    ("name", "told"), [("box.obj", "box.obj has changed"), ("a.toml", "a.toml has changed")]
)
def test_a_changed_file_is_named_in_place_of_a_picture(name: str, told: str, folder: Path) -> None:
    with (folder / name).open("a") as file:
        file.write("\n")
    page = Page(ask(folder, "--format", "html", "--pictures", "images").out)
    assert f"No picture: {told}" in page.text
    assert page.tags.count("img") == (0 if name == "box.obj" else 1)


def test_a_missing_file_is_named_in_place_of_a_picture(folder: Path) -> None:
    (folder / "box_pushed.stl").unlink()
    ran = ask(folder, "--pictures", "images")
    assert "b.toml: no picture of one and two: box_pushed.stl is not there" in ran.err
    assert list((folder / "images").iterdir()) == []


def test_paths_start_in_another_folder(folder: Path) -> None:
    elsewhere = folder / "elsewhere"
    elsewhere.mkdir()
    (folder / "all.jsonl").rename(elsewhere / "all.jsonl")
    assert Page(ask(elsewhere, "--format", "html").out).tags.count("img") == 0
    found = ask(elsewhere, "--format", "html", "--root", "..")
    assert Page(found.out).tags.count("img") == 2


def test_what_a_file_says_is_text() -> None:
    finding = PENETRATING
    bodies = tuple(replace(BLOCK, id=id_) for id_ in (finding.a, finding.b))
    evil = asset(EVIL, report(finding, bodies=bodies))
    page = "".join(render(overview([evil]), [(evil, finding, f"{EVIL} has changed")]))
    read = Page(page)
    assert "script" not in read.tags
    assert "<script>alert(1)</script>\"'&\ufffd.obj" in read.text
    assert "\u202e" not in page


@pytest.mark.parametrize(
    "name", ["../../etc/passwd", "/a/b\nc", "x" * 300, "a\udcff", "..", "CON.obj", "a;rm -rf"]
)
def test_names_of_pictures_stay_in_their_folder(name: str) -> None:
    stored = Stored((name,), (), Asset(name, "fail", report(PENETRATING)))
    made = file_name(7, Worst(PENETRATING, stored))
    assert re.fullmatch(r"007-[A-Za-z0-9-]{1,80}\.png", made)


def test_a_touch_has_no_picture_and_the_title_no_next_step(folder: Path) -> None:
    scene = (folder / "a.toml").read_text().replace("0.5, 0, 0", "1.0, 0, 0")
    (folder / "a.toml").write_text(scene)
    satcheck("batch", "a.toml", "b.toml", "-o", "worst.html", cwd=folder)
    page = Page((folder / "worst.html").read_text())
    assert re.findall(r"\d\. [ab]\.toml", page.text) == ["1. b.toml"]
    assert "FAIL: 2 assets: 1 fails (b.toml), 1 passes." in page.text
    assert "Next:" not in page.text


def test_a_scene_without_findings_has_a_page(folder: Path) -> None:
    satcheck("batch", "box.obj", "-o", "one.jsonl", cwd=folder)
    ran = satcheck("view", "one.jsonl", "--format", "html", cwd=folder)
    assert ran.code == 0
    assert "There is none." in Page(ran.out).text
    assert json.loads((folder / "one.jsonl").read_text())["verdict"] == "pass"
