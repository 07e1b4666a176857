"""A drawing as a PNG, and what is said where it cannot be made."""

from __future__ import annotations

import struct
from pathlib import Path

import click
import pytest

from satcheck.cli.commands.tradeoff import command
from satcheck.cli.report import png as drawing
from tests.cli.process import PUSHED, satcheck

SIGNATURE = b"\x89PNG\r\n\x1a\n"
SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 20" width="60" height="20">{}</svg>'
WORDS = '<text x="2" y="15" style="font: 12px system-ui, Helvetica, sans-serif">words</text>'


def size(image: bytes) -> tuple[int, ...]:
    """Width and height in pixels: the first chunk of a PNG."""
    assert image.startswith(SIGNATURE + b"\0\0\0\rIHDR")
    return struct.unpack(">II", image[16:24])


def test_letters_are_drawn_with_no_font_of_the_system() -> None:
    pytest.importorskip("resvg_py", reason="the extra png is not installed")
    with_words, without = drawing.png(SVG.format(WORDS)), drawing.png(SVG.format(""))
    assert size(with_words) == size(without) == (120, 40)
    assert len(with_words) > len(without)


def test_the_plot_of_a_run_is_an_image(tmp_path: Path) -> None:
    pytest.importorskip("resvg_py", reason="the extra png is not installed")
    plot = tmp_path / "plot.png"
    ran = satcheck("tradeoff", *PUSHED, "--budget", "1e-9", "--plot", str(plot))
    assert ran.code == 3, ran.err
    assert size(plot.read_bytes())[0] == 2 * 760


def test_without_the_extra_nothing_runs_and_the_way_to_get_it_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(drawing, "find_spec", lambda name: None if name == "resvg_py" else object())
    plot = tmp_path / "plot.png"
    with pytest.raises(click.UsageError, match=r"pip install 'satcheck\[png\]'"):
        command.main([*PUSHED, "--plot", str(plot)], standalone_mode=False)
    assert not plot.exists()
