"""Run a call of the contract, and read and write the pinned facts."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from tests.contract.adapter import Facts, facts_of
from tests.contract.cases import GROUPS, HERE, OUT, Arguments, Call

PINNED = HERE / "pinned"
# Exit code and standard output of the command in a folder.
Run = Callable[[Arguments, Path], tuple[int, str]]


def facts(call: Call, run: Run) -> Facts:
    with tempfile.TemporaryDirectory() as out:

        def filled(text: str) -> str:
            return text.replace(OUT, out)

        def done(arguments: Arguments) -> tuple[int, str]:
            return run(tuple(map(filled, arguments)), call.folder)

        before = [done(arguments)[0] for arguments in call.before]
        code, text = done(call.arguments)
        if call.document:
            text = Path(filled(call.document)).read_text(encoding="utf-8")
        made: Facts = {"exit": code, **facts_of(text)}
        return {"before": before, **made} if before else made


def pinned(group: str, folder: Path = PINNED) -> dict[str, Facts]:
    loaded: dict[str, Facts] = json.loads((folder / f"{group}.json").read_text(encoding="utf-8"))
    return loaded


def pin(run: Run, folder: Path) -> None:
    """Write the facts of all calls, a file for each group."""
    for group, calls in GROUPS.items():
        text = written({call.name: facts(call, run) for call in calls()})
        (folder / f"{group}.json").write_text(text, encoding="utf-8", newline="\n")


def written(values: Mapping[str, Any]) -> str:
    """JSON with the facts of a call, a finding or an answer on a line of their own, sorted."""
    return "\n".join(_lines("", values, "")) + "\n"


# Tables with a row on each line.
_TABLES = frozenset({"answers", "findings", "poses", "scenes"})


def _lines(head: str, table: Mapping[str, Any], indent: str) -> list[str]:
    """The facts of one call are a line, and each row of its tables another one."""
    if not table:
        return [f"{indent}{head}{{}}"]
    made = [f"{indent}{head}{{"]
    rows = [(json.dumps(key) + ": ", row) for key, row in sorted(table.items())]
    for number, (key, row) in enumerate(rows, start=1):
        lines = _row(key, row, indent + " ")
        lines[-1] += "," if number < len(rows) else ""
        made += lines
    return [*made, f"{indent}}}"]


def _row(key: str, row: Any, indent: str) -> list[str]:
    tables = sorted(_TABLES & row.keys()) if isinstance(row, Mapping) else []
    if not tables:
        return [indent + key + _line(row)]
    plain = _line({name: fact for name, fact in row.items() if name not in tables})
    lines = [indent + key + plain.removesuffix("}")]
    for table in tables:
        lines[-1] += ", " if lines[-1][-1] != "{" else ""
        lines += _lines(json.dumps(table) + ": ", row[table], indent + " ")
    lines[-1] += "}"
    return lines


def _line(value: Any) -> str:
    return json.dumps(value, sort_keys=True, ensure_ascii=False)
