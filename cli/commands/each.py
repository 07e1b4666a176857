"""`satcheck each DIR|FILE ...`: many assets, each checked as a scene of its own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from satcheck.audit.batch.check_world import foreign_worlds
from satcheck.audit.batch.options import Limits
from satcheck.cli import option
from satcheck.cli.click_classes import HELP_NAMES, Command
from satcheck.cli.commands.check import command as check_command
from satcheck.cli.config import stated_config
from satcheck.cli.format_option import form_of, format_option
from satcheck.cli.formats.registry import REPORTS
from satcheck.cli.inputs import Inputs, refuse_early
from satcheck.cli.output import talk
from satcheck.cli.rendering import Delivery
from satcheck.cli.worlds import asset_names, check_worlds, tell_foreign
from satcheck.scene.changed_assets import changed_since

# What is about one world, or about one report.
_NOT_HERE = (
    "form",
    "png",
    "glb",
    "pose",
    "state",
    "joint_path",
    "sample",
    "seed",
    "explain",
    "certificate",
    "merge",
)


@click.command("each", cls=Command, context_settings=HELP_NAMES)
@option.paths("DIR|FILE|- ...")
@click.option(
    "--changed-since",
    metavar="REV",
    help="Only assets that changed since this git revision, or that name a changed file.",
)
@option.exclude
@format_option(REPORTS)
@option.limits_of_worlds("an asset")
@option.those_of(check_command, but=(*_NOT_HERE, "version"))
def command(
    form: str | None,
    output: Path | None,
    quiet: bool,
    exit_zero: bool,
    top: int | None,
    changed_since: str | None,
    scene_seconds: float,
    scene_megabytes: int,
    baseline: Path | None,
    **options: Any,
) -> int:
    """Check each asset of a folder as a scene of its own.

    An asset is a mesh file, a scene or a robot. A folder stands for all assets below it, and a
    pattern ("props/**/*.glb") for files. - reads names of files from standard input, one per line,
    or each ended by a NUL. Bodies of different assets are never compared. An asset with
    one body passes if that body can be read. A URDF is read without its SRDF. If a process crashes,
    hangs or needs too much memory, the other assets still get their answers.

    The exit code is that of the worst asset: 2 if one cannot be read, else 1 if one fails, else 3
    if one is not fully checked, else 0. Options that both commands have mean what they mean in
    `satcheck A B`.
    """
    inputs = Inputs.taken_from(options)
    form = form_of(form, output, REPORTS)
    if not inputs.paths:
        raise click.UsageError("give a folder or files: `satcheck each .` checks this folder")
    refuse_early(inputs, output, baseline)
    config = stated_config(click.get_current_context())
    assets = asset_names(inputs)
    files, inputs = assets.files, replace(inputs, folders=tuple(assets.folders))
    foreign = foreign_worlds(assets.foreign)
    refuse_early(Inputs(paths=tuple(files)), output)
    if changed_since is not None:
        shared = [*inputs.rules, *filter(None, [baseline])]
        shared += [Path(config.file)] if config else []
        unread = [name for _, *names in foreign for name in names]
        kept = set(_changed(changed_since, [*files, *unread], shared))
        files = [file for file in files if file in kept]
        foreign = foreign_worlds(
            {folder: [name for name in names if name in kept] for folder, *names in foreign}
        )
    if not quiet:
        tell_foreign(foreign)
    return check_worlds(
        [*((file,) for file in files), *foreign],
        inputs,
        options,
        baseline,
        Delivery(form, output, quiet, exit_zero, options["timings"], top),
        config,
        Limits(scene_seconds, scene_megabytes),
        complete=changed_since is None,
    )


def _changed(revision: str, files: list[str], shared: Sequence[Path]) -> list[str]:
    """shared: what these files say of every asset counts."""
    if new := changed_since(revision, list(map(str, shared))):
        talk(f"satcheck: {new[0]} changed since {revision}: every asset is checked")
        return files
    changed = changed_since(revision, files)
    if not changed:
        talk(f"satcheck: no asset changed since {revision}")
    return changed
