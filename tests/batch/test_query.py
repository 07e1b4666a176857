"""Questions in SQL: right answers, and no way out of the tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace

from satcheck.batch import query
from satcheck.batch.query import Tables, columns_of
from satcheck.batch.stored import Stored
from satcheck.batch.tables import TABLES
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import asset
from tests.cli.reports import BLOCK, OPEN, PENETRATING, SEPARATED, report

pytest.importorskip("duckdb")
BODIES = tuple(replace(BLOCK, id=f.b, file=f"{f.b}.obj") for f in (PENETRATING, SEPARATED))
REPORT = report(PENETRATING, SEPARATED, bodies=(BLOCK, *BODIES), issues=(OPEN,))


def stored(name: str) -> Stored:
    return Stored((name, "more"), (), asset(name, REPORT))


def ask(text: str, *results: Stored) -> list[tuple[Any, ...]]:
    with Tables(results or (stored("a"),)) as tables:
        _, rows = tables.answer(text)
        return list(rows)


def refusal(text: str) -> str:
    with pytest.raises(SatcheckError) as caught:
        ask(text)
    assert caught.value.code == "bad-query"
    return caught.value.message


def test_each_table_has_a_row_for_each_thing() -> None:
    results = [stored(name) for name in "abc"]
    counts = {"scenes": 3, "findings": 6, "issues": 3}
    assert {t: ask(f"SELECT count(*) FROM {t}", *results)[0][0] for t in TABLES} == counts


def test_figures_are_those_of_the_finding() -> None:
    (row,) = ask("SELECT a, b, relation, depth, mtv_x, fails, file_b FROM findings WHERE fails")
    f = PENETRATING
    assert f.mtv is not None
    assert row == (f.a, f.b, f.relation, f.depth, f.mtv[0], True, f"{f.b}.obj")


def test_a_figure_that_was_not_computed_is_null() -> None:
    assert ask("SELECT depth FROM findings WHERE relation = 'separated'") == [(None,)]


def test_tables_join_by_the_scene() -> None:
    text = "SELECT files, code FROM scenes JOIN issues USING (scene) JOIN findings USING (scene)"
    assert ask(text)[0] == (["a", "more"], OPEN.code)


@pytest.mark.parametrize("name", ['a"b\\c\n', "a\udcff", "\u202e", "'; DROP TABLE scenes; --"])
def test_names_are_values(name: str) -> None:
    ((found,),) = ask("SELECT scene FROM scenes", stored(name))
    assert found == name.encode(errors="backslashreplace").decode()


def test_more_rows_than_go_in_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(query, "_ROWS", 3)
    names = [f"{n}" for n in range(10)]
    assert ask("SELECT scene FROM scenes", *map(stored, names)) == [(name,) for name in names]


def test_numbers_are_kept_to_the_last_bit() -> None:
    finding = replace(PENETRATING, depth=0.1 + 0.2, depth_bounds=(5e-324, 0.1 + 0.2))
    other = asset("a", report(finding, bodies=(BLOCK, *BODIES)))
    (row,) = ask("SELECT depth, depth_lower FROM findings", Stored(("a",), (), other))
    assert row == (0.1 + 0.2, 5e-324)


@pytest.mark.parametrize(
    "text",
    [
        "SELECT * FROM read_csv('{file}')",
        "SELECT * FROM read_text('{file}')",
        "SELECT * FROM glob('{folder}/*')",
        "SELECT * FROM '{file}'",
        "COPY findings TO '{folder}/made.csv'",
        "EXPORT DATABASE '{folder}/made'",
        "ATTACH '{folder}/made.duckdb'",
        "INSTALL httpfs",
        "SET enable_external_access = true",
        "DROP TABLE findings",
        "INSERT INTO scenes (scene) VALUES ('b')",
        "SELECT 1; SELECT 2",
        "",
        "nonsense",
    ],
)
def test_what_is_no_question_is_refused(text: str, tmp_path: Path) -> None:
    file = tmp_path / "secret.csv"
    file.write_text("a,b\n1,2\n")
    assert refusal(text.format(file=file, folder=tmp_path)).startswith("--sql: ")
    assert list(tmp_path.iterdir()) == [file]


def test_parquet_holds_the_answer(tmp_path: Path) -> None:
    import duckdb

    path = tmp_path / "answer.parquet"
    with Tables([stored("a")]) as tables:
        path.write_bytes(tables.parquet("SELECT scene, depth FROM findings ORDER BY a, b;"))
        _, rows = tables.answer("SELECT scene, depth FROM findings ORDER BY a, b")
        found = duckdb.connect().execute(f"SELECT * FROM '{path}'").fetchall()
        assert found == list(rows)


def test_without_duckdb_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(query, "find_spec", lambda _: None)
    with pytest.raises(SatcheckError) as caught, Tables([]):
        pass
    assert caught.value.code == "missing-extra"
    assert "pip install 'satcheck[query]'" in caught.value.message


@pytest.mark.parametrize("table", TABLES)
def test_the_page_names_every_column(table: str) -> None:
    page = (Path(__file__).resolve().parents[2] / "docs" / "results.md").read_text("utf-8")
    section = page.split(f"`{table}`, a row for each", 1)[1].split("a row for each", 1)[0]
    assert [name for name in columns_of(table) if f"`{name}`" not in section] == []


def test_every_column_has_a_type_in_sql() -> None:
    assert columns_of("scenes")["files"] == "VARCHAR[]"
    assert columns_of("findings")["depth"] == "DOUBLE"
    assert columns_of("findings")["mtv_verified"] == "BOOLEAN"
    assert columns_of("issues")["line"] == "BIGINT"
