"""The tables of a run of `bench/corpus.py`, from its records alone."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

Record = Mapping[str, Any]
PROVEN = ("exact", "bounded")
# An error line ends with its code.
CODE = re.compile(r"\[([a-z-]+)\]$", re.MULTILINE)
ALONE = re.compile(r"cannot collide|one connected component")


def table(records: Sequence[Record], before: Sequence[Record] | None = None) -> str:
    parts = [_files(records), _refusals(records), _surfaces(records), _pairs(records)]
    parts.append(_opinions(records))
    if before is not None:
        parts.append(_gained(records, before))
    return "\n\n".join(parts) + "\n"


def proven(pair: Record) -> bool:
    """Whether the relation of a pair is decided, of solids and by proof."""
    decided = pair.get("relation") not in (None, "indeterminate")
    return decided and pair.get("quality") in PROVEN and pair.get("undecided") is None


def _files(records: Sequence[Record]) -> str:
    rows: defaultdict[str, Counter[str]] = defaultdict(Counter)
    for record in _of(records, "file"):
        row = rows[Path(record["file"]).suffix.lower()]
        row["files"] += 1
        row[_exit(record)] += 1
    for record in _of(records, "look"):
        rows[Path(record["file"]).suffix.lower()]["refused"] += "refused" in record
        rows[Path(record["file"]).suffix.lower()]["differs"] += record.get("trimesh") == "differs"
    head = ("files", "refused", "differs", "0", "1", "2", "3", "out of time", "traceback")
    lines = [[ending, *(str(row[key]) for key in head)] for ending, row in sorted(rows.items())]
    exits = (f"exit {code}" for code in head[3:7])
    named = ("", "files", "refused", "trimesh differs", *exits, *head[7:])
    return "Files alone, by ending\n\n" + _grid(named, lines)


def _refusals(records: Sequence[Record]) -> str:
    """Why a file gets no answer: as a mesh in a scene, or alone (exit code 2)."""
    reasons: dict[str, list[str]] = {}
    for record in _of(records, "look"):
        if "refused" in record:
            reasons.setdefault(f"mesh: {record['refused']}", []).append(record["file"])
    for record in _of(records, "file"):
        if record["exit"] == 2:
            reasons.setdefault(f"alone: {_reason(record)}", []).append(record["file"])
    rows = [[reason, str(len(files)), files[0]] for reason, files in sorted(reasons.items())]
    return "No answer\n\n" + _grid(("reason", "files", "the first"), rows)


def _reason(record: Record) -> str:
    codes = {*record.get("codes", ()), *CODE.findall(record["error"])}
    if codes:
        return ", ".join(sorted(codes))
    return "one body alone" if ALONE.search(record["error"]) else record["error"][-80:].strip()


def _surfaces(records: Sequence[Record]) -> str:
    rims = Counter(record["rim"] for record in _of(records, "look") if "rim" in record)
    rows = [[kind, str(count)] for kind, count in rims.most_common()]
    return "Surfaces\n\n" + _grid(("rim", "files"), rows)


def _pairs(records: Sequence[Record]) -> str:
    rims = {record["file"]: record.get("rim") for record in _of(records, "look")}
    counts: Counter[tuple[str, ...]] = Counter()
    for record in _of(records, "pair"):
        rim = {rims.get(file) or "refused" for file in record["files"]}
        state = "both closed" if rim == {"closed"} else "a rim"
        relation = record.get("relation") or "none"
        quality = record.get("quality") or "none"
        undecided = record.get("undecided") or ""
        counts[state, relation, quality, undecided, _exit(record)] += 1
    rows = [[*key, str(count)] for key, count in sorted(counts.items())]
    pairs = list(_of(records, "pair"))
    head = f"Pairs: {len(pairs)}, {sum(map(proven, pairs))} of them proven\n\n"
    return head + _grid(("surfaces", "relation", "quality", "undecided", "exit", "pairs"), rows)


def _opinions(records: Sequence[Record]) -> str:
    opinions = list(_of(records, "opinion"))
    counts = Counter((record["claim"], record["standing"]) for record in opinions)
    rows = [[*key, str(count)] for key, count in sorted(counts.items())]
    lines = [_grid(("claim", "second opinion", "pairs"), rows)]
    for record in opinions:
        if record["standing"] in ("false", "doubted"):
            what = f"{record['standing']} {record['claim']} ({record['relation']})"
            lines.append(f"{what}: {record['kind']} {record['file']}: {record['words']}")
    return "Second opinions\n\n" + "\n".join(lines)


def _gained(records: Sequence[Record], before: Sequence[Record]) -> str:
    old = {_name(pair): pair for pair in _of(before, "pair")}
    changes: Counter[tuple[str, str]] = Counter()
    gained = lost = 0
    for pair in _of(records, "pair"):
        known = old.get(_name(pair), {})
        gained += proven(pair) and not proven(known)
        lost += proven(known) and not proven(pair)
        then, now = (_answer(record) for record in (known, pair))
        if then != now:
            changes[then, now] += 1
    rows = [[*key, str(count)] for key, count in changes.most_common()]
    head = f"Proven now and not before: {gained}; before and not now: {lost}\n\n"
    return head + _grid(("before", "now", "pairs"), rows)


def _answer(pair: Record) -> str:
    if "relation" not in pair:
        return "no answer"
    mark = "" if proven(pair) else ", not proven"
    return f"{pair['relation']}{mark}, exit {pair['exit']}"


def _name(pair: Record) -> tuple[str, str]:
    return pair["file"], pair["kind"]


def _exit(record: Record) -> str:
    if record["traceback"]:
        return "traceback"
    return "out of time" if record["exit"] is None else str(record["exit"])


def _of(records: Iterable[Record], what: str) -> Iterable[Record]:
    return (record for record in records if record["what"] == what)


def _grid(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)
