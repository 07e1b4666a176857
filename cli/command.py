"""`satcheck A B [C ...]` and its few sub-commands: options, help and completion.

Nothing here imports geometry: --help, --version and completion answer at once.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem

from satcheck.cli.lengths import Length, length

DEFAULT_COMMAND = "check"
ACCURACIES = ("aabb", "obb", "hull", "parts", "exact")
FORMATS = ("table", "json")
FORMAT_HELP = "How to report. [default: table; json where the name after -o ends in .json]"
DOCUMENTS = ("report", "stability")
STANDARD_OUTPUT = Path("-")
# More characters than the first sentence of any help text has.
_WHOLE_SENTENCE = 200


def meant(word: str) -> str | None:
    """The command that `word`, which is no path, is a slip of; None if it resembles none."""
    from difflib import get_close_matches

    names = [name for name, command in satcheck.commands.items() if not command.hidden]
    return next(iter(get_close_matches(word, names, n=1)), None)


class _DefaultContext(click.Context):
    """The default command's name is never typed, so it is never shown."""

    @property
    def command_path(self) -> str:
        return self.parent.command_path if self.parent else super().command_path


class _DefaultCommand(click.Command):
    context_class = _DefaultContext

    def collect_usage_pieces(self, _: click.Context) -> list[str]:
        return ["[OPTIONS] A B [C ...]"]

    def format_epilog(self, _: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Exit codes"):
            formatter.write_dl(
                [
                    ("0", "everything asked was checked, nothing was found"),
                    ("1", "bodies overlap, or are closer than --clearance"),
                    ("2", "wrong usage, an unreadable input, or an internal error"),
                    ("3", "nothing was found, but not everything asked could be checked"),
                ]
            )
        with formatter.section("Other commands"):
            others = sorted(satcheck.commands.items())
            formatter.write_dl(
                [
                    (f"satcheck {name}", c.get_short_help_str(_WHOLE_SENTENCE))
                    for name, c in others
                    if not c.hidden
                ]
            )
        with formatter.section("Shell completion"):
            formatter.write_text('bash: eval "$(_SATCHECK_COMPLETE=bash_source satcheck)"')
            formatter.write_text('zsh:  eval "$(_SATCHECK_COMPLETE=zsh_source satcheck)"')
            formatter.write_text("fish: _SATCHECK_COMPLETE=fish_source satcheck | source")


class _Satcheck(click.Group):
    """A group whose first word is a path unless it names a command."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if not args or args[0] not in self.commands:
            args = [DEFAULT_COMMAND, *args]
        return super().parse_args(ctx, args)


def _version(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        from satcheck._version import __version__

        click.echo(f"satcheck {__version__}")
        ctx.exit()


def _complete_paths(ctx: click.Context, _: click.Parameter, start: str) -> list[CompletionItem]:
    """Files, and before the first of them the names of the other commands."""
    files = [CompletionItem(start, type="file")]
    if not start or ctx.params.get("paths"):
        return files
    names = [n for n, c in satcheck.commands.items() if n.startswith(start) and not c.hidden]
    return files + [CompletionItem(name) for name in sorted(names)]


debug_option = click.option("--debug", is_flag=True, help="Show a traceback when satcheck fails.")
_HELP_NAMES: dict[str, Any] = {"help_option_names": ["-h", "--help"]}


@click.group(cls=_Satcheck, context_settings=_HELP_NAMES, add_help_option=False)
def satcheck() -> None:
    """Check meshes for collisions."""


@satcheck.command(DEFAULT_COMMAND, cls=_DefaultCommand, context_settings=_HELP_NAMES, hidden=True)
@click.argument("paths", nargs=-1, metavar="A B [C ...]", shell_complete=_complete_paths)
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    help=FORMAT_HELP,
)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, allow_dash=True, path_type=Path),
    metavar="FILE",
    help="Write the report to FILE; - is standard output.",
)
@click.option(
    "--explain",
    is_flag=True,
    help="Show, pair by pair, what was tested, what it settled and cost. JSON always does.",
)
@click.option(
    "--depth/--no-depth",
    default=True,
    help="Find how deep bodies overlap, and the shortest way out.  [default: depth]",
)
@click.option(
    "--contacts",
    is_flag=True,
    help="Find where surfaces meet: curves, patches of flush faces, points. JSON has their points.",
)
@click.option("--volume", is_flag=True, help="Measure the volume that overlapping solids share.")
@click.option(
    "--clearance",
    type=length,
    help="Also find pairs with a gap smaller than this, and report the gap.",
)
@click.option(
    "--tolerance",
    type=length,
    help="Call it touching when gap or depth is at most this. "
    "[default: the precision of the input files]",
)
@click.option(
    "--accuracy",
    type=click.Choice(ACCURACIES),
    default="exact",
    show_default=True,
    help="The finest test allowed: boxes, oriented boxes, convex hulls, convex parts, triangles. "
    "All but exact may report overlaps that are none, and say so.",
)
@click.option(
    "--depth-width",
    type=click.FloatRange(0, 1, min_open=True, max_open=True),
    metavar="RATIO",
    default=0.01,
    show_default=True,
    help="Narrow the depth interval of concave pairs to this width, relative to its upper end.",
)
@click.option(
    "--depth-budget",
    type=click.FloatRange(0, 86400, min_open=True),
    metavar="SECONDS",
    default=2.0,
    show_default=True,
    help="Stop narrowing after this much work a pair. The seconds, of a slow machine, stand for a "
    "number of steps: the answer is the same everywhere.",
)
@click.option(
    "--allow-open",
    is_flag=True,
    help="Meshes that are not closed are meant to be so: what nobody can say of their inside does "
    "not make the check incomplete.",
)
@click.option(
    "--cross-check",
    is_flag=True,
    help="Ask python-fcl and manifold3d too, and warn where they disagree.",
)
@click.option(
    "--certificate",
    is_flag=True,
    help="Give the proven verdicts of a JSON report evidence that satcheck verify checks.",
)
@click.option(
    "-j",
    "--jobs",
    type=click.IntRange(min=0),
    metavar="N",
    default=0,
    show_default=True,
    help="Threads; 0 is one per core. Changes no answer.",
)
@click.option(
    "--no-cache",
    is_flag=True,
    help="Neither read nor write the cache of convex parts, which only --accuracy parts uses.",
)
@click.option("--no-timings", is_flag=True, help="Leave out times: same input, same bytes.")
@click.option("--exit-zero", is_flag=True, help="Exit with 0 even when something was found.")
@debug_option
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_version,
    help="Show the version and exit.",
)
def check(
    paths: tuple[str, ...],
    form: str | None,
    output: Path | None,
    explain: bool,
    depth: bool,
    contacts: bool,
    volume: bool,
    clearance: Length | None,
    tolerance: Length | None,
    accuracy: str,
    depth_width: float,
    depth_budget: float,
    allow_open: bool,
    cross_check: bool,
    certificate: bool,
    jobs: int,
    no_cache: bool,
    no_timings: bool,
    exit_zero: bool,
    debug: bool,
) -> int:
    """Do these meshes collide? How deep, and which way out?

    A, B, C ... are mesh files (OBJ, STL, PLY, OFF, GLB, glTF, 3MF, DAE), each one body, or scene
    files (JSON, satcheck-scene-1) with several. Every pair of bodies is checked, in the coordinates
    of the files. A body inside another collides with it.

    A LENGTH is a number in the units of the files. Where a scene declares its units, it may
    carry one of its own: 2mm, 0.5in (um, mm, cm, m, in, ft).
    """
    from satcheck.cli.checking import Choices, run

    if output == STANDARD_OUTPUT:
        output = None
    form = form or ("json" if output and output.suffix.lower() == ".json" else "table")
    if certificate and form != "json":
        raise click.UsageError(
            "--certificate needs a JSON report: add -o report.json or --format json"
        )
    return run(
        Choices(
            paths=paths,
            form=form,
            output=output,
            explain=explain,
            depth=depth,
            contacts=contacts,
            volume=volume,
            clearance=clearance,
            tolerance=tolerance,
            accuracy=accuracy,
            depth_width=depth_width,
            depth_budget=depth_budget,
            allow_open=allow_open,
            cross_check=cross_check,
            certificate=certificate,
            jobs=jobs,
            cache=not no_cache,
            timings=not no_timings,
            exit_zero=exit_zero,
            debug=debug,
        )
    )


@satcheck.command(context_settings=_HELP_NAMES)
@click.argument("paths", nargs=2, metavar="A B", shell_complete=_complete_paths)
@click.option(
    "--samples",
    type=click.IntRange(min=1),
    metavar="N",
    default=4,
    show_default=True,
    help="How many variants of each kind.",
)
@click.option(
    "--seed",
    type=click.IntRange(min=0),
    metavar="N",
    default=0,
    show_default=True,
    help="Which variants: the same number makes the same ones.",
)
@click.option("--depth/--no-depth", default=True, help="Compare depths as well.  [default: depth]")
@click.option("--format", "form", type=click.Choice(FORMATS), help=FORMAT_HELP)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, allow_dash=True, path_type=Path),
    metavar="FILE",
    help="Write the report to FILE; - is standard output.",
)
@click.option("--explain", is_flag=True, help="Show every variant, not only what went wrong.")
@debug_option
def stability(
    paths: tuple[str, str],
    samples: int,
    seed: int,
    depth: bool,
    form: str | None,
    output: Path | None,
    explain: bool,
    debug: bool,
) -> int:
    """Ask the same question in other ways: does the answer stay?

    The mesh files A and B are scaled by powers of two, stored in another order of vertices and
    faces, given other axes, swapped, moved, given other triangles, turned, and disturbed by one
    unit in the last place, N samples of each. What changed is held against what may change, by
    proof.

    Exit codes: 0, all is within its bound; 1, something is not; 2, wrong usage, an unreadable
    input, or an internal error; 3, something could not be decided.
    """
    from satcheck.cli.stability import Choices, run

    del debug
    return run(
        Choices(
            paths=paths,
            form=form or ("json" if output and output.suffix.lower() == ".json" else "table"),
            output=None if output == STANDARD_OUTPUT else output,
            samples=samples,
            seed=seed,
            depth=depth,
            explain=explain,
        )
    )


@satcheck.command(context_settings=_HELP_NAMES)
@click.argument("report", metavar="REPORT", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--root",
    type=click.Path(file_okay=False, exists=True, path_type=Path),
    default=Path(),
    help="The folder where the check ran: paths in the report start there.  "
    "[default: the current one]",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    default="table",
    show_default=True,
    help="How to report.",
)
@debug_option
def verify(report: Path, root: Path, form: str, debug: bool) -> int:
    """Re-check the certificates of a report from the mesh files.

    REPORT is what satcheck --certificate -o REPORT.json A B wrote. Its verdicts are checked in
    rational arithmetic by code of its own, which shares nothing with the solver. A verdict without
    a certificate (an estimate below --accuracy exact, for instance) is not certified, and no pass.

    Exit codes: 0, every verdict is accepted; 1, one is rejected or not certified; 2, wrong usage,
    an unreadable report, no certificate in it, or an internal error.
    """
    from satcheck.cli.verifying import run

    return run(report, root, form, debug)


@satcheck.group(context_settings=_HELP_NAMES)
def cache() -> None:
    """The cache of convex parts: info, clear.

    Only --accuracy parts makes such parts. The cache lies in the user's cache folder, or where
    SATCHECK_CACHE_DIR says.
    """


@cache.command()
def info() -> None:
    """Show where the cache is and how much it holds."""
    from satcheck.cli.caching import describe

    click.echo(describe())


@cache.command()
def clear() -> None:
    """Delete everything in the cache."""
    from satcheck.cli.caching import clear as clear_cache

    click.echo(clear_cache())


@satcheck.command()
@click.argument("document", type=click.Choice(DOCUMENTS), default=DOCUMENTS[0])
def schema(document: str) -> None:
    """Print the JSON Schema of a report, of a check or of stability."""
    from satcheck.cli.report.schema import text

    click.echo(text(document), nl=False)
