"""`satcheck A B [C ...]`: the command that needs no name."""

from __future__ import annotations

from typing import Any

import click

from satcheck.cli.choices import (
    ACCURACIES,
    ACCURACY,
    DEPTH_BUDGET,
    DEPTH_WIDTH,
    FAIL_ON,
    LEAST_SEVERITY,
    MOST_BUDGET,
)
from satcheck.cli.commands.options import (
    HELP_NAMES,
    Command,
    debug_option,
    form_option,
    jobs_option,
    open_option,
    output_option,
    outside_option,
    paths_argument,
    planar_option,
    split_option,
    units_option,
)
from satcheck.cli.commands.robots import POSE_OPTIONS, package_option, pose_options
from satcheck.cli.lengths import length
from satcheck.cli.output import form_of

# More characters than the first sentence of any help text has.
_WHOLE_SENTENCE = 200


class _DefaultContext(click.Context):
    """The default command's name is never typed, so it is never shown."""

    @property
    def command_path(self) -> str:
        return self.parent.command_path if self.parent else super().command_path


class _DefaultCommand(Command):
    context_class = _DefaultContext

    def collect_usage_pieces(self, _: click.Context) -> list[str]:
        return ["[OPTIONS] A B [C ...]"]

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Exit codes"):
            formatter.write_dl(
                [
                    ("0", "everything was checked, and no pair fails"),
                    (
                        "1",
                        "bodies overlap more than rules allow, or are closer than their clearance",
                    ),
                    ("2", "wrong usage, an unreadable input, or an internal error"),
                    ("3", "no pair is known to fail, but not everything could be checked"),
                ]
            )
        with formatter.section("Other commands"):
            formatter.write_dl(
                [
                    (f"satcheck {name}", other.get_short_help_str(_WHOLE_SENTENCE))
                    for name, other in _others(ctx)
                ]
            )
        with formatter.section("Shell completion"):
            formatter.write_text('bash: eval "$(_SATCHECK_COMPLETE=bash_source satcheck)"')
            formatter.write_text('zsh:  eval "$(_SATCHECK_COMPLETE=zsh_source satcheck)"')
            formatter.write_text("fish: _SATCHECK_COMPLETE=fish_source satcheck | source")


def _others(ctx: click.Context) -> list[tuple[str, click.Command]]:
    group = ctx.parent.command if ctx.parent else None
    if not isinstance(group, click.Group):
        return []
    commands = [(name, group.get_command(ctx, name)) for name in group.list_commands(ctx)]
    return [(name, command) for name, command in commands if command is not None]


def _version(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted and not ctx.resilient_parsing:
        from satcheck._version import __version__
        from satcheck.cli.output import Document

        Document().write(f"satcheck {__version__}\n")
        ctx.exit()


@click.command("check", cls=_DefaultCommand, context_settings=HELP_NAMES, hidden=True)
@paths_argument("A B [C ...]")
@form_option
@output_option
@click.option(
    "--explain",
    is_flag=True,
    help="Show the steps of each pair: what ran, what it settled, what it cost. JSON always does.",
)
@click.option(
    "--depth/--no-depth",
    default=None,
    help="Find how deep bodies overlap, and the shortest way out.  [default: depth for mesh files "
    "of one body each; otherwise only where a rule needs it]",
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
    help="Also report pairs with a gap smaller than this, and the gap.",
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
    default=ACCURACY,
    show_default=True,
    help="The finest test allowed: boxes, oriented boxes, convex hulls, convex parts, triangles. "
    "All but exact may report false overlaps, and call them possible.",
)
@click.option(
    "--depth-width",
    type=click.FloatRange(0, 1, min_open=True, max_open=True),
    metavar="RATIO",
    default=DEPTH_WIDTH,
    show_default=True,
    help="Narrow the depth interval of concave pairs to this width, relative to its upper end.",
)
@click.option(
    "--depth-budget",
    type=click.FloatRange(0, MOST_BUDGET, min_open=True),
    metavar="SECONDS",
    default=DEPTH_BUDGET,
    show_default=True,
    help="Stop narrowing after this much work on a pair. It is counted in steps, which a slow "
    "machine does in that many seconds: the answer is the same everywhere.",
)
@planar_option
@split_option
@click.option(
    "--fail-on",
    type=click.Choice(FAIL_ON),
    default=LEAST_SEVERITY,
    show_default=True,
    help="The least severity of a finding that makes the check fail. Overlaps and gaps below the "
    "clearance are errors, unless a rule of the scene says otherwise; what only touches is a note.",
)
@open_option
@click.option(
    "--cross-check",
    is_flag=True,
    help="Ask python-fcl and manifold3d too. Where one contradicts a verdict, the check is "
    "incomplete.",
)
@click.option(
    "--certificate",
    is_flag=True,
    help="Add evidence to the proven verdicts of a JSON report; satcheck verify checks it.",
)
@jobs_option
@click.option(
    "--no-cache",
    "cache",
    is_flag=True,
    flag_value=False,
    default=True,
    help="Neither read nor write the cache of convex parts, which only --accuracy parts uses.",
)
@click.option(
    "--no-timings",
    "timings",
    is_flag=True,
    flag_value=False,
    default=True,
    help="Leave out times: same input, same bytes.",
)
@click.option("--exit-zero", is_flag=True, help="Exit with 0 even when pairs fail.")
@units_option
@outside_option
@package_option
@pose_options
@debug_option
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_version,
    help="Show the version and exit.",
)
def command(**options: Any) -> int:
    """Do these meshes collide? How deep, and which way out?

    A, B, C ... are mesh files (OBJ, STL, PLY, OFF, GLB, glTF, 3MF, DAE, ZAE, 3DXML, XAML), each one
    body; scenes (TOML or JSON: satcheck.scene/1, satcheck-scene-1) of several bodies; robots (URDF,
    and the SRDF about it), each link a body; or drawings (SVG, DXF), with --planar. One GLB, glTF,
    3MF or 3DXML file alone is a scene too: each node with a mesh is a body. Every pair of bodies is
    checked, in the coordinates of the files. A body inside another collides with it.

    A LENGTH is a number in the units of the files. Where a scene declares its units, the number may
    carry a unit of its own: 2mm, 0.5in (um, mm, cm, m, in, ft).
    """
    from satcheck.cli.checking import Choices, run
    from satcheck.cli.posing import Posing

    options["posing"] = Posing(*(options.pop(name) for name in POSE_OPTIONS))
    options["form"] = form_of(options["form"], options["output"])
    if options["certificate"] and options["form"] != "json":
        raise click.UsageError(
            "--certificate needs a JSON report: add -o report.json or --format json"
        )
    return run(Choices(**options))
