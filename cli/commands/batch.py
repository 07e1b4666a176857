"""`satcheck batch DIR|FILE ...`: many assets, each a scene of its own; results survive crashes."""

from __future__ import annotations

import signal
from collections.abc import Callable, Generator, Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import Any, cast

import click
from msgspec.structs import replace

from satcheck.audit.batch.check_world import foreign_worlds
from satcheck.audit.batch.manifest import Shard, parse_shard, read_manifest
from satcheck.audit.batch.options import Limits, World
from satcheck.audit.batch.remote import at, is_remote, is_url
from satcheck.audit.batch.run import ENGINES
from satcheck.audit.batch.slot_server import Answer
from satcheck.cli import option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.commands.check import command as check_command
from satcheck.cli.config import stated_config
from satcheck.cli.format_option import FormatChoice, Target, format_option, targets_of
from satcheck.cli.formats.registry import REPORTS, Format
from satcheck.cli.inputs import Inputs, refuse_early, typed
from satcheck.cli.output import talk
from satcheck.cli.rendering import Delivery, refuse_certificate
from satcheck.cli.worlds import asset_names, check_options, check_worlds, tell_foreign
from satcheck.core.errors import SatcheckError
from satcheck.core.plugins import function_at
from satcheck.scene.asset_files import NO_ASSETS
from satcheck.scene.changed_assets import changed_since
from satcheck.scene.files.readers import mesh_reader
from satcheck.scene.opening import is_folder

# What is about one world, or about one report.
_NOT_HERE = (
    *("form", "outputs", "limit", "pose", "state", "joint_path", "sample", "seed"),
    *("explain", "merge", "version", "help_all"),
)
_PATTERN = frozenset("*?[")
# What this command means by these names.
_RESULTS = Format(
    "results", (".jsonl", ".ndjson"), about="a line for each asset, for --resume and view"
)
_GALLERY = Format("html", (".html", ".htm"), about="a gallery of the worst finding of each asset")
_FORMATS = FormatChoice(REPORTS, {"results": _RESULTS, "html": _GALLERY})


