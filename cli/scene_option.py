"""The options that choose and read the files of a scene. Several commands share them.

Help lists the options of a group in the order of the group.
"""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import click

from satcheck.cli.option import limits, together
from satcheck.core.errors import SatcheckError
from satcheck.scene.files.readers import GEOMETRY, GeometryKind, OptionValue, option_named, options
from satcheck.scene.opening import is_folder
from satcheck.scene.units import MICROMETRES


def _about_read() -> str:
    known = options().values()
    spelled = sorted(option.spelling for option, _ in known if option is not GEOMETRY)
    named = f": {', '.join(spelled)}" if spelled else ""
    return f"An option of the readers of some formats{named}. Repeatable."


class _Read(click.Option):
    """Its help names the options of the readers that are registered by then."""

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        self.help = _about_read()
        return super().get_help_record(ctx)


def _read(_: click.Context, __: click.Parameter, texts: tuple[str, ...]) -> dict[str, OptionValue]:
    """The values of options of readers, by name."""
    read: dict[str, OptionValue] = {}
    for text in texts:
        spelling, equals, value = text.partition("=")
        if not (equals and spelling):
            raise click.BadParameter(f"{text!r} should be NAME=VALUE")
        try:
            option = option_named(spelling)
            stated = option.parsed(value)
        except SatcheckError as error:
            raise click.BadParameter(error.message) from None
        if option.name == GEOMETRY.name:
            raise click.BadParameter("--geometry gives the geometry")
        if option.name in read:
            raise click.BadParameter(f"{spelling} is given twice")
        read[option.name] = stated
    return read


SPLITS = ("nodes", "components", "none")

outside = click.option(
    "--allow-outside",
    is_flag=True,
    help="Read what a file names outside of its folder.",
)
read = click.option(
    "--read",
    cls=_Read,
    multiple=True,
    metavar="NAME=VALUE",
    callback=_read,
    help=_about_read(),
)
# About what reading a file may do.
reading = together(outside, limits(), read)
split = click.option(
    "--split",
    type=click.Choice(SPLITS),
    metavar="HOW",
    help="A body is a node (nodes, the default for one file alone), a connected piece (components) "
    "or a file (none).",
)
units = click.option(
    "--units",
    type=click.Choice(tuple(MICROMETRES)),
    metavar="UNIT",
    help=f"The unit of files without one: {', '.join(MICROMETRES)}.",
)
merge = click.option(
    "--merge",
    is_flag=True,
    help="Put several scene files into one world.",
)
rules = click.option(
    "--rules",
    multiple=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Rules about all bodies, after those of scenes: what may overlap, and by how much. "
    "Repeatable.",
)


between = click.option(
    "--between",
    nargs=2,
    multiple=True,
    metavar="X Y",
    help="Only pairs of X and Y: ids or group:NAME. Repeatable.",
)


def _packages(_: click.Context, __: click.Parameter, texts: tuple[str, ...]) -> dict[str, Path]:
    packages: dict[str, Path] = {}
    for text in texts:
        name, _equals, folder = text.partition("=")
        if not name or not folder:
            raise click.BadParameter(f"{text!r} should be NAME=DIR")
        if not is_folder(folder):
            raise click.BadParameter(f"{folder!r} is no folder")
        packages[name] = Path(folder)
    return packages


package = click.option(
    "--package",
    "packages",
    multiple=True,
    metavar="NAME=DIR",
    callback=_packages,
    help="The folder of a package or model, or of a part of it. Repeatable.",
)


geometry = click.option(
    "--geometry",
    type=click.Choice(get_args(GeometryKind)),
    metavar="KIND",
    help="collision (default: robots) or visual (default: USD).",
)
# That pose robots.
poses = together(
    click.option(
        "--pose",
        multiple=True,
        metavar="FILE",
        help='Values of joints (radians, metres), {"joint": value}: a JSON file or the text. '
        "Several are checked one by one.",
    ),
    click.option(
        "--state",
        multiple=True,
        metavar="NAME",
        help="A state of the SRDF; --pose overrides it. Repeatable.",
    ),
    click.option(
        "--sample",
        type=click.IntRange(min=1),
        metavar="N",
        help="Check N random poses; joints in --pose and --state stay.",
    ),
    click.option(
        "--seed",
        type=click.IntRange(min=0),
        metavar="N",
        help="The seed of the random poses.  [default: 0]",
    ),
)


# That sweeps robots.
joint_path = click.option(
    "--path",
    "joint_path",
    type=click.Path(),
    metavar="FILE",
    help="Sweep robots through these poses (JSON or CSV).",
)
# That pose robots once.
one_pose = together(
    click.option(
        "--pose",
        multiple=True,
        metavar="FILE",
        help="Values of the joints of a robot, for one pose, as in a check.",
    ),
    click.option(
        "--state", multiple=True, metavar="NAME", help="A state that the SRDF names, as in a check."
    ),
)
# Of commands that check one scene, with robots in one pose.
one_scene = together(
    split,
    merge,
    package,
    geometry,
    one_pose,
    units,
    reading,
)
