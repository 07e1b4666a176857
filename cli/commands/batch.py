"""`satcheck batch SCENE ...`: thousands of scenes, whose results survive every crash."""

from __future__ import annotations

import os
import signal
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from satcheck.audit.batch.check_world import foreign_worlds
from satcheck.audit.batch.manifest import Shard, parse_shard, read_manifest
from satcheck.audit.batch.options import Limits, World
from satcheck.audit.batch.remote import at, is_remote, is_url, local_results
from satcheck.audit.batch.results import PART, ResultsFile
from satcheck.audit.batch.run import ENGINES, Tally, run
from satcheck.audit.batch.slot_server import Answer
from satcheck.audit.words import counted
from satcheck.cli import exit_codes, option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.commands.check import command as check_command
from satcheck.cli.config import stated_config
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.interrupts import write_before_the_end
from satcheck.cli.output import talk
from satcheck.cli.progress import Bar
from satcheck.cli.worlds import asset_names, check_options, tell_foreign
from satcheck.core.errors import SatcheckError
from satcheck.core.plugins import function_at
from satcheck.report.assets import ASSET_VERDICTS, AssetVerdict, worst_verdict
from satcheck.scene.asset_files import NO_ASSETS

# What is about one world, or about one report.
_NOT_HERE = (
    "form",
    "output",
    "png",
    "glb",
    "top",
    "pose",
    "state",
    "joint_path",
    "sample",
    "seed",
    "explain",
    "merge",
    "timings",
    "quiet",
    "version",
)
_PATTERN = frozenset("*?[")


