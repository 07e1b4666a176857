"""Questions in SQL about the results of a batch, answered by DuckDB.

The results go into a database in a temporary folder, which a query then reads. A query can change
nothing and opens no other file: the database is read-only, the access to files is off
(`enable_external_access`), and no setting can be changed (`lock_configuration`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from types import NoneType
from typing import TYPE_CHECKING, Any, Self, get_args, get_type_hints

import msgspec

from satcheck.batch.stored import Stored
from satcheck.batch.tables import TABLES, Row, rows
from satcheck.core.errors import SatcheckError

if TYPE_CHECKING:
    from duckdb import DuckDBPyConnection

# Rows that go into the database at a time.
_ROWS = 20_000
_TYPES = {
    str: "VARCHAR",
    int: "BIGINT",
    float: "DOUBLE",
    bool: "BOOLEAN",
    tuple[str, ...]: "VARCHAR[]",
}
_NO_EXTENSIONS: dict[str, str | bool | int | float | list[str]] = {
    "autoinstall_known_extensions": False,
    "autoload_known_extensions": False,
}


def require_duckdb() -> None:
    """Raises SatcheckError: `missing-extra`."""
    if find_spec("duckdb") is None:
        reason = "questions in SQL and Parquet need DuckDB: pip install 'satcheck[query]'"
        raise SatcheckError("missing-extra", reason)


def columns_of(table: str) -> dict[str, str]:
    """Name -> type in SQL."""
    return {name: _type(hint) for name, hint in get_type_hints(TABLES[table]).items()}


class Tables:
    """The tables `scenes`, `findings` and `issues` (`batch/tables.py`). Use it in a `with`
    statement. Raises SatcheckError: `missing-extra`; `bad-query`, with the words of DuckDB."""

    def __init__(self, results: Iterable[Stored]) -> None:
        self._results = results

    def __enter__(self) -> Self:
        require_duckdb()
        import duckdb

        with ExitStack() as stack:
            folder = Path(stack.enter_context(TemporaryDirectory(prefix="satcheck-")))
            database = str(folder / "results.duckdb")
            with duckdb.connect(database, config=_NO_EXTENSIONS) as writing:
                _load(writing, self._results, folder)
            self._parquet = folder / "answer.parquet"
            reading = duckdb.connect(database, read_only=True, config=_NO_EXTENSIONS)
            self._connection = stack.enter_context(reading)
            self._connection.execute(f"SET allowed_paths = ['{_quoted(self._parquet)}']")
            self._connection.execute("SET enable_external_access = false")
            self._connection.execute("SET lock_configuration = true")
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def answer(self, query: str) -> tuple[list[str], Iterator[tuple[Any, ...]]]:
        """The names of the columns, and the rows, as they are taken."""
        self._run(_one(query, self._connection))
        names = [column[0] for column in self._connection.description or ()]
        return names, self._rows()

    def parquet(self, query: str) -> bytes:
        """The answer as a file."""
        text = _one(query, self._connection)
        self._run(f"COPY ({text}) TO '{_quoted(self._parquet)}' (FORMAT parquet)")
        return self._parquet.read_bytes()

    def _rows(self) -> Iterator[tuple[Any, ...]]:
        while some := self._connection.fetchmany(_ROWS):
            yield from some

    def _run(self, query: str) -> None:
        import duckdb

        try:
            self._connection.execute(query)
        except duckdb.Error as error:
            raise _bad(str(error)) from None


def _one(query: str, connection: DuckDBPyConnection) -> str:
    """The query without its end. It is the only one."""
    import duckdb

    try:
        statements = connection.extract_statements(query)
    except duckdb.Error as error:
        raise _bad(str(error)) from None
    if len(statements) != 1:
        raise _bad(f"one query is needed, and there are {len(statements)}")
    return statements[0].query.strip().rstrip(";")


def _bad(reason: str) -> SatcheckError:
    """In one line, without the place that DuckDB draws below the query."""
    told = " ".join(reason.partition("\n\nLINE ")[0].split())
    return SatcheckError("bad-query", f"--sql: {told}")


def _load(connection: DuckDBPyConnection, results: Iterable[Stored], folder: Path) -> None:
    for table in TABLES:
        columns = ", ".join(f"{name} {kind}" for name, kind in columns_of(table).items())
        connection.execute(f"CREATE TABLE {table} ({columns})")
    every = (each for stored in results for each in rows(stored))
    while some := list(islice(every, _ROWS)):
        for table in TABLES:
            _insert(connection, table, [row for name, row in some if name == table], folder)


def _insert(connection: DuckDBPyConnection, table: str, added: list[Row], folder: Path) -> None:
    """By a file of JSON Lines: DuckDB reads it many times faster than it takes single rows."""
    if not added:
        return
    path = folder / "rows.jsonl"
    with path.open("wb") as file:
        file.writelines(map(_line, added))
    columns = ", ".join(f"{name}: '{kind}'" for name, kind in columns_of(table).items())
    connection.execute(
        f"INSERT INTO {table} SELECT * FROM read_json('{_quoted(path)}', "
        f"format = 'newline_delimited', columns = {{{columns}}})"
    )


def _line(row: Row) -> bytes:
    try:
        return msgspec.json.encode(row) + b"\n"
    except UnicodeEncodeError:
        return msgspec.json.encode(_escaped(msgspec.to_builtins(row))) + b"\n"


def _escaped(value: Any) -> Any:
    """The bytes of file names that are not UTF-8 as escapes."""
    if isinstance(value, dict):
        return {key: _escaped(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_escaped(each) for each in value]
    return value.encode(errors="backslashreplace").decode() if isinstance(value, str) else value


def _quoted(path: Path) -> str:
    return str(path).replace("'", "''")


def _type(hint: Any) -> str:
    parts = [part for part in get_args(hint) if part is not NoneType]
    return _TYPES[parts[0] if NoneType in get_args(hint) else hint]
