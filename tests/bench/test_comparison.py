"""Turns, ratios and answers of bench/compare.py, without a clock and without a build."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from bench import compare
from bench.comparison import answers, measuring, ratios, sides
from bench.comparison.answers import Answers
from bench.comparison.benches import BENCHES
from bench.comparison.measuring import Row, spellings
from bench.comparison.ratios import Failure, Line, Sample, judged, record, summary, table
from bench.comparison.sides import CannotCompare, Side

SAME = Answers("same", [[1.0, 2.0]])
PLACES = Side("old", Path("old")), Side("new", Path("new"))


def line(*rounds: tuple[float, float], old: Answers = SAME, new: Answers = SAME) -> Line:
    """CPU seconds of OLD and NEW in each round; the wall takes twice as long on NEW."""
    made = Line("bench", "row")
    for before, after in rounds:
        made.outcomes[0].append(Sample(before, before, old))
        made.outcomes[1].append(Sample(after, 2 * after, new))
    return made


def report(relation: str, depth: list[float | None] | None) -> bytes:
    bounds = {"depth_bounds": depth, "thickness_bounds": None}
    finding = {"a": "a", "b": "b", "relation": relation, **bounds}
    summary = {"verdict": "fail"}
    return json.dumps(
        {"summary": summary, "bodies": [{"triangles": 12}], "findings": [finding]}
    ).encode()


def test_both_sides_are_asked_in_each_round_in_alternating_order() -> None:
    asked: list[str] = []

    def measure(side: Side) -> Sample:
        asked.append(side.name)
        return Sample(1.0, 1.0, SAME)

    rows = [Row("bench", "first", measure), Row("bench", "second", measure)]
    lines = compare.measured(rows, PLACES, 3)
    assert asked == 2 * ["old", "new"] + 2 * ["new", "old"] + 2 * ["old", "new"]
    assert [len(each.pairs()) for each in lines] == [3, 3]


def test_a_row_that_fails_on_one_side_has_no_ratio_and_is_not_asked_again() -> None:
    asked: list[str] = []

    def measure(side: Side) -> Sample:
        asked.append(side.name)
        if side.name == "new":
            raise RuntimeError("exit code 2\nError: No such thing.\nTry another.")
        return Sample(1.0, 1.0, SAME)

    lines = compare.measured([Row("bench", "row", measure)], PLACES, 6)
    assert asked == ["old", "new"]
    assert judged(lines, "cpu")["failed"] == ["bench: row"]
    assert judged(lines, "cpu")["faster"] == []
    last = table(lines, "cpu").splitlines()[-1]
    assert last == "| bench | row | - | - | - | - | - | - | NEW: Error: No such thing. |"
    assert record(lines[0])["NEW"] == [{"failure": "Error: No such thing."}]


def test_the_ratio_is_the_median_of_those_of_the_rounds() -> None:
    one = line((1.0, 1.1), (4.0, 4.0), (2.0, 4.0))
    row = "| bench | row | 2000 | 4000 | 1.100 | 1.000 | 2.000 | 3 |  |"
    assert table([one], "cpu").splitlines()[-1] == row
    row = "| bench | row | 2000 | 8000 | 2.200 | 2.000 | 4.000 | 3 |  |"
    assert table([one], "wall").splitlines()[-1] == row


def test_slower_and_faster_are_rows_whose_every_round_says_so() -> None:
    slower, faster = line(*5 * [(1.0, 1.06)]), line(*5 * [(1.0, 0.94)])
    assert judged([slower], "cpu")["slower"] == ["bench: row"]
    assert judged([faster], "cpu")["faster"] == ["bench: row"]
    mixed = [
        line(*4 * [(1.0, 1.06)], (1.0, 1.04)),
        line(*4 * [(1.0, 0.94)], (1.0, 0.96)),
        line(*4 * [(1.0, 1.06)]),  # too few rounds
    ]
    assert not any(judged(mixed, "cpu").values())
    assert summary(mixed, "cpu").splitlines() == [
        "slower: none",
        "faster: none",
        "answers differ: none",
        "failed: none",
    ]
    assert judged([faster], "wall")["slower"] == ["bench: row"]


def test_other_answers_stand_beside_the_row() -> None:
    one = line((1.0, 0.1), new=Answers("other", SAME.bounds))
    assert table([one], "cpu").endswith("| answers differ |")
    assert judged([one], "cpu")["answers differ"] == ["bench: row"]


def test_intervals_agree_when_they_meet() -> None:
    assert SAME.agree(Answers("same", [[1.5, 3.0]]))
    assert SAME.agree(Answers("same", [[2.0, 3.0]]))
    assert not SAME.agree(Answers("same", [[2.1, 3.0]]))
    assert not SAME.agree(Answers("same", []))
    assert not SAME.agree(Answers("other", [[1.0, 2.0]]))


def test_reports_are_compared_by_relations_and_bounds() -> None:
    deep = answers.of_report(report("penetrating", [1.0, 1.1]))
    assert deep.agree(answers.of_report(report("penetrating", [1.05, None])))
    assert not deep.agree(answers.of_report(report("penetrating", [1.2, 1.3])))
    assert not deep.agree(answers.of_report(report("touching", None)))
    result = json.dumps({"report": json.loads(report("penetrating", [1.0, 1.1]))}).encode()
    assert answers.of_results(result + b"\n" + result) == Answers(
        answers.of_results(result + b"\n" + result).digest, 2 * [[1.0, 1.1]]
    )
    assert not answers.of_results(result).agree(answers.of_results(result + b"\n" + result))


def test_poses_are_compared_by_how_often_pairs_meet() -> None:
    def of(overlaps: int) -> Answers:
        pair = dict.fromkeys(("touches", "near", "undecided"), 0)
        pairs = [{"a": "a", "b": "b", "overlaps": overlaps, **pair}]
        data = {"summary": {"verdict": "fail"}, "pairs": pairs}
        return answers.of_samples(json.dumps(data).encode())

    assert of(3).agree(of(3))
    assert not of(3).agree(of(4))


def test_an_answer_of_another_form_is_a_failure(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    out = tmp_path / "report.json"

    def run(command: list[str], fine: tuple[int, ...]) -> tuple[float, float, int, bytes]:
        assert fine == measuring.FINE
        Path(command[-1]).write_text("{}")
        return 1.0, 1.0, 1, b""

    monkeypatch.setattr(measuring, "run", run)
    row = Row("bench", "row", measuring.check(["a", "b"], answers.of_report, out, 2))
    assert row.outcome(PLACES[0]) == Failure("its answer has another form: KeyError('findings')")


def test_a_side_is_asked_in_the_words_that_it_knows(monkeypatch: pytest.MonkeyPatch) -> None:
    known = {"old": "--before", "new": "--last"}
    asked: list[str] = []

    def run(command: list[str], _: tuple[int, ...]) -> tuple[float, float, int, bytes]:
        asked.append(command[1])
        side = Path(command[0]).parent.name
        if command[1] != known[side]:
            raise RuntimeError(f"exit code 2\nError: No such option '{command[1]}'.")
        return 2.0, 1.0, 1, b""

    monkeypatch.setattr(measuring, "run", run)
    monkeypatch.setattr(measuring, "RENAMED", (("--before", "--after"), ("--after", "--last")))
    assert list(spellings(["a", "--before"])) == [
        ["a", w] for w in ("--before", "--after", "--last")
    ]
    measure = measuring.command(["--before"], answers.of_nothing, None, 1)
    for name in known:
        assert measure(Side(name, Path(name) / "python")).cpu == 1.0
    assert asked == ["--before", "--before", "--after", "--last"]
    known["new"] = "--none"
    with pytest.raises(RuntimeError, match="--last"):
        measure(Side("new", Path("new") / "python"))


def test_an_unknown_bench_names_those_that_exist() -> None:
    assert compare.chosen([]) == list(BENCHES)
    assert compare.chosen(["batch", "depth"]) == ["batch", "depth"]
    with pytest.raises(CannotCompare, match="no bench deep; there are: convex, depth, thickness"):
        compare.chosen(["depth", "deep"])


def test_an_environment_is_taken_as_it_is(tmp_path: Path) -> None:
    python = tmp_path / "bin" / "python"
    python.parent.mkdir()
    python.touch()
    with pytest.raises(CannotCompare, match=r"there is no .*satcheck"):
        sides.side_of(str(tmp_path))
    python.with_name("satcheck").touch()
    assert sides.side_of(str(tmp_path)).python == python
    assert sides.side_of(str(python)).satcheck == python.with_name("satcheck")


def test_a_name_that_is_no_commit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CannotCompare, match="no-such-commit: neither a commit nor an environment"):
        sides.side_of("no-such-commit", tmp_path)


def test_a_commit_that_was_built_is_not_built_again(tmp_path: Path) -> None:
    folder = tmp_path / "0123456789ab"
    folder.mkdir()
    (folder / sides.BUILT).touch()
    assert sides.built("0123456789abcdef", tmp_path) == folder / "venv" / "bin" / "python"


def test_sides_take_turns() -> None:
    order = [ratios.turns(k) for k in range(3)]
    assert order == [(ratios.OLD, ratios.NEW), (ratios.NEW, ratios.OLD), (ratios.OLD, ratios.NEW)]
