"""One measurement of a row: a whole command, or a question to the Python interface, in a child."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from bench.comparison.answers import Answers, Reading, digest, of_nothing
from bench.comparison.ratios import Failure, Outcome, Sample
from bench.comparison.sides import Side
from bench.scenes import run

ASK = Path(__file__).with_name("ask.py")
# Exit codes of checks: nothing fails, something fails, not everything is decided.
FINE = (0, 1, 3)
# Commands and options that were renamed, oldest first: (before, after). A side that does not know
# one spelling is asked with the next one.
RENAMED: tuple[tuple[str, str], ...] = (
    ("--depth-budget", "--budget"),
    ("--seconds-per-file=600", "--limit=seconds=600"),
)
UNKNOWN = ("No such option", "No such command")

Measure = Callable[[Side], Sample]


@dataclass(frozen=True, slots=True)
class Row:
    """measure: raises RuntimeError where there is no figure."""

    bench: str
    name: str
    measure: Measure

    def outcome(self, side: Side) -> Outcome:
        try:
            return self.measure(side)
        except RuntimeError as error:
            return Failure(reason_in(str(error)))


def reason_in(output: str) -> str:
    """The last line that speaks of an error: hints may follow it."""
    lines = output.splitlines()
    return ([line for line in lines if "rror" in line] or lines)[-1]


def spellings(words: Sequence[str]) -> Iterator[list[str]]:
    """The words as each commit knows them, from the oldest on."""
    line = list(words)
    yield line
    for before, after in RENAMED:
        if before in line:
            line = [after if word == before else word for word in line]
            yield line


def check(words: Sequence[str], reading: Reading, out: Path, runs: int) -> Measure:
    """`satcheck WORDS -o OUT`, the least times of so many runs; no config file changes it."""
    return command([*words, "--no-config", "-o", str(out)], reading, out, runs)


def command(words: Sequence[str], reading: Reading, out: Path | None, runs: int) -> Measure:
    """`satcheck WORDS`; its answers stand in `out`, or on standard output."""

    def measure(side: Side) -> Sample:
        for line in spellings(words):
            try:
                return process([str(side.satcheck), *line], reading, out, runs)
            except RuntimeError as error:
                refused = error
                if not any(word in str(error) for word in UNKNOWN):
                    break
        raise refused

    return measure


def python(words: Sequence[str], runs: int) -> Measure:
    """The Python of the environment with these words."""
    return lambda side: process([str(side.python), *words], of_nothing, None, runs)


def process(line: list[str], reading: Reading, out: Path | None, runs: int) -> Sample:
    """The least times of fresh processes."""
    done = []
    for _ in range(runs):
        if out:
            out.unlink(missing_ok=True)  # a batch refuses to write over results
        done.append(run(line, FINE))
    try:
        answers = reading(out.read_bytes() if out else done[0][3])
    except (KeyError, TypeError, ValueError) as error:
        raise RuntimeError(f"its answer has another form: {error!r}") from None
    return Sample(min(cpu for _, cpu, _, _ in done), min(wall for wall, _, _, _ in done), answers)


def ask(*words: str) -> Measure:
    """A question of ask.py, which measures itself: neither start nor reading count."""

    def measure(side: Side) -> Sample:
        said = json.loads(run([str(side.python), "-P", str(ASK), *words], (0,))[3])
        return Sample(said["cpu"], said["wall"], Answers(digest(said["facts"]), said["bounds"]))

    return measure