@click.command("batch", cls=Command, context_settings=HELP_NAMES)
@option.paths("SCENE|DIR|- ...")
@click.option(
    "--manifest",
    type=click.Path(dir_okay=False),
    metavar="FILE",
    help="Also the scenes that FILE names, one in a line; a line may be a JSON list of files that "
    "are one scene together.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False),
    metavar="FILE",
    required=True,
    help="Write the results to FILE, as JSON Lines: a line for each scene.",
)
@click.option(
    "--resume",
    is_flag=True,
    help="Keep the results in the file whose scenes, meshes and options are unchanged.",
)
@click.option(
    "--shard",
    type=parse_shard,
    metavar="I/N",
    default="1/1",
    help="Check only part I of N of the scenes. The names of its files decide the part of a scene.",
)
@click.option(
    "--engine",
    type=click.Choice(tuple(ENGINES)),
    default="local",
    show_default=True,
    help="Check on this machine, or on a Dask cluster.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Of the Dask cluster: tcp://host:port, or the JSON file that the scheduler has written.",
)
@option.exclude
@option.limits_of_worlds("a scene")
@option.those_of(check_command, but=_NOT_HERE)
def command(
    manifest: str | None,
    output: str,
    resume: bool,
    shard: Shard,
    engine: str,
    scheduler: str | None,
    scene_seconds: float,
    scene_megabytes: int,
    exit_zero: bool,
    baseline: Path | None,
    **options: Any,
) -> int:
    """Check thousands of scenes: none stops the others.

    A scene is a scene file, a robot or a mesh file. A folder stands for all scenes in it, and -
    reads their names from standard input. Any of the files may be a URL, as s3://bucket/a.toml. If
    a process crashes, hangs or needs too much memory, satcheck replaces it, checks its scene again
    without the file or pair at fault, and reports that file or pair. FILE.part receives each
    result at once; FILE itself appears when all results are there.

    The exit code is that of the worst scene: 2 if one cannot be read, else 1 if one fails, else 3
    if one is not fully checked, else 0.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # of a cluster: as Ctrl-C
    inputs = Inputs.taken_from(options)
    local = tuple(name for name in inputs.paths if not is_url(name))
    assets = asset_names(replace(inputs, paths=local)) if local else NO_ASSETS
    foreign = foreign_worlds(assets.foreign)
    worlds = _worlds([*((name,) for name in assets.files), *foreign], inputs, manifest, shard)
    tell_foreign(set(worlds).intersection(foreign))
    inputs = replace(inputs, folders=tuple(assets.folders))
    _refuse(worlds, inputs, output, baseline)
    config = stated_config(click.get_current_context())
    terms = check_options(inputs, options, baseline, config)
    limits = Limits(scene_seconds, scene_megabytes)
    check = _engine(engine, scheduler, options["jobs"])
    with _local(output) as path, ResultsFile(path) as results, Bar("scenes") as bar:
        if not resume:
            _refuse_existing(results, output)
        tally = Tally(len(worlds))

        def show(reached: Tally) -> None:
            nonlocal tally
            tally = reached
            if bar is not None:
                bar(tally.done, tally.total, _verdicts(tally, but="pass"))

        made = partial(check, options=terms, limits=limits)
        try:
            run(worlds, terms, limits, made, results, show)
        except (KeyboardInterrupt, SatcheckError):
            if is_url(output):
                write_before_the_end()
            if tally.done:
                place = output if is_url(output) else str(results.part)
                talk(f"satcheck: {_recorded(tally, place)}")
            raise
    talk(_summary(tally, output))
    return _exit_code(tally, exit_zero)


def _refuse(worlds: Sequence[World], inputs: Inputs, output: str, baseline: Path | None) -> None:
    """Refuse what can be seen to fail before any work is done."""
    if output == "-":
        raise click.UsageError("-o - has no place for --resume: name a file")
    files = tuple(name for world in worlds for name in world if not is_url(name))
    if baseline is not None and any(map(is_remote, worlds)):
        raise click.UsageError("--baseline knows the assets of this machine, and none at a URL")
    if files and not is_url(output):
        refuse_early(Inputs(paths=files, rules=inputs.rules), Path(output), baseline)


def _refuse_existing(results: ResultsFile, output: str) -> None:
    if (existing := results.existing()) is not None:
        reason = "has results: --resume keeps those that still hold; or remove the file"
        named = output if is_url(output) else str(existing)
        raise SatcheckError("results-exist", reason, file=named)


def _local(output: str) -> AbstractContextManager[Path]:
    """The file that the run writes."""
    return local_results(output, PART) if is_url(output) else nullcontext(Path(output))


def _worlds(
    near: Sequence[World], inputs: Inputs, manifest: str | None, shard: Shard
) -> Sequence[World]:
    """Those of the shard, each once. near: on this machine. click.UsageError if there is none in
    any shard."""
    remote = [name for name in inputs.paths if is_url(name)]
    named: Iterator[World] = chain(
        near,
        ((name,) for url in remote for name in _meant_by(url)),
        read_manifest(manifest) if manifest is not None else (),
    )
    first = next(named, None)
    if first is None and manifest is not None:
        raise SatcheckError("no-assets", "it names no scene", file=manifest)
    if first is None:
        raise click.UsageError("give scenes, a folder of them, or --manifest FILE")
    return tuple(dict.fromkeys(world for world in chain([first], named) if shard.has(world)))


def _meant_by(url: str) -> list[str]:
    if not _PATTERN.intersection(url):
        return [url]
    with at(url) as (system, pattern):
        matching = sorted(map(system.unstrip_protocol, system.glob(pattern)))
    if not matching:
        raise SatcheckError("no-assets", "no file matches the pattern", file=url)
    return matching


def _engine(name: str, scheduler: str | None, jobs: int) -> Callable[..., Generator[list[Answer]]]:
    if (name == "dask") != (scheduler is not None):
        raise click.UsageError("--engine dask and --scheduler ADDRESS need each other")
    try:
        engine = function_at(ENGINES[name])
    except ImportError:
        raise click.UsageError("--engine dask needs Dask: pip install 'satcheck[dask]'") from None
    if scheduler is None:
        return partial(engine, slots=jobs or os.cpu_count() or 1)
    return partial(engine, scheduler=scheduler)


def _recorded(tally: Tally, place: str) -> str:
    done = f"{tally.done:,} of {counted(tally.total, 'scene')} are recorded in {place}"
    return f"{done}: the same command with --resume checks the others"


def _verdicts(tally: Tally, but: str = "") -> str:
    """`1 error, 5 pass`"""
    parts = [
        f"{tally.verdicts[verdict]:,} {verdict}"
        for verdict in ASSET_VERDICTS
        if tally.verdicts[verdict] and verdict != but
    ]
    return ", ".join(parts)


def _summary(tally: Tally, output: str) -> str:
    kept = f" ({tally.kept:,} kept)" if tally.kept else ""
    verdicts = f": {_verdicts(tally)}{kept}" if tally.done else ""
    return f"{counted(tally.total, 'scene')}{verdicts}. Results: {output}"


def _exit_code(tally: Tally, exit_zero: bool) -> int:
    """By the worst scene, or the worst that does not fail."""
    forgiven: Counter[AssetVerdict] = Counter({"fail": tally.total} if exit_zero else {})
    return exit_codes.for_assets(worst_verdict(tally.verdicts - forgiven), exit_zero=exit_zero)
