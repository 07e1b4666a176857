"""What hulls, convex parts and the meshes themselves make of the thickness of an overlap."""

from __future__ import annotations

from pathlib import Path

import pytest

from satcheck.audit.request.settings import Settings
from satcheck.audit.studied_pair import Bodies
from satcheck.audit.tradeoff.result import Figure
from satcheck.audit.tradeoff.runs import ask, ask_parts
from tests.audit.shapes import Mesh, bracket, moved, scene_of, unit_box

# In the notch of the bracket its hull is thick, and the bracket touches a side of the notch.
IN_NOTCH = unit_box(1.875, 2.5, 1.0)


def bodies(folder: Path, a: Mesh, b: Mesh) -> Bodies:
    first, second = scene_of(folder, a=a, b=b).bodies
    return first, second


def figure_at(pair: Bodies, accuracy: str) -> Figure | None:
    found = ask(pair, Settings(depth=True, accuracy=accuracy))  # type: ignore[arg-type]
    return None if found.thickness is None else found.thickness.figure


def test_the_meshes_have_an_interval_and_hulls_a_bound(tmp_path: Path) -> None:
    pair = bodies(tmp_path, bracket(), IN_NOTCH)
    exact, hull = figure_at(pair, "exact"), figure_at(pair, "hull")
    assert exact is not None
    assert exact.low is not None
    assert exact.high is not None
    assert hull is not None
    assert exact.low <= 0.125 <= exact.high
    assert hull.low is None
    assert hull.high == hull.value > exact.high
    assert figure_at(pair, "aabb") is None


def test_hulls_of_convex_bodies_are_these_bodies(tmp_path: Path) -> None:
    figure = figure_at(bodies(tmp_path, unit_box(), unit_box(0.75)), "hull")
    assert figure is not None
    assert figure.low is not None
    assert figure.low <= 0.25 <= figure.value


def test_parts_have_the_thickness_of_the_thickest_two(tmp_path: Path) -> None:
    pair = bodies(tmp_path, bracket(), IN_NOTCH)
    settings = Settings(depth=True, accuracy="parts", cache_directory=str(tmp_path))
    found = ask_parts(pair, settings)
    assert found.thickness is not None
    assert found.thickness.figure == Figure(found.thickness.figure.value, None, None)
    # CoACD moves faces by little.
    assert found.thickness.figure.value == pytest.approx(0.125, rel=0.25)


def test_what_is_apart_has_no_thickness(tmp_path: Path) -> None:
    pair = bodies(tmp_path, unit_box(), moved(unit_box(), 3.0, 0.0, 0.0))
    assert figure_at(pair, "exact") is None
