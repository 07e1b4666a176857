"""What accuracy costs in time, over a corpus: every rung of the ladder on every pair, as a page.

    python -m bench.accuracy_vs_time CORPUS... [--pair A B] [--page bench/accuracy-vs-time.md]

CORPUS: a pair file (as of depth_interval.py), the index of sample_meshes, a folder with one of
them, or any other folder: every two of its meshes. --pair: two files besides. Linux, for the memory
of whole processes.

Records go to --results as they are made, and a call that finds the file goes on where it ended;
another --results, or none, begins anew. The page has its figures in a folder of its name beside it.
"""

from __future__ import annotations

import argparse
import compileall
import shlex
import sys
import sysconfig
import tempfile
from pathlib import Path

from bench.accuracy import corpus, runs
from bench.accuracy.case import Case, Effort


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def options_of(arguments: list[str]) -> argparse.Namespace:
    assert __doc__ is not None
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("corpora", nargs="+", type=Path, metavar="CORPUS")
    parser.add_argument("--pair", nargs=2, type=Path, action="append", default=[], metavar="FILE")
    parser.add_argument("--about", default="", help="a sentence on the corpora, for the page")
    parser.add_argument("--results", type=Path, help="JSON lines, kept")
    parser.add_argument("--page", type=Path)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--rung-seconds", type=float, default=12.0, help="of a pair, all rounds")
    parser.add_argument("--pair-seconds", type=float, default=30.0, help="all rungs of a pair")
    parser.add_argument("--part-triangles", type=int, default=3000, help="no parts beyond that")
    return parser.parse_args(arguments)


def cases_of(options: argparse.Namespace) -> tuple[list[Case], list[str]]:
    """The pairs, and in words where they are from."""
    cases: list[Case] = []
    said = []
    for path in options.corpora:
        found = corpus.read(path).cases
        cases += found
        said.append(f"{len(found)} pairs of `{path.as_posix()}`")
    for a, b in options.pair:
        cases.append(corpus.given((a, b)))
        said.append(f"`{a.name}` against `{b.name}`")
    return cases, said


def write_page(options: argparse.Namespace, results: Path, said: list[str]) -> None:
    from bench.accuracy.page import Run, page  # satcheck comes with it: see case.py

    header, records = runs.load(results)
    folder = options.page.with_suffix("")
    told = {str(options.results): "", options.about: "..."}  # the page has the sentence already
    kept = [told.get(one, one) for one in sys.argv[1:]]
    command = shlex.join(["python", "-m", "bench.accuracy_vs_time", *filter(None, kept)])
    made = page(
        Run(
            header=header,
            records=list(records.values()),
            corpora=said,
            about=options.about,
            command=command.replace(" --results", ""),
            folder=folder.name,
        )
    )
    folder.mkdir(exist_ok=True)
    for name, drawing in made.figures.items():
        (folder / name).write_bytes(drawing)
    options.page.write_text(made.text, encoding="utf-8")


def main() -> None:
    options = options_of(sys.argv[1:])
    effort = Effort(
        options.repeat, options.rung_seconds, options.pair_seconds, options.part_triangles
    )
    cases, said = cases_of(options)
    compileall.compile_dir(sysconfig.get_path("platlib"), quiet=2, workers=1)
    with tempfile.TemporaryDirectory() as scratch:
        results = options.results or Path(scratch) / "results.jsonl"
        runs.measure_all(cases, effort, results, say)
        if options.page:
            write_page(options, results, said)


if __name__ == "__main__":
    main()
