"""Sizes that make an answer doubtful are warnings, and the last line repeats them."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit import Report, Settings, check
from satcheck.cli.formats.table import render
from satcheck.cli.output import Page
from satcheck.scene import Rule, Selector, load_scene
from tests.audit.shapes import box, write


def report_of(
    folder: Path, *sizes: float, tolerance: float | None = None, rule: float | None = None
) -> Report:
    """Boxes with a common corner."""
    meshes = {f"b{k}": box((0, 0, 0), (size, size / 8, size / 8)) for k, size in enumerate(sizes)}
    rules = () if rule is None else (Rule(a=Selector("b0"), b=Selector("b1"), tolerance=rule),)
    scene = replace(load_scene(write(folder, **meshes)), rules=rules)
    return check(scene, Settings(tolerance=tolerance))


def text_of(report: Report) -> str:
    page = Page(width=400, colour=False, unicode=True)
    return render(report, page, explain=False, timings=False)


def said(report: Report, code: str) -> list[str]:
    return [issue.message for issue in report.issues if issue.code == code]


@pytest.mark.parametrize(("size", "doubtful"), [(2.1, False), (2.0, True), (1.0, True)])
def test_a_thousandfold_is_doubtful(tmp_path: Path, size: float, doubtful: bool) -> None:
    report = report_of(tmp_path, 1000.0, size, 30.0)
    found = said(report, "sizes-differ")
    assert bool(found) == doubtful
    if doubtful:
        assert found == [f"b1 is {size:g} in size and b0 1e+03: is one of them in another unit?"]
        assert f"\nwarning: {found[0]} [" in text_of(report)


@pytest.mark.parametrize(
    ("tolerance", "rule", "small"),
    [(None, None, []), (0.5, None, []), (1.5, None, ["b0"]), (None, 1.5, ["b0"]), (1.5, 0.1, [])],
)
def test_a_tolerance_larger_than_a_body(
    tmp_path: Path, tolerance: float | None, rule: float | None, small: list[str]
) -> None:
    report = report_of(tmp_path, 1.0, 3.0, tolerance=tolerance, rule=rule)
    found = [issue for issue in report.issues if issue.code == "tolerance-large"]
    assert [issue.body for issue in found] == small
    if small:
        message = "b0 is smaller than the tolerance 1.5, within which an overlap counts as touching"
        assert found[0].message == message
        assert f"\nwarning: {message} [" in text_of(report)
