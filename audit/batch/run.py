"""A batch: the worlds that are not done yet go through an engine, and results to their file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Generator, Sequence
from contextlib import closing, suppress
from functools import lru_cache

from msgspec import Struct, field

from satcheck.audit.batch.key import digest, inputs_of, key_of, terms_of
from satcheck.audit.batch.options import CheckOptions, Limits, World
from satcheck.audit.batch.results import Head, ResultsFile
from satcheck.audit.batch.slot_server import Answer
from satcheck.report.assets import AssetVerdict
from satcheck.report.report import Issue

# Gives the answers for worlds, in any order. After a KeyboardInterrupt that is thrown, those that
# it still has.
Engine = Callable[[Sequence[World]], Generator[list[Answer]]]
# The registry of engines: "module:function", which takes the worlds, the options, the limits, and
# slots or scheduler. An engine is imported when a batch goes through it.
ENGINES = {
    "local": "satcheck.audit.batch.local:check_locally",
    "dask": "satcheck.audit.batch.dask_engine:check_with_dask",
}
# Digests that a resumed run keeps, as worlds share files.
_DIGESTS = 100_000


class Tally(Struct):
    """verdicts: the number of worlds with each so far; kept: of an earlier run. unused: issues of
    rules that no world so far needs; None: no world is known."""

    total: int
    kept: int = 0
    verdicts: Counter[AssetVerdict] = field(default_factory=Counter)
    unused: tuple[Issue, ...] | None = None

    @property
    def done(self) -> int:
        return self.verdicts.total()

    def note(self, verdict: AssetVerdict, unused: tuple[Issue, ...] = ()) -> None:
        self.verdicts[verdict] += 1
        known = unused if self.unused is None else self.unused
        self.unused = tuple(issue for issue in known if issue in unused)


def run(
    worlds: Sequence[World],
    options: CheckOptions,
    limits: Limits,
    engine: Engine,
    results: ResultsFile,
    progress: Callable[[Tally], None],
) -> Tally:
    """Checks the worlds of which the file has no valid result, and brings the file into order.
    progress: called when results are on the disk. Raises what the engine and the file raise."""
    tally = Tally(len(worlds))
    waiting = dict.fromkeys(worlds)
    for head in results.keep(_validity(options, limits)):
        if head.files in waiting:
            del waiting[head.files]
            tally.kept += 1
            tally.note(head.verdict)
    progress(tally)

    def take(answers: list[Answer]) -> None:
        """Leave of the list what is not noted yet."""
        results.append((each.world, each.line) for each in answers)
        while answers:
            answer = answers.pop()
            tally.note(answer.verdict, answer.unused)
        progress(tally)

    with closing(engine(tuple(waiting))) as coming:
        answers: list[Answer] = []
        try:
            for answers in coming:
                take(answers)
        except KeyboardInterrupt as stop:
            with suppress(KeyboardInterrupt, StopIteration):
                answers += coming.throw(stop)
            take(answers)
            raise
    results.finish(worlds)
    return tally


def _validity(options: CheckOptions, limits: Limits) -> Callable[[Head], bool]:
    """Says of a result whether its files, the options and the version are the same now, and if it
    depends on them also the limits."""
    now = lru_cache(_DIGESTS)(digest)

    @lru_cache(maxsize=1)
    def terms() -> tuple[str, str]:
        """Only an earlier result needs them: the versions of packages take a while to look up."""
        return terms_of(options), terms_of(options, limits)

    def valid(head: Head) -> bool:
        inputs = inputs_of((file.path for file in head.inputs), now)
        return head.key in [key_of(head.files, each, inputs, options.folders) for each in terms()]

    return valid
