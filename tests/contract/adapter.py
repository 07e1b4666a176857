"""What counts of a report: the one place that knows the keys of the JSON documents.

A fact is None, a word, a number, a list or a table of facts. Facts that are None are left out. An
interval of a figure is a list of its two ends.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import Any

Facts = dict[str, Any]
Document = Mapping[str, Any]


def facts_of(text: str) -> Facts:
    """Return the facts of a JSON document, or of JSON Lines; none of a text that is neither."""
    if not text.startswith("{"):
        return {}
    try:
        return _facts(json.loads(text))
    except json.JSONDecodeError:
        return {"scenes": _table(_result(json.loads(line)) for line in text.splitlines())}


def _facts(document: Document) -> Facts:
    return READERS[document["schema"]](document)


def _report(report: Document) -> Facts:
    summary = report["summary"]
    counts = {**summary["pairs"], "disputed": summary["disputed"], "accepted": summary["accepted"]}
    return _known(
        verdict=summary["verdict"],
        pairs=_counts(counts),
        surfaces_only=summary["surfaces_only"] or None,
        issues=_issues(report["issues"]),
        findings=_table(map(_finding, report["findings"])),
        answers=_table(map(_answer, _body_answers(report))) or None,
        floating=_floating(report),
    )


def _finding(finding: Document) -> tuple[str, Facts]:
    return _pair(finding), _known(
        relation=finding["relation"],
        exact_relation=finding["exact_relation"],
        placed_relation=finding["placed_relation"],
        severity=finding["severity"],
        undecided=finding["undecided"],
        quality=finding["quality"],
        depth=finding["depth_bounds"],
        thickness=finding["thickness_bounds"],
        distance=finding["distance_bounds"] or _exactly(finding["distance"]),
        volume=_exactly(finding["volume"]),
        mtv_verified=finding["mtv_verified"],
        contacts=finding["contacts"] and _contacts(finding["contacts"]["totals"]),
        components=finding["components"] and _components(finding["components"]),
        motion=finding["motion"] and _sweep(finding["motion"]),
        baseline=finding["baseline_state"],
    )


def _contacts(totals: Document) -> Facts:
    return {"length": _exactly(totals["length"]), "area": _exactly(totals["area"])}


def _components(components: Document) -> Facts:
    """The thickest first, as the report lists them."""
    return _known(
        resolved=components["resolved"],
        items=[
            _known(
                passes=item["passes"],
                thickness=item["thickness_bounds"],
                volume=_exactly(item["volume"]),
            )
            for item in components["items"]
        ],
    )


def _sweep(sweep: Document) -> Facts:
    worst = sweep["worst"] or {}
    return _known(
        relation=sweep["relation"],
        time_of_impact=sweep["time_of_impact"],
        distance=worst.get("distance"),
        depth=worst.get("depth"),
        proven=sweep["proven"],
    )


def _body_answers(report: Document) -> list[Document]:
    """The answers to the rules about single bodies; the report has none if no rule asks."""
    held = report.get("statics", {}).get("findings", [])
    return [*held, *report.get("regions", {}).get("findings", [])]


def _answer(answer: Document) -> tuple[str, str]:
    question = answer.get("question") or f"inside {answer['region']}"
    return f"{answer['body']} {question}", f"{answer['answer']}, {answer['severity']}"


def _floating(report: Document) -> list[str] | None:
    bodies = report.get("statics", {}).get("bodies", [])
    return sorted(body["id"] for body in bodies if body["floating"] == "yes") or None


def _samples(report: Document) -> Facts:
    """Of a check of many poses. A pose that is listed is a report of its own."""
    summary = report["summary"]
    return _known(
        verdict=summary["verdict"],
        samples=summary["samples"],
        by_verdict=_counts(summary["by_verdict"]),
        pairs=_counts(summary["pairs"]),
        issues=_issues(report["issues"]),
        findings=_table((_pair(pair), _pair_in_poses(pair)) for pair in report["pairs"]),
        poses=_table(map(_pose, report["samples"])),
    )


def _pair_in_poses(pair: Document) -> Facts:
    keys = ("overlaps", "touches", "near", "undecided", "first_overlap")
    return _known(**{key: pair[key] or None for key in keys})


def _pose(sample: Document) -> tuple[str, Facts]:
    return str(sample["number"]), _known(
        verdict=sample["verdict"],
        issues=_issues(sample["issues"]) or None,
        findings=_table(map(_finding, sample["findings"])) or None,
    )


def _assets(report: Document) -> Facts:
    return _known(
        verdict=report["verdict"],
        counts=_counts(report["counts"]),
        issues=_issues(report["issues"]),
        scenes=_table(map(_asset, report["assets"])),
    )


def _asset(asset: Document) -> tuple[str, Facts]:
    return asset["file"], {**_report(asset["report"]), "verdict": asset["verdict"]}


def _result(result: Document) -> tuple[str, Facts]:
    facts = {**_report(result["report"]), "verdict": result["verdict"]}
    return " + ".join(result["files"]), facts


def _resolution(report: Document) -> Facts:
    """Other translations are as good, if they are not much longer and end the same overlaps."""
    summary = report["summary"]
    pinned = set(report["pinned"])
    return _known(
        verdict=summary["verdict"],
        check=report["check"]["verdict"],
        conflicts=summary["conflicts"],
        remaining=summary["remaining"],
        left=sorted(map(_pair, report["left"])),
        pinned=sorted(pinned),
        pinned_and_moved=sorted(pinned & {move["body"] for move in report["moves"]}),
        total_motion=summary["total_motion"],
        issues=_issues(report["issues"]),
    )


def _verification(report: Document) -> Facts:
    return _known(
        accepted=report["accepted"],
        findings=_table(map(_verified, report["findings"])),
        answers=_table(
            (f"{answer['body']} {answer['question']}", f"{answer['answer']}, {answer['outcome']}")
            for answer in report.get("support", [])
        )
        or None,
        faults=len(report["faults"]),
    )


def _verified(finding: Document) -> tuple[str, Facts]:
    return _pair(finding), _known(
        relation=finding["relation"],
        outcome=finding["outcome"],
        depth_proven=finding["depth"] or None,
        mtv_proven=finding["mtv"] or None,
        thickness_proven=finding["thickness"] or None,
    )


def _pair(pair: Document) -> str:
    return f"{pair['a']} | {pair['b']}"


def _issues(issues: Iterable[Document]) -> list[str]:
    """Return severity and code of each issue, with the body or else the file that it is about."""
    return sorted(
        f"{issue['severity']} {issue['code']} {issue['body'] or issue['file'] or ''}".rstrip()
        for issue in issues
    )


def _counts(counts: Mapping[str, int]) -> dict[str, int]:
    return {key: count for key, count in counts.items() if count}


def _exactly(figure: float | None) -> list[float] | None:
    """Return the interval of a figure that the report states without bounds."""
    return None if figure is None else [figure, figure]


def _known(**facts: Any) -> Facts:
    return {key: fact for key, fact in facts.items() if fact is not None}


def _table(rows: Iterable[tuple[str, Any]]) -> Facts:
    """ValueError: two rows have the same name."""
    listed = list(rows)
    twice = [name for name, count in Counter(name for name, _ in listed).items() if count > 1]
    if twice:
        raise ValueError(f"not told apart: {', '.join(twice)}")
    return dict(listed)


READERS: dict[str, Callable[[Document], Facts]] = {
    "satcheck.report/1": _report,
    "satcheck.samples/1": _samples,
    "satcheck.assets/1": _assets,
    "satcheck.resolution/1": _resolution,
    "satcheck.verification/1": _verification,
}
