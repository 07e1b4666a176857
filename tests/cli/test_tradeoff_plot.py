"""The plot of made-up rungs: what lies where."""

from __future__ import annotations

from xml.etree import ElementTree

from msgspec.structs import replace

from satcheck.cli.report.tradeoff_plot import page, svg
from satcheck.studies.tradeoff import (
    RUNGS,
    Figure,
    PairTradeoff,
    Picked,
    Row,
    Times,
    Truth,
    labels_of,
)

SVG = "{http://www.w3.org/2000/svg}"
TRUTH = Truth("separated", Figure(1.0, 1.0, 1.0), 0.0)


def made(**of_rung: tuple[float, float | None]) -> PairTradeoff:
    """By name: seconds and error of rungs; those that are not named were not run."""
    rows = []
    for rung in RUNGS:
        if rung.name not in of_rung or rung.threshold not in (None, 0.1):
            rows.append(Row(rung=rung, state="not run", reason="budget"))
            continue
        seconds, error = of_rung[rung.name]
        right = None if error is None else error > -1.0
        rows.append(
            Row(
                rung=rung,
                state="answered",
                right=right,
                proven=bool(right),
                error=error,
                cold=Times((seconds,)),
                cached=Times((0.5 * seconds,)) if rung.name == "parts" else None,
            )
        )
    return PairTradeoff("a & <b>", "c", TRUTH, Picked("exact", True, ""), tuple(rows))


def markers(drawing: ElementTree.Element) -> dict[str, tuple[str, float, float]]:
    """By the label in front of its hint: class, x and y of each marker of a rung."""
    found = {}
    for element in drawing.iter():
        hint = element.find(f"{SVG}title")
        if hint is None or element.tag == f"{SVG}svg":
            continue
        if element.tag == f"{SVG}circle":
            x, y = float(element.attrib["cx"]), float(element.attrib["cy"])
        else:
            x, y = map(float, element.attrib["d"].removeprefix("M").split("l")[0].split())
        found[(hint.text or "").split(":")[0]] = (element.attrib["class"], x, y)
    return found


PAIR = made(
    aabb=(1e-4, -4.0), hull=(1e-3, -0.5), parts=(2.0, -0.01), exact=(0.1, 0.0), boolean=(1, None)
)


def test_slower_is_further_right_and_nearer_is_lower() -> None:
    seen = markers(ElementTree.fromstring(svg([PAIR])))
    by_time = ["aabb", "hull", "exact", "parts 0.1, cached", "boolean", "parts 0.1"]
    assert sorted(seen, key=lambda label: seen[label][1]) == by_time
    by_error = ["aabb", "hull", "parts 0.1", "exact", "boolean"]
    lower = [seen[label][2] for label in by_error]
    assert lower == sorted(lower)
    assert len(set(lower)) == len(lower)


def test_what_is_wrong_is_a_cross() -> None:
    seen = markers(ElementTree.fromstring(svg([PAIR])))
    assert {label: found[0] for label, found in seen.items()} == {
        "aabb": "wrong",
        "hull": "proven",
        "parts 0.1": "proven",
        "parts 0.1, cached": "proven cached",
        "exact": "proven",
        "boolean": "guess",
    }


def test_every_rung_is_named_whatever_became_of_it() -> None:
    for pairs in ([PAIR], [made()], [made(exact=(0.1, 0.0)), PAIR]):
        text = "\n".join(ElementTree.fromstring(svg(pairs)).itertext())
        for pair in pairs:
            drawn = [row.rung for row in pair.rows if row.state == "answered"]
            assert all(rung.label in text for rung in drawn)
            left_out = labels_of([rung for rung in RUNGS if rung not in drawn])
            assert f"{left_out}: not run, budget" in text
        assert text.count(
            "a & <b> against c: separated, 1 apart; the default settles it by: exact"
        ) == len(pairs)


def test_the_price_of_each_step_is_written_over_the_plot() -> None:
    worth = ("aabb", "hull", "exact")
    rows = tuple(replace(row, on_front=row.rung.name in worth) for row in PAIR.rows)
    text = "\n".join(ElementTree.fromstring(svg([replace(PAIR, rows=rows)])).itertext())
    assert "aabb to hull: 10 times the time, error 4 to 0.5, wrong to proven" in text
    assert "hull to exact: 100 times the time, error 0.5 to 0" in text


def test_the_page_holds_the_drawing() -> None:
    assert svg([PAIR]) in page([PAIR])