@click.command(
    "batch",
    cls=Command,
    context_settings=HELP_NAMES,
    daily="outputs form resume since exclude clearance max_thickness max_depth tolerance "
    "depth rules baseline accept allow_open units top jobs",
)
@option.paths("ASSET|DIR|- ...")
@click.option(
    "--manifest",
    type=click.Path(dir_okay=False),
    metavar="FILE",
    help="Also the assets that FILE names, one in a line; a line may be a JSON list of files that "
    "are one scene together.",
)
@click.option(
    "--changed-since",
    "since",
    metavar="REV",
    help="Only assets that changed since this git revision, or that name a changed file.",
)
@option.exclude
@format_option(_FORMATS)
@click.option(
    "-o",
    "--output",
    "outputs",
    multiple=True,
    type=click.Path(dir_okay=False),
    metavar="FILE",
    help="Write the report to FILE, as its name ends: .jsonl gets each result at once, for "
    "--resume and satcheck view; - is standard output. Repeatable.",
)
@click.option(
    "--resume",
    is_flag=True,
    help="Keep the results in the .jsonl file whose assets, meshes and options are unchanged.",
)
@click.option(
    "--shard",
    type=parse_shard,
    metavar="I/N",
    default="1/1",
    help="Check only part I of N of the assets. The names of its files place an asset.",
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
@option.limits("scene-seconds", "scene-megabytes")
@option.those_of(check_command, but=_NOT_HERE)
def command(
    manifest: str | None,
    since: str | None,
    form: str | None,
    outputs: tuple[str, ...],
    resume: bool,
    shard: Shard,
    engine: str,
    scheduler: str | None,
    quiet: bool,
    exit_zero: bool,
    top: int | None,
    baseline: Path | None,
    **options: Any,
) -> int:
    """Check each asset of a folder, and thousands of them.

    An asset is a mesh file, a scene or a robot, and a scene of its own: bodies of different assets
    are never compared. A folder stands for all assets below it, a pattern ("props/**/*.glb") for
    files, and - for names on standard input, one in a line, or each ended by a NUL. An asset with
    one body passes if that body can be read. A URDF is read without its SRDF. If a process
    crashes, hangs or needs too much memory, the other assets still get their answers.

    With -o results.jsonl a run that was stopped goes on where it was: --resume. Files may be URLs,
    such as s3://bucket/a.toml, and so may the results.

    The exit code is that of the worst asset: 2 if one cannot be read, else 1 if one fails, else 3
    if one is not fully checked, else 0.
    """
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # of a cluster: as Ctrl-C
    inputs = Inputs.taken_from(options)
    targets, results = _targets(form, outputs)
    shows = bool(outputs) or not quiet
    check = _engine(engine, scheduler)
    worlds, foreign, folders = _worlds(inputs, manifest, shard)
    inputs = replace(inputs, folders=folders)
    files = [*filter(None, (target.output for target in targets))]
    if results is not None and not is_url(results):
        files.append(Path(results))
    _refuse(worlds, inputs, files, baseline)
    if results is None:
        if resume:
            raise click.UsageError("--resume: name a file for the results, -o results.jsonl")
        refuse_certificate({target.form for target in targets}, wanted=options["certificate"])
    config = stated_config(click.get_current_context())
    if since is not None:
        worlds = _changed(since, worlds, inputs, [baseline, config.file if config else None])
    if not quiet:
        tell_foreign(set(worlds).intersection(foreign))
    return check_worlds(
        worlds,
        check_options(inputs, options, baseline, config),
        Delivery(targets, quiet, exit_zero, options["timings"], top, shows=shows),
        Limits(inputs.limit["scene-seconds"], int(inputs.limit["scene-megabytes"])),
        complete=since is None and shard.count == 1,
        results=results,
        resume=resume,
        engine=check,
        scheduler=scheduler,
    )


def _targets(form: str | None, outputs: Sequence[str]) -> tuple[tuple[Target, ...], str | None]:
    """Return the documents, and the file or URL of the results."""
    urls = [name for name in outputs if is_url(name)]
    if urls and (len(outputs) > 1 or form not in (None, "results")):
        raise click.UsageError(f"-o {urls[0]}: a URL takes the results, and no other document")
    if urls:
        return (), urls[0]
    targets = targets_of(form, [Path(name) for name in outputs], _FORMATS)
    results = [target.output for target in targets if target.form == "results"]
    if len(results) > 1 or None in results:
        raise click.UsageError("results go to one file, for --resume: name it, -o results.jsonl")
    others = tuple(target for target in targets if target.form != "results")
    return others, str(results[0]) if results else None


def _changed(
    revision: str, worlds: Sequence[World], inputs: Inputs, more: Sequence[Path | str | None]
) -> Sequence[World]:
    """Return the assets that changed. more: files beside the rules, None for one that is not given.
    What these say of every asset counts."""
    shared, permitted = [*inputs.rules, *map(str, filter(None, more))], inputs.permitted
    if any(map(is_remote, worlds)):
        raise click.UsageError("--changed-since is about files of this machine, not at URLs")
    if new := changed_since(revision, shared, permitted):
        talk(f"satcheck: {new[0]} changed since {revision}: every asset is checked")
        return worlds
    named = [name for world in worlds for name in world if not is_folder(name)]
    changed = set(changed_since(revision, named, permitted))
    if not changed:
        talk(f"satcheck: no asset changed since {revision}")
    return [kept for world in worlds if (kept := _kept(world, changed))]


def _kept(world: World, changed: set[str]) -> World:
    """Return the world with what has changed; (): nothing has. Of a folder that stands for files
    which no reader knows these count one by one."""
    first, *files = world
    if is_folder(first):
        files = [name for name in files if name in changed]
        return (first, *files) if files else ()
    return () if changed.isdisjoint(world) else world


def _refuse(
    worlds: Sequence[World], inputs: Inputs, outputs: Sequence[Path], baseline: Path | None
) -> None:
    """Refuse what can be seen to fail before any work is done."""
    files = tuple(name for world in worlds for name in world if not is_url(name))
    if baseline is not None and any(map(is_remote, worlds)):
        raise click.UsageError("--baseline knows the assets of this machine, and none at a URL")
    read = Inputs(paths=files, rules=inputs.rules)
    if files and outputs:
        refuse_early(read, outputs, baseline)
    given = typed(inputs.reading)
    readers = [mesh_reader(Path(name).suffix) for name in files] if given else []
    for name in given:
        if None not in readers and not any(
            name in {each.name for each in reader.options} for reader in readers if reader
        ):
            said = name.replace("_", "-")
            raise click.UsageError(f"--read {said}: no reader of these files has this option")


def _worlds(
    inputs: Inputs, manifest: str | None, shard: Shard
) -> tuple[Sequence[World], list[World], tuple[str, ...]]:
    """Return those of the shard, each once, those of files that no reader knows, and the folders
    that are named. click.UsageError if there is none in any shard."""
    if not (inputs.paths or manifest):
        raise click.UsageError("give a folder or files: `satcheck batch .` checks this folder")
    local = tuple(name for name in inputs.paths if not is_url(name))
    assets = asset_names(replace(inputs, paths=local)) if local else NO_ASSETS
    foreign = foreign_worlds(assets.foreign)
    remote = [name for name in inputs.paths if is_url(name)]
    named: Iterator[World] = chain(
        ((name,) for name in assets.files),
        foreign,
        ((name,) for url in remote for name in _meant_by(url)),
        read_manifest(manifest) if manifest is not None else (),
    )
    first = next(named, None)
    if first is None and manifest is not None:
        raise SatcheckError("no-assets", "it names no scene", file=manifest)
    if first is None:
        raise click.UsageError("no file is named: give a folder or files")
    kept = dict.fromkeys(world for world in chain([first], named) if shard.has(world))
    return tuple(kept), foreign, tuple(assets.folders)


def _meant_by(url: str) -> list[str]:
    if not _PATTERN.intersection(url):
        return [url]
    with at(url) as (system, pattern):
        matching = sorted(map(system.unstrip_protocol, system.glob(pattern)))
    if not matching:
        raise SatcheckError("no-assets", "no file matches the pattern", file=url)
    return matching


def _engine(name: str, scheduler: str | None) -> Callable[..., Generator[list[Answer]]]:
    if (name == "dask") != (scheduler is not None):
        raise click.UsageError("--engine dask and --scheduler ADDRESS need each other")
    try:
        return cast("Callable[..., Generator[list[Answer]]]", function_at(ENGINES[name]))
    except ImportError:
        raise click.UsageError("--engine dask needs Dask: pip install 'satcheck[dask]'") from None
