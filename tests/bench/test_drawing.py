"""Axes and the colours of two schemes."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

from bench.drawing import DARK, LIGHT, LogAxis, figure, plain, text, whole_decades


def test_equal_factors_are_equal_lengths() -> None:
    axis = LogAxis(1.0, 10_000.0, 100.0, 500.0)
    assert [axis.at(10.0**k) for k in range(5)] == pytest.approx([100, 200, 300, 400, 500])
    assert list(axis.decades) == [1, 10, 100, 1000, 10_000]
    assert [plain(value) for value in (0.01, 1, 10_000)] == ["0.01", "1", "10,000"]


def test_an_axis_upwards_runs_from_its_foot() -> None:
    axis = whole_decades([0.02, 0.5, 3.0], 300.0, 0.0)
    assert (axis.low, axis.high) == (0.01, 10.0)
    assert axis.at(0.01) == 300
    assert axis.at(10.0) == pytest.approx(0)


def test_one_value_has_a_decade_around_it() -> None:
    axis = whole_decades([1.0], 0.0, 1.0)
    assert (axis.low, axis.high) == (1.0, 10.0)


def test_both_schemes_are_spelled_out_and_words_are_escaped() -> None:
    drawing = figure(10, 20, "a < b", [text(1, 2, "c & d")], ({"x": "fill: #111;"}, {}))
    root = ElementTree.fromstring(drawing)
    assert "c & d" in "".join(root.itertext())
    light, dark = drawing.split("@media (prefers-color-scheme: dark)")
    assert LIGHT["paper"] in light
    assert DARK["paper"] in dark
    assert ".x { fill: #111; }" in light
    assert ".x" not in dark
