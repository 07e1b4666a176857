"""The page of made-up pairs: what it says, counts and draws."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest

from bench.accuracy.page import Page, Run, page
from satcheck.cli.plotting import DARK, LIGHT
from tests.bench.made import HEADER, LABELS, Record, record, row, silent, times


def slow_parts(*, overlap: bool) -> dict[str, Record]:
    return {
        label: row(label, overlap=overlap, cold=times(2.0), cpu=times(2.0), error=-0.02)
        for label in LABELS
        if label.startswith("parts")
    }


FOOLED = {label: row(label, error=-1.0, proven=False) for label in ("aabb", "obb", "hull")}
RECORDS = [
    record("deep", rows=slow_parts(overlap=True), overlap=True, way_out=1.0),
    record(
        "apart",
        relation="separated",
        bounds=(0.5, 0.5),
        rows=FOOLED
        | slow_parts(overlap=False)
        | {"parts 0.01": silent("parts 0.01", "not run", "budget")},
        overlap=False,
    ),
    record("convex", picked="hull"),
    record("flush", relation="touching", bounds=(0.0, 0.0), picked="hull"),
    {"case": record("lost")["case"], "failure": "exit code -6", "seconds": 1.0},
]


def made(records: list[Record]) -> Page:
    return page(Run(HEADER, records, ["5 pairs of `x`"], "All is made up.", "make it", "folder"))


@pytest.fixture(scope="module")
def whole() -> Page:
    return made(RECORDS)


def tables(text: str) -> list[list[list[str]]]:
    blocks = re.findall(r"(?:^\|.*\|$\n?)+", text, re.MULTILINE)
    return [
        [[cell.strip() for cell in line[1:-1].split("|")] for line in block.strip().splitlines()]
        for block in blocks
    ]


def table(text: str, head: str) -> dict[str, list[str]]:
    """By the first cell of its rows, the one with this column."""
    (found,) = [rows for rows in tables(text) if head in rows[0]]
    return {cells[0]: cells[1:] for cells in found[2:]}


def test_every_figure_is_shown_light_and_dark_and_can_be_drawn(whole: Page) -> None:
    linked = re.findall(r"folder/([\w-]+\.svg)", whole.text)
    assert sorted(linked) == sorted(whole.figures)
    for name, drawing in whole.figures.items():
        words = "".join(ElementTree.fromstring(drawing).itertext())
        assert "nan" not in drawing.decode()
        assert "hull" in words
        assert (DARK if "-dark" in name else LIGHT).paper in drawing.decode()


def test_tables_are_rectangles_with_every_rung(whole: Page) -> None:
    for rows in tables(whole.text):
        assert len({len(cells) for cells in rows}) == 1, rows[0]
    assert list(table(whole.text, "cached")) == LABELS


def test_verdicts_are_counted(whole: Page) -> None:
    assert "0 misses in 9 verdicts" in whole.text
    assert "wrong: 0." in whole.text


def test_the_opening_says_what_the_steps_cost(whole: Page) -> None:
    assert "same 4 pairs" in whole.text
    # Boxes and hulls over all four pairs, the proof over the two that they leave open.
    assert "the median error goes from 0 to 0, wrong verdicts from 1 to 1" in whole.text
    assert "Boxes and hulls together settle 2 pairs." in whole.text
    assert "the time on the other 2:" in whole.text
    # The median of errors 0.5 and 0 of a body of size 2.
    assert "goes from 25 % to 0, wrong verdicts from 1 to 0" in whole.text
    assert "2000 times at a threshold of 0.5 (2 pairs, 0 wrong, median error 1 %)" in whole.text
    assert "2000 times at a threshold of 0.01 (1 pair," in whole.text


def test_what_was_lost_and_left_out_is_told(whole: Page) -> None:
    assert "could not be measured: 1 (lost: exit code -6)" in whole.text
    assert "- not run: the budget of the pair was spent, or too little left (1)" in whole.text
    assert "on 2001-02-03" in whole.text.lower()
    assert "an abacus, 2 cores" in whole.text


def test_a_miss_and_a_false_proof_of_a_sound_rung_are_not_hidden() -> None:
    text = made([*RECORDS, record("missed", rows={"hull": row("hull", overlap=False)})]).text
    assert "1 miss in 12 verdicts" in text
    assert "that are wrong: 1." in text


def test_a_proof_against_the_corpus_is_told() -> None:
    text = made([*RECORDS, record("denied", overlap=False, way_out=0.5)]).text
    assert "1 of 3 verdicts differ" in text
    assert "1 of 2 depths have a lower bound above" in text
