"""A light and a dark file of each figure, and the words of ticks."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from matplotlib.figure import Figure

from bench.drawing import both, embedded, percent, plain, write_both
from satcheck.cli.plotting import DARK, LIGHT, style


def draw(dark: bool) -> Figure:
    with style(dark=dark):
        figure = Figure((2, 1))
        figure.text(0.1, 0.5, "a < b & $c")
    return figure


def test_both_styles_have_their_paper_and_the_words_as_written() -> None:
    files = both("name", draw)
    assert list(files) == ["name.svg", "name-dark.svg"]
    for content, palette in zip(files.values(), (LIGHT, DARK), strict=True):
        assert "a < b & $c" in "".join(ElementTree.fromstring(content).itertext())
        assert palette.paper in content.decode()
    assert files["name.svg"] != files["name-dark.svg"]


def test_the_dark_file_lies_beside_the_light_one(tmp_path: Path) -> None:
    write_both(tmp_path / "x.svg", draw)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == both("x", draw)


def test_a_page_embeds_both() -> None:
    html = embedded("folder", "name", "words")
    source, image = ElementTree.fromstring(html)
    assert source.attrib["srcset"] == "folder/name-dark.svg"
    assert image.attrib == {"alt": "words", "src": "folder/name.svg"}


def test_numbers_of_ticks() -> None:
    assert [plain(value) for value in (0.01, 1, 10_000)] == ["0.01", "1", "10,000"]
    assert [percent(share) for share in (0.0, 1e-7, 0.01, 100.0)] == [
        "0",
        "1e-05 %",
        "1 %",
        "10,000 %",
    ]
